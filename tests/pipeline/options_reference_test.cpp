#include "options_reference.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace photohull::pipeline {
namespace {

TEST(OptionsReference, IsWhatTheProgramDescribes) {
  std::ifstream page(PHOTOHULL_DOCS "/reference/options.md");
  std::stringstream text;
  text << page.rdbuf();
  EXPECT_EQ(text.str(), options_reference())
      << "write it anew with tests/pipeline/write_options_reference of the build folder";
}

}  // namespace
}  // namespace photohull::pipeline
