#include "options_reference.h"
#include "support/places.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace photohull::pipeline {
namespace {

TEST(OptionsReference, IsWhatTheProgramDescribes) {
  std::ifstream page(test::in_checkout("docs/reference/options.md"));
  std::stringstream text;
  text << page.rdbuf();
  EXPECT_EQ(text.str(), options_reference())
      << "write it anew with tests/pipeline/write_options_reference of the build folder";
}

}  // namespace
}  // namespace photohull::pipeline
