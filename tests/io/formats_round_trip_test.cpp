// One scene through every format and back, and every format's files damaged in every way.
#include <algorithm>
#include <fstream>
#include <random>
#include <set>

#include "io/find_files.h"
#include "io/load_scene.h"
#include "io/natural_less.h"
#include "io/write_scene.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using testing::HasSubstr;

constexpr double kTolerance = 1e-6;  // pixels

bool keeps_skew(SceneFormat f) {
  return f == SceneFormat::kMiddlebury || f == SceneFormat::kMetashape ||
         f == SceneFormat::kStrecha || f == SceneFormat::kPmvs || f == SceneFormat::kMvsNet ||
         f == SceneFormat::kProjection || f == SceneFormat::kMatlab || f == SceneFormat::kOpenCv;
}

bool wants_square_pixels(SceneFormat f) {
  return f == SceneFormat::kBundler || f == SceneFormat::kNvm || f == SceneFormat::kOpenMvg ||
         f == SceneFormat::kRealityCapture;
}

bool wants_centred(SceneFormat f) { return f == SceneFormat::kBundler || f == SceneFormat::kNvm; }

bool has_brown(SceneFormat f) {
  return f == SceneFormat::kColmapBinary || f == SceneFormat::kColmapText ||
         f == SceneFormat::kTransforms || f == SceneFormat::kAliceVision ||
         f == SceneFormat::kOpenMvg || f == SceneFormat::kMetashape ||
         f == SceneFormat::kRealityCapture || f == SceneFormat::kOpenCv;
}

bool has_fisheye(SceneFormat f) { return has_brown(f) && f != SceneFormat::kRealityCapture; }

bool has_eighth_power(SceneFormat f) {
  return f == SceneFormat::kTransforms || f == SceneFormat::kMetashape ||
         f == SceneFormat::kRealityCapture;
}

bool has_rational(SceneFormat f) {
  return f == SceneFormat::kColmapBinary || f == SceneFormat::kColmapText ||
         f == SceneFormat::kTransforms || f == SceneFormat::kOpenCv;
}

/// Views of formats that number their images come back under other names.
double largest_shift_in_order(const Scene& a, Scene b) {
  if (a.views.size() != b.views.size()) return 1e9;
  for (std::size_t i = 0; i < a.views.size(); ++i) b.views[i].name = a.views[i].name;
  return largest_shift(a, b);
}

std::string contents(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class EveryFormat : public testing::WithParamInterface<SceneFormat>, public TemporaryFolder {
 protected:
  EveryFormat() {
    for (const char* name : {"a.png", "b.png", "c.png"}) put_image(std::string("images/") + name);
    scene_ = example_scene(folder_ / "images");
    for (SourceView& view : scene_.views) {
      Intrinsics& k = view.camera.intrinsics;
      if (wants_square_pixels(GetParam())) k.fy = k.fx;
      if (wants_centred(GetParam())) k.cx = 0.5 * (k.width - 1), k.cy = 0.5 * (k.height - 1);
    }
  }

  Scene round_trip() const {
    write_scene(scene_, GetParam(), folder_ / "out");
    return load_scene(folder_ / "out");
  }

  /// The files that say where the cameras are.
  std::vector<fs::path> written_files() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out"))
      if (entry.is_regular_file() && entry.path().extension() != ".png")
        files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
  }

  /// Loads what is there: a scene or an Error that names something of it.
  void expect_scene_or_error() const {
    LoadSceneOptions options;
    options.format = GetParam();
    try {
      load_scene(folder_ / "out", options);
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr((folder_ / "out").string()));
    } catch (const std::exception& other) {
      ADD_FAILURE() << "not an Error: " << other.what();
    }
  }

  Scene scene_;
};

INSTANTIATE_TEST_SUITE_P(, EveryFormat, testing::ValuesIn(scene_formats()), [](const auto& tested) {
  std::string name = to_string(tested.param);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST_P(EveryFormat, ReadsBackToTheSameCameras) {
  const Scene back = round_trip();
  EXPECT_EQ(back.format, GetParam());
  EXPECT_LT(largest_shift_in_order(scene_, back), kTolerance);
  ASSERT_EQ(back.views.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(back.views[i].distortion.model, DistortionModel::kNone);
    EXPECT_EQ(contents(back.views[i].image), contents(scene_.views[i].image));
  }
  ASSERT_TRUE(back.box);
  EXPECT_EQ(back.box->min, scene_.box->min);
  EXPECT_EQ(back.box->max, scene_.box->max);
}

TEST_P(EveryFormat, SkewIsKeptOrRefused) {
  scene_.views[1].camera.intrinsics.skew = 0.75;
  if (keeps_skew(GetParam()))
    EXPECT_LT(largest_shift_in_order(scene_, round_trip()), kTolerance);
  else
    EXPECT_THAT(error_of([&] { round_trip(); }), HasSubstr("skew of 0.75"));
}

TEST_P(EveryFormat, UnlikeFocalLengthsAreKeptOrRefused) {
  scene_.views[1].camera.intrinsics.fy = 13;
  if (!wants_square_pixels(GetParam()))
    EXPECT_LT(largest_shift_in_order(scene_, round_trip()), kTolerance);
  else
    EXPECT_THAT(error_of([&] { round_trip(); }), HasSubstr("focal lengths of 11 and 13"));
}

TEST_P(EveryFormat, DistortionIsKeptOrRefused) {
  const struct {
    Distortion distortion;
    bool kept;
  } cases[] = {
      {{DistortionModel::kBrown, {0.1, -0.2, 0.03, 0.04, 0.5}}, has_brown(GetParam())},
      {{DistortionModel::kBrown, {0.1, -0.2}},
       has_brown(GetParam()) || GetParam() == SceneFormat::kBundler},
      {{DistortionModel::kFisheye, {0.1, 0.2, -0.3, 0.4}}, has_fisheye(GetParam())},
      {{DistortionModel::kPolynomial, {0.1, 0.2, 0.01, 0.02, 0.3, 0.4}},
       has_eighth_power(GetParam())},
      {{DistortionModel::kBrown, {.1, .2, .3, .4, .5, .6, .7, .8}}, has_rational(GetParam())},
      {{DistortionModel::kMeasured, {-0.1}}, GetParam() == SceneFormat::kNvm}};
  for (const auto& [distortion, kept] : cases) {
    for (SourceView& view : scene_.views) view.distortion = distortion;
    if (!kept) {
      EXPECT_THAT(error_of([&] { round_trip(); }), HasSubstr("distortion"));
      continue;
    }
    const Scene back = round_trip();
    for (const SourceView& view : back.views) {
      EXPECT_EQ(view.distortion.model, distortion.model);
      EXPECT_EQ(view.distortion.coefficients, distortion.coefficients);
    }
  }
}

TEST_P(EveryFormat, FilesGivenByPathAreRecognised) {
  round_trip();
  const std::set<std::string> beside = {"bbox.txt", "list.txt", "points.ply"};  // tell no cameras
  for (const fs::path& file : written_files()) {
    if (beside.contains(file.filename().string())) continue;
    EXPECT_EQ(load_scene(file).format, GetParam()) << file;
  }
}

// Deterministic damage: pieces cut off, lines swapped, bytes changed, removed and repeated.
TEST_P(EveryFormat, DamagedFilesGiveASceneOrAnError) {
  constexpr int kRounds = 60;  // a file
  round_trip();
  std::mt19937 random(20240 + unsigned(GetParam()));
  const auto below = [&](std::size_t n) { return n ? random() % n : 0; };
  const std::string palette = "\0\xff\x80-+.eE019nanif\"[]{}<>/,: \n\r#\\&;%*!"s;
  for (const fs::path& file : written_files()) {
    const std::string whole = contents(file);
    for (int round = 0; round < kRounds; ++round) {
      std::string bytes = whole;
      switch (below(5)) {
        case 0:
          bytes.resize(below(bytes.size()));
          break;
        case 1: {  // two lines swapped
          std::vector<std::string> lines(1);
          for (const char c : bytes) {
            lines.back() += c;
            if (c == '\n') lines.emplace_back();
          }
          std::swap(lines[below(lines.size())], lines[below(lines.size())]);
          bytes.clear();
          for (const std::string& line : lines) bytes += line;
          break;
        }
        case 2:
          for (std::size_t hits = 1 + below(4); hits > 0; --hits)
            bytes[below(bytes.size())] = palette[below(palette.size())];
          break;
        case 3:
          bytes[below(bytes.size())] ^= char(1u << below(8));
          break;
        default: {
          const std::size_t at = below(bytes.size());
          if (below(2))
            bytes.erase(at, 1 + below(24));
          else
            bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(40)));
        }
      }
      std::ofstream(file, std::ios::binary) << bytes;
      expect_scene_or_error();
    }
    std::ofstream(file, std::ios::binary) << whole;
  }
  EXPECT_LT(largest_shift_in_order(scene_, load_scene(folder_ / "out")), kTolerance);
}

TEST(NaturalOrder, NumbersCompareAsNumbers) {
  EXPECT_TRUE(natural_less("view2", "view10"));
  EXPECT_FALSE(natural_less("view10", "view2"));
  EXPECT_TRUE(natural_less("view010a", "view10b"));
  EXPECT_TRUE(natural_less("a", "ab"));
  EXPECT_FALSE(natural_less("a", "a"));
}

}  // namespace
}  // namespace photohull::io
