#include "core/shell_word.h"

#include <gtest/gtest.h>

#include <string>

namespace photohull {
namespace {

TEST(ShellWord, QuotesWhatAShellWouldRead) {
  EXPECT_EQ(shell_word("out/temple-1_b.x"), "out/temple-1_b.x");
  EXPECT_EQ(shell_word(""), "''");
  for (const std::string text : {"a b", "$x", "a;b", "~", "*", "a\nb", "`x`", "\"", "#", "(x)"})
    EXPECT_EQ(shell_word(text), "'" + text + "'");
  EXPECT_EQ(shell_word("it's"), "'it'\\''s'");
}

}  // namespace
}  // namespace photohull
