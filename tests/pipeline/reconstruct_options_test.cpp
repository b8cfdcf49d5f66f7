// Options of a job as text: what is read, refused and reported.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {
namespace {

class OptionText : public testing::Test {
 protected:
  OptionText() { describe(described_, options_, load_); }

  void read(const std::string& name, const std::string& text) {
    read_option(*described_.find(name), text);
  }

  /// What is said of a text that is not legal.
  std::string refusal(const std::string& name, const std::string& text) {
    try {
      read(name, text);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "'" + text + "' was taken";
  }

  ReconstructOptions options_;
  io::LoadSceneOptions load_;
  Described described_;
};

TEST_F(OptionText, AutoOrANumberOfViews) {
  read("views_may_miss", "0");
  EXPECT_EQ(options_.views_may_miss, 0);
  read("views_may_miss", "16");
  EXPECT_EQ(options_.views_may_miss, 16);
  read("views_may_miss", "auto");
  EXPECT_EQ(options_.views_may_miss, std::nullopt);
  for (const std::string bad :
       {"", "-1", "17", "two", "1.5", "3 ", " 3", "+3", "0x2", "99999999999", "Auto", "auto2"})
    EXPECT_EQ(refusal("views_may_miss", bad),
              "views_may_miss=" + bad + ": expected auto, or a number of views from 0 to 16");
}

TEST_F(OptionText, TexturesAreAutoOffOrAPowerOfTwo) {
  read("texture", "off");
  EXPECT_TRUE(options_.texture.off);
  read("texture", "2048");
  EXPECT_FALSE(options_.texture.off);
  EXPECT_EQ(options_.texture.edge, 2048);
  EXPECT_EQ(text_of(*described_.find("texture")), "2048");
  read("texture", "auto");
  EXPECT_EQ(options_.texture.edge, 0);
  for (const std::string bad : {"", "64", "1000", "8192", "-256", " 256", "256 ", "on", "2K"})
    EXPECT_EQ(refusal("texture", bad),
              "texture=" + bad + ": expected auto, off, or a power of two from 128 to 4096");
}

TEST(ReconstructOptions, ATextureNeedsAFileThatHoldsIt) {
  ReconstructOptions options;
  options.texture.edge = 512;
  options.exports = {"stl"};
  EXPECT_THROW(options.validate(), UsageError);
  options.exports = {"stl", "glb"};
  options.validate();
}

TEST(ReconstructOptions, DetailNeedsATexture) {
  ReconstructOptions options;
  options.texture.detail = 1.5;
  EXPECT_THROW(options.validate(), UsageError);
  options.exports = {"obj"};
  options.validate();
  options.texture.off = true;
  EXPECT_THROW(options.validate(), UsageError);
}

TEST_F(OptionText, DetailAndEdgeOfATextureStandBesideEachOther) {
  read("texture_detail", "1.25");
  read("texture", "2048");
  EXPECT_EQ(options_.texture.detail, 1.25);
  EXPECT_EQ(options_.texture.edge, 2048);
  EXPECT_NE(refusal("texture_detail", "-0.1"), "");
  EXPECT_NE(refusal("texture_detail", "4.1"), "");
}

TEST_F(OptionText, ScalesAreFractionsOrNumbers) {
  read("image_scale", "1/4");
  EXPECT_EQ(options_.image_scale, 0.25);
  read("image_scale", "auto");
  EXPECT_EQ(options_.image_scale, std::nullopt);
  for (const std::string bad : {"", "0", "1.5", "1/0", "half"})
    EXPECT_EQ(refusal("image_scale", bad), "image_scale=" + bad +
                                               ": expected auto, or a scale above 0 and up to 1, "
                                               "such as 1/4 or 0.3");
}

TEST_F(OptionText, MemoryHasAUnit) {
  read("max_memory", "1.5GiB");
  EXPECT_EQ(options_.max_memory, std::int64_t(3) << 29);
  EXPECT_EQ(refusal("max_memory", "2"),
            "max_memory=2: expected auto, or a size with its unit such as 512M or 2G");
}

TEST_F(OptionText, MeshErrorsAreVoxelsOrWorldUnits) {
  read("mesh_error", "0.25");
  EXPECT_EQ(options_.mesh_error.value, 0.25);
  EXPECT_FALSE(options_.mesh_error.world_units);
  read("mesh_error", "0.002u");
  EXPECT_TRUE(options_.mesh_error.world_units);
  for (const std::string bad : {"", "-1", "u", "1v", "nan"})
    EXPECT_THAT(refusal("mesh_error", bad), testing::StartsWith("mesh_error=" + bad + ": exp"));
}

TEST_F(OptionText, NumbersOutOfRangeAreNamed) {
  EXPECT_EQ(refusal("resolution", "1"), "resolution=1: at least 2");
  EXPECT_EQ(refusal("resolution", "3.5"), "resolution=3.5: expected a whole number");
  EXPECT_EQ(refusal("voxel_size", "nan"), "voxel_size=nan: must be finite and positive");
  EXPECT_EQ(refusal("noise", "-3"), "noise=-3: expected 8-bit codes from 0 to 255");
  EXPECT_EQ(refusal("threads", "-1"), "threads=-1: 0 (one a core) or more");
  EXPECT_EQ(refusal("supersample", "9"), "supersample=9: expected 1 to 8");
  EXPECT_EQ(refusal("mask_offset", "101"),
            "mask_offset=101: expected auto, or pixels from -100 to 100");
  EXPECT_EQ(refusal("noise", "1e9"), "noise=1e9: expected 8-bit codes from 0 to 255")
      << "as it was written";
}

TEST_F(OptionText, ValuesThatAProgramSetsAreCheckedInTheSameWords) {
  options_.validate();
  options_.threads = -1;
  EXPECT_THAT([&] { options_.validate(); },
              testing::ThrowsMessage<UsageError>("threads=-1: 0 (one a core) or more"));
}

TEST_F(OptionText, ReportHasWhatIsGivenAndSomeDefaults) {
  const std::string usual = option_line(options_, load_);
  EXPECT_EQ(usual,
            "quality=normal method=refine photometric=auto mesh_error=0 unseen=auto "
            "surroundings=off masks=auto mask_offset=auto views_may_miss=auto image_scale=auto "
            "device=auto");
  options_.threads = 3;
  options_.evidence = options_.fresh = true;
  EXPECT_EQ(option_line(options_, load_), usual) << "what changes no result";
  options_.sampler = projtex::Sampler::kEwa;
  options_.box.find = true;
  options_.keep_mask_holes = true;
  const NamedValues named = named_options(options_, load_);
  for (const auto& [name, value] : NamedValues{{"sampler", "ewa"},
                                               {"box", "auto"},
                                               {"mask_holes", "keep"},
                                               {"threads", "3"},
                                               {"evidence", "true"}})
    EXPECT_THAT(named, testing::Contains(testing::Pair(name, value)));
}

}  // namespace
}  // namespace photohull::pipeline
