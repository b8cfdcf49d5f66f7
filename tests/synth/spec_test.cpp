#include "synth/spec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "support/places.h"

namespace photohull::synth {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string message_of(const std::string& text) {
  try {
    parse_spec(text, "wrong.json", "");
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

TEST(Spec, NothingSaidGivesTheDefaults) {
  const Spec spec = parse_spec("{}", "spec", "");
  EXPECT_EQ(spec.geometry.shape, "sphere");
  EXPECT_EQ(spec.geometry.parameters.at("radius"), 1.0);
  EXPECT_EQ(spec.image.width, 640);
  EXPECT_EQ(view_count(spec.cameras), 36);
}

TEST(Spec, WrittenOutItReadsBackEqual) {
  const std::string text = R"({"name": "x", "seed": 18446744073709551615,
    "geometry": {"shape": "torus", "parameters": {"tube": 0.3}, "rotate": [1, 2, 3]},
    "motion": {"tube": [0.2, 0.4], "rotate": [[0, 0, 0], [0, 0, 90]]}, "moment": {"frame": 2, "frames": 5},
    "light": {"point": [{"position": [1, 2, 3]}], "directional": []},
    "cameras": {"layout": "arc", "count": 7, "distances": [1, 2]},
    "degradations": {"mask_wrong": [1], "jpeg": 80, "k1": -0.1, "mask_style": "eroded",
                     "mask_cut": 0.25, "view_shift": 1.5, "motion_blur": 7, "motion_blur_views": 0.5, "view_shift_views": 0.125}})";
  const std::string once = spec_text(parse_spec(text, "a", ""), R"({"views": ["0000"]})");
  const Spec again = parse_spec(once, "b", "");
  EXPECT_EQ(spec_text(again, R"({"views": ["0000"]})"), once);
  EXPECT_EQ(again.seed, 18446744073709551615ull);
  EXPECT_EQ(again.geometry.parameters.at("tube"), 0.3);
  EXPECT_EQ(again.geometry.parameters.at("radius"), 1.0);
  EXPECT_EQ(again.motion.parameters.at("tube"), (std::array<double, 2>{0.2, 0.4}));
  EXPECT_EQ(again.motion.rotate, (std::vector<glm::dvec3>{{0, 0, 0}, {0, 0, 90}}));
  EXPECT_TRUE(again.motion.translate.empty());
  EXPECT_EQ(again.moment.frame, 2);
  EXPECT_EQ(again.light.directional.size(), 0u);
  EXPECT_EQ(again.light.point.at(0).position.y, 2.0);
  EXPECT_EQ(again.degradations.mask_wrong, std::vector<int>{1});
  EXPECT_EQ(again.degradations.mask_style, "eroded");
  EXPECT_EQ(again.degradations.mask_cut, 0.25);
  EXPECT_EQ(again.degradations.view_shift, 1.5);
  EXPECT_EQ(again.degradations.motion_blur, 7);
  EXPECT_EQ(again.degradations.motion_blur_views, 0.5);
  EXPECT_EQ(again.degradations.view_shift_views, 0.125);
}

TEST(Spec, UnknownFieldsAreNamedWithTheNearestKnownOne) {
  EXPECT_THAT(message_of(R"({"material": {"contrats": 1}})"),
              AllOf(HasSubstr("wrong.json"), HasSubstr("material.contrats"),
                    HasSubstr("did you mean contrast?")));
  EXPECT_THAT(message_of(R"({"geometry": {"shape": "sphere", "parameters": {"radios": 1}}})"),
              AllOf(HasSubstr("geometry.parameters.radios"), HasSubstr("radius")));
  EXPECT_THAT(message_of(R"({"cameras": {"rings": [{"count": 3}, {"elevatoin": 3}]}})"),
              AllOf(HasSubstr("cameras.rings[1].elevatoin"), HasSubstr("elevation")));
  EXPECT_THAT(message_of(R"({"zzzzzzzzzzz": 1})"), HasSubstr("known are"));
}

TEST(Spec, WrongTypesAndRangesAreNamed) {
  EXPECT_THAT(message_of(R"({"image": {"width": "wide"}})"),
              AllOf(HasSubstr("image.width"), HasSubstr("expected a number"), HasSubstr("wide")));
  EXPECT_THAT(message_of(R"({"image": {"width": 99999}})"),
              AllOf(HasSubstr("image.width"), HasSubstr("16384"), HasSubstr("99999")));
  EXPECT_THAT(message_of(R"({"image": {"width": 64.5}})"), HasSubstr("whole number"));
  EXPECT_THAT(message_of(R"({"image": 3})"), AllOf(HasSubstr("image"), HasSubstr("object")));
  EXPECT_THAT(message_of(R"({"material": {"base": [1, 2]}})"), HasSubstr("material.base"));
  EXPECT_THAT(message_of(R"({"material": {"base": [0.1, 0.2]}})"), HasSubstr("expected 3 numbers"));
  EXPECT_THAT(message_of(R"({"material": {"pattern": "nois"}})"),
              AllOf(HasSubstr("noise, checker"), HasSubstr("did you mean noise?")));
  EXPECT_THAT(message_of(R"({"light": {"shadows": 1}})"), HasSubstr("true or false"));
  EXPECT_THAT(message_of(R"({"light": {"shadow_test": "varianc"}})"),
              AllOf(HasSubstr("light.shadow_test"), HasSubstr("rays, plain"), HasSubstr("lists"),
                    HasSubstr("did you mean variance?")));
  EXPECT_THAT(message_of(R"({"light": {"shadow_texels": 9000}})"),
              AllOf(HasSubstr("light.shadow_texels"), HasSubstr("8192")));
  EXPECT_THAT(message_of(R"({"seed": -1})"), HasSubstr("seed"));
  EXPECT_THAT(message_of(R"({"cameras": {"distances": []}})"), HasSubstr("one number at least"));
  EXPECT_THAT(message_of(R"({"cameras": {"rings": []}})"), HasSubstr("cameras.rings"));
  EXPECT_THAT(message_of(R"({"image": {"bits": 12}})"),
              AllOf(HasSubstr("image.bits"), HasSubstr("8 or 16"), HasSubstr("12")));
  EXPECT_THAT(message_of(R"({"image": {"bits": 16}, "degradations": {"jpeg": 50}})"),
              HasSubstr("JPEG has 8 bits"));
  EXPECT_THAT(
      message_of(R"({"degradations": {"mask_style": "alised"}})"),
      AllOf(HasSubstr("degradations.mask_style"), HasSubstr("coverage, aliased, cut, eroded"),
            HasSubstr("did you mean aliased?")));
  EXPECT_THAT(message_of(R"({"degradations": {"mask_cut": 0}})"),
              AllOf(HasSubstr("degradations.mask_cut"), HasSubstr("0.01 to 1")));
  EXPECT_THAT(message_of(R"({"degradations": {"mask_style": "aliased", "mask_grow": -1}})"),
              AllOf(HasSubstr("degradations.mask_style"), HasSubstr("degradations.mask_grow")));
  EXPECT_EQ(message_of(R"({"degradations": {"mask_style": "eroded", "mask_grow": -1}})"),
            "accepted");
  EXPECT_THAT(message_of(R"({"degradations": {"view_shift": 51}})"),
              AllOf(HasSubstr("degradations.view_shift"), HasSubstr("0 to 50")));
  EXPECT_THAT(message_of(R"({"degradations": {"view_shift_views": 2}})"),
              AllOf(HasSubstr("degradations.view_shift_views"), HasSubstr("0 to 1")));
  EXPECT_THAT(message_of("[1]"), HasSubstr("object"));
  EXPECT_THAT(message_of("{"), HasSubstr("not valid JSON"));
  constexpr int kLevels = 300000;  // more than the stack has room for
  EXPECT_THAT(
      message_of(R"({"name": )" + std::string(kLevels, '[') + std::string(kLevels, ']') + "}"),
      HasSubstr("levels"));
  EXPECT_THAT(message_of(R"({"name": "a/b"})"), HasSubstr("name"));
}

TEST(Spec, MotionsHaveTwoEndsOfWhatTheGeometryHas) {
  const auto figure = [](const std::string& motion) {
    return message_of(R"({"geometry": {"shape": "figure"}, "motion": )" + motion + "}");
  };
  EXPECT_EQ(figure(R"({"phase": [0, 1], "translate": [[0, 0, 0], [1, 0, 0]]})"), "accepted");
  EXPECT_THAT(figure(R"({"phase": [0, 2]})"),
              AllOf(HasSubstr("wrong.json: motion.phase[1]"), HasSubstr("from 0 to 1")));
  EXPECT_THAT(figure(R"({"phase": [-1, 1]})"), HasSubstr("motion.phase[0]"));
  EXPECT_THAT(figure(R"({"fase": [0, 1]})"),
              AllOf(HasSubstr("motion.fase"), HasSubstr("did you mean phase?")));
  EXPECT_THAT(figure(R"({"phase": 0.5})"), AllOf(HasSubstr("motion.phase"), HasSubstr("a list")));
  EXPECT_THAT(figure(R"({"phase": [0, 0.5, 1]})"),
              AllOf(HasSubstr("motion.phase"), HasSubstr("two values"), HasSubstr("found 3")));
  EXPECT_THAT(figure(R"({"rotate": [0, 90]})"), HasSubstr("motion.rotate[0]"));
  EXPECT_THAT(figure(R"({"translate": [[0, 0, 0], [1, 0]]})"),
              AllOf(HasSubstr("motion.translate[1]"), HasSubstr("3 numbers")));
  EXPECT_THAT(figure(R"({"rotate": [[0, 0, 0], [0, 0, 720]]})"),
              AllOf(HasSubstr("motion.rotate[1][2]"), HasSubstr("360")));
  EXPECT_THAT(message_of(R"({"geometry": {"mesh": "a.ply"}, "motion": {"phase": [0, 1]}})"),
              AllOf(HasSubstr("motion.phase"), HasSubstr("known are rotate, translate")));
  EXPECT_THAT(message_of(R"({"moment": {"frame": 3, "frames": 3}})"),
              AllOf(HasSubstr("moment.frame"), HasSubstr("the last of which is 2")));
  EXPECT_THAT(message_of(R"({"motion": {"radius": [1, 2]}, "sheet": {"turn": [90, 0, 0]}})"),
              AllOf(HasSubstr("sheet.turn"), HasSubstr("motion")));
}

TEST(Spec, WorkWithoutBoundIsRefused) {
  EXPECT_THAT(message_of(R"({"cameras": {"rings": [{"count": 2000}, {"count": 2000}]}})"),
              HasSubstr("2000"));
  EXPECT_THAT(message_of(R"({"cameras": {"layout": "arc", "count": 2000},
                             "image": {"width": 16384, "height": 16384, "samples": 16}})"),
              HasSubstr("lower width, height or samples"));
  EXPECT_THAT(message_of(R"({"degradations": {"missing_views": [36]}})"), HasSubstr("view 36"));
}

TEST(Spec, ShapeOrMeshButNotBoth) {
  EXPECT_THAT(message_of(R"({"geometry": {"shape": "cube", "mesh": "a.ply"}})"),
              HasSubstr("not both"));
  EXPECT_THAT(message_of(R"({"geometry": {"shape": "spere"}})"), HasSubstr("did you mean sphere?"));
  const Spec spec = parse_spec(R"({"geometry": {"mesh": "a.ply"}})", "s", "/data/scans");
  EXPECT_EQ(spec.geometry.mesh, "/data/scans/a.ply");
}

TEST(Spec, EveryDatasetParses) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::in_checkout("datasets/synthetic"))) {
    if (entry.path().extension() != ".json") continue;
    const Spec spec = read_spec(entry.path());
    EXPECT_EQ(spec.name, entry.path().stem().string());
    EXPECT_GE(view_count(spec.cameras), 18) << spec.name;
    // A place in a room is seen by a part of the cameras only: it takes more of them.
    EXPECT_LE(view_count(spec.cameras), spec.cameras.layout == "within" ? 48 : 36) << spec.name;
    ++count;
  }
  EXPECT_GE(count, 12);
}

TEST(Spec, ViewCountIsDealtToTheRings) {
  CameraSpec cameras;
  cameras.rings = {{12, 0, 0}, {6, 30, 0}, {6, 60, 0}};
  set_view_count(cameras, 9);
  EXPECT_EQ(view_count(cameras), 9);
  EXPECT_GT(cameras.rings[0].count, cameras.rings[1].count);
  set_view_count(cameras, 3);
  for (const Ring& ring : cameras.rings) EXPECT_EQ(ring.count, 1);
  EXPECT_THROW(set_view_count(cameras, 2), UsageError);
  EXPECT_THROW(set_view_count(cameras, kMostViews + 1), UsageError);
}

}  // namespace
}  // namespace photohull::synth
