#include "core/option_word.h"

#include <gtest/gtest.h>

#include "core/describe.h"

namespace photohull {
namespace {

TEST(OptionWord, LibrariesNameFields) {
  EXPECT_EQ(option_word("mask_offset"), "mask_offset");
  EXPECT_EQ(option_word("masks", "none"), "masks=none");
  EXPECT_EQ(option_word("masks", ""), "masks=");
  EXPECT_EQ(option_word("resolution", 128), "resolution=128");
  EXPECT_EQ(option_word("voxel_size", 0.25), "voxel_size=0.25");
  EXPECT_EQ(command_word("info", "cameras"), "photohull info with cameras");
}

std::string refusal_of(const Option& option, const std::string& text) {
  try {
    read_option(option, text);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(OptionWord, ProgramsMayHaveOtherWords) {
  const OptionWording before = set_option_wording(
      {[](const std::string& name, const std::optional<std::string>& value) {
         return value ? "set " + name + " to " + *value : "the " + name;
       },
       [](const std::string& command, const std::string& option) { return command + option; },
       ", see the manual"});
  int rows = 1;
  const Option option{.name = "rows", .place = &rows, .help = "", .range = from_to(1, 9)};
  EXPECT_EQ(option_word("rows"), "the rows");
  EXPECT_EQ(command_word("a", "b"), "ab");
  EXPECT_EQ(refusal_of(option, "10"), "set rows to 10: expected 1 to 9");
  EXPECT_EQ(refusal_of(option, "x"), "set rows to x: expected a whole number, see the manual");
  set_option_wording(before);
  EXPECT_EQ(refusal_of(option, "x"), "rows=x: expected a whole number");
}

}  // namespace
}  // namespace photohull
