// Features that scene files list, in the photographs' pixels.
#include <cstring>

#include "io/load_scene.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

using testing::HasSubstr;

class ReadTracks : public TemporaryFolder {
 protected:
  ReadTracks() {
    for (const char* name : {"a.png", "b.png", "c.png"}) put_image(std::string("images/") + name);
  }

  /// One track, at (2, 1) of the first view and (5.5, 3.25) of the last.
  static void expect_track(const Scene& scene) {
    ASSERT_EQ(scene.tracks.size(), 1u);
    const auto& o = scene.tracks[0].observations;
    ASSERT_EQ(o.size(), 2u);
    EXPECT_EQ(o[0].view, 0);
    EXPECT_LT(glm::distance(o[0].pixel, {2, 1}), 1e-12);
    EXPECT_EQ(o[1].view, int(scene.views.size()) - 1);
    EXPECT_LT(glm::distance(o[1].pixel, {5.5, 3.25}), 1e-12);
  }
};

TEST_F(ReadTracks, ColmapText) {
  put("cameras.txt", "1 PINHOLE 8 6 10 10 4 3\n");
  const std::string pose = " 1 0 0 0 0 0 0 1 ";
  const auto images = [&](const std::string& first) {
    put("images.txt", "1" + pose + "a.png\n" + first + "\n2" + pose + "b.png\n1 1 -1\n3" + pose +
                          "c.png\n6 3.75 77 6 3 77\n");
  };
  images("7 5 -1 2.5 1.5 77");
  expect_track(load_scene(folder_));
  // Views that are left out take their places along.
  LoadSceneOptions options;
  options.views = "a.png,c.png";
  expect_track(load_scene(folder_, options));
  options.views = "a.png,b.png";
  EXPECT_TRUE(load_scene(folder_, options).tracks.empty());
  images("7 5 -1 2.5");
  EXPECT_THAT(error_of([&] { load_scene(folder_); }), HasSubstr("4 fields found"));
  images("7 five -1");
  EXPECT_THAT(error_of([&] { load_scene(folder_); }), HasSubstr("images.txt line 2"));
}

TEST_F(ReadTracks, ColmapBinary) {
  std::string bytes;
  const auto add = [&bytes](const auto& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  add(std::uint64_t(1)), add(std::uint32_t(1)), add(std::int32_t(1));
  add(std::uint64_t(8)), add(std::uint64_t(6));
  for (const double p : {10.0, 10.0, 4.0, 3.0}) add(p);
  put("cameras.bin", bytes);
  bytes.clear();
  add(std::uint64_t(2));
  for (std::uint32_t i = 0; i < 2; ++i) {
    add(i + 1);
    for (const double q : {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0}) add(q);
    add(std::uint32_t(1));
    bytes += i == 0 ? "a.png" : "c.png";
    bytes += '\0';
    add(std::uint64_t(2));
    add(1.0), add(1.0), add(std::int64_t(-1));
    add(i == 0 ? 2.5 : 6.0), add(i == 0 ? 1.5 : 3.75), add(std::int64_t(9));
  }
  put("images.bin", bytes);
  expect_track(load_scene(folder_));
}

TEST_F(ReadTracks, Bundler) {
  const std::string camera = "10 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n";
  put("list.txt", "a.png\nb.png\nc.png\n");
  const auto bundle = [&](const std::string& track) {
    put("bundle.out", "# Bundle file v0.3\n3 1\n" + camera + "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n" +
                          camera + "0 0 -5\n128 128 128\n" + track + "\n");
  };
  // From the middle (3.5, 2.5), y up; the second image has no camera.
  bundle("3 0 11 -1.5 1.5 1 12 0 0 2 13 2 -0.75");
  expect_track(load_scene(folder_));
  bundle("2 0 11 -1.5 1.5 1 12");
  EXPECT_THAT(error_of([&] { load_scene(folder_); }), HasSubstr("a track of 2 is stated"));
  bundle("1 7 11 -1.5 1.5");
  EXPECT_THAT(error_of([&] { load_scene(folder_); }), HasSubstr("the view 7"));
}

TEST_F(ReadTracks, Nvm) {
  const std::string pose = " 10 1 0 0 0 0 0 0 0 0\n";
  const auto model = [&](const std::string& track) {
    put("scene.nvm",
        "NVM_V3\n\n2\na.png" + pose + "c.png" + pose + "\n1\n0 0 5 1 2 3 " + track + "\n");
  };
  // From the image's middle (3.5, 2.5), y down.
  model("2 0 4 -1.5 -1.5 1 4 2 0.75");
  expect_track(load_scene(folder_));
  model("3 0 4 -1.5 -1.5 1 4 2 0.75");
  EXPECT_THAT(error_of([&] { load_scene(folder_); }), HasSubstr("a track of 3 is stated"));
  model("1 -1 4 0 0");
  EXPECT_THAT(error_of([&] { load_scene(folder_); }), HasSubstr("the view -1"));
}

TEST_F(ReadTracks, OpenMvg) {
  const auto view = [](int key, const char* name, int pose) {
    return concat(R"({"key":)", key, R"(,"value":{"ptr_wrapper":{"data":{"filename":")", name,
                  R"(","width":8,"height":6,"id_intrinsic":0,"id_pose":)", pose, "}}}}");
  };
  const std::string pose = R"({"rotation":[[1,0,0],[0,1,0],[0,0,1]],"center":[0,0,0]})";
  const auto model = [&](const std::string& observations) {
    put("sfm_data.json",
        R"({"sfm_data_version":"0.3","root_path":"images","views":[)" + view(30, "a.png", 0) + "," +
            view(31, "b.png", 7) + "," + view(32, "c.png", 0) +
            R"(],"intrinsics":[{"key":0,"value":{"polymorphic_id":2147483649,"polymorphic_name":)"
            R"("pinhole","ptr_wrapper":{"id":2147483649,"data":{"width":8,"height":6,)"
            R"("focal_length":10,"principal_point":[4,3]}}}}],"extrinsics":[{"key":0,"value":)" +
            pose + R"(}],"structure":[{"key":9,"value":{"X":[0,0,5],"observations":[)" +
            observations + "]}}]}");
  };
  // The second image has no pose.
  const std::string rest = R"(,{"key":31,"value":{"id_feat":1,"x":[3,3]}})"
                           R"(,{"key":32,"value":{"id_feat":2,"x":[5.5,3.25]}})";
  model(R"({"key":30,"value":{"id_feat":0,"x":[2,1]}})" + rest);
  expect_track(load_scene(folder_));
  model(R"({"key":30,"value":{"id_feat":0,"x":[2]}})" + rest);
  EXPECT_THAT(error_of([&] { load_scene(folder_); }), HasSubstr("structure"));
}

TEST_F(ReadTracks, AliceVision) {
  std::string views;
  for (const std::string name : {"a", "b", "c"})
    views += concat(views.empty() ? "" : ",", R"({"viewId":"id_)", name, R"(","poseId":")",
                    name == "b" ? "none" : "0", R"(","intrinsicId":"7","path":"images/)", name,
                    R"(.png","width":"8","height":"6"})");
  const auto model = [&](const std::string& x) {
    put("cameras.sfm",
        R"({"version":["1","2","6"],"views":[)" + views +
            R"(],"intrinsics":[{"intrinsicId":"7","width":"8","height":"6","type":"pinhole",)"
            R"("focalLength":"45","sensorWidth":"36","pixelRatio":"1","principalPoint":["0","0"]}],)"
            R"("poses":[{"poseId":"0","pose":{"transform":{"rotation":)"
            R"(["1","0","0","0","1","0","0","0","1"],"center":["0","0","0"]}}}],)"
            R"("structure":[{"landmarkId":"3","X":["0","0","5"],"observations":[)"
            R"({"observationId":"id_a","featureId":"1","x":)" +
            x +
            R"(},{"observationId":"id_b","featureId":"2","x":["3","3"]},)"
            R"({"observationId":"id_c","featureId":"3","x":["5.5","3.25"]}]}]})");
  };
  model(R"(["2","1"])");
  expect_track(load_scene(folder_));
  model(R"(["two","1"])");
  EXPECT_THAT(error_of([&] { load_scene(folder_); }), HasSubstr("structure"));
}

}  // namespace
}  // namespace photohull::io
