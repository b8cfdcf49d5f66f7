// Small files of each format, written by hand from its definition. All of them describe one
// camera: at (5, 0, 0), looking at the origin with z up, focal length 100 pixels, image 8 x 6. The
// point (0, 0.1, 0.2) lies at (0.1, -0.2, 5) before it, two pixels right of the principal point
// and four above.
#include <zlib.h>

#include <cstring>

#include "io/find_files.h"
#include "io/load_scene.h"
#include "io/matlab_file.h"
#include "io/pose_parts.h"
#include "scene_fixture.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class ReadFormats : public TemporaryFolder {
 protected:
  ReadFormats() {
    put_image("a.png");
    put_image("b.png");
  }

  Scene load() const { return load_scene(folder_); }

  /// The principal point in our pixels, as the point's projection shows it, once the rest is right.
  static glm::dvec2 principal_of(const SourceView& view) {
    const auto pixel = view.camera.project({0, 0.1, 0.2});
    const auto center = view.camera.center();
    EXPECT_NEAR(glm::distance(center, glm::dvec3(5, 0, 0)), 0, 1e-9);
    EXPECT_NEAR(view.camera.intrinsics.fx, 100, 1e-9);
    EXPECT_NEAR(view.camera.intrinsics.fy, 100, 1e-9);
    return pixel ? *pixel - glm::dvec2(2, -4) : glm::dvec2(1e9);
  }

  static void expect_camera(const SourceView& view, double cx, double cy) {
    EXPECT_NEAR(glm::distance(principal_of(view), glm::dvec2(cx, cy)), 0, 1e-9);
  }

  std::string error() const {
    return error_of([&] { load(); });
  }
};

TEST_F(ReadFormats, Bundler) {
  // R's second and third rows turned round: y up, z back.
  const std::string camera = "100 0.25 -0.5\n0 1 0\n0 0 1\n1 0 0\n0 0 -5\n";
  put("list.txt", "a.png 0 3000.5\nb.png\nmissing.png\n");
  put("bundle.out", "# Bundle file v0.3\n3 1\n" + camera + camera +
                        "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n1 2 3\n255 0 0\n1 0 0 1.5 2.5\n");
  const Scene scene = load();
  ASSERT_THAT(scene.views, SizeIs(2));
  expect_camera(scene.views[0], 3.5, 2.5);
  EXPECT_EQ(scene.views[0].distortion.coefficients[1], -0.5);
  EXPECT_THAT(scene.points, ElementsAre(glm::dvec3(1, 2, 3)));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("1 of 3 images have no camera")));
  put("list.txt", "a.png\n");
  EXPECT_THAT(error(), HasSubstr("list.txt names 1 images"));
}

TEST_F(ReadFormats, Nvm) {
  // The rotation's quaternion: all of w, x, y, z are 1/2 in size.
  const std::string camera = " 100 0.5 0.5 0.5 -0.5 5 0 0 0.125 0\n";
  put("scene.nvm", "NVM_V3 \n\n2\na.png" + camera + "b.png" + camera +
                       "\n1\n1 2 3 255 255 255 2 0 7 1.5 2.5 1 8 0 0\n\n0\n");
  const Scene scene = load();
  const glm::dmat3 r = glm::transpose(glm::dmat3(0, 1, 0, 0, 0, -1, -1, 0, 0));
  const glm::dmat3& found = scene.views[0].camera.cam_from_world.rotation;
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(glm::distance(found[i], r[i]), 0, 1e-12) << i;
  expect_camera(scene.views[0], 3.5, 2.5);
  EXPECT_EQ(scene.views[1].distortion.model, DistortionModel::kMeasured);
  EXPECT_EQ(scene.views[1].distortion.coefficients[0], 0.125);
  EXPECT_THAT(scene.points, SizeIs(1));
  put("scene.nvm", "NVM_V3 FixedK 100 4 100 3 0\n2\na.png" + camera + "b.png" + camera);
  expect_camera(load().views[0], 3.5, 2.5);
  put("scene.nvm", "NVM_V2\n");
  EXPECT_THAT(error(), HasSubstr("NVM_V3"));
}

TEST_F(ReadFormats, OpenMvg) {
  const auto view = [](int id, const char* name, int pose) {
    return concat(R"({"key":)", id, R"(,"value":{"polymorphic_id":1073741824,"ptr_wrapper":{"id":)",
                  id + 1, R"(,"data":{"local_path":"","filename":")", name,
                  R"(","width":8,"height":6,"id_view":)", id, R"(,"id_intrinsic":0,"id_pose":)",
                  pose, "}}}}");
  };
  const std::string pose = R"({"rotation":[[0,1,0],[0,0,-1],[-1,0,0]],"center":[5,0,0]})";
  put("sfm_data.json",
      R"({"sfm_data_version":"0.3","root_path":".","views":[)" + view(0, "a.png", 0) + "," +
          view(1, "b.png", 1) + "," + view(2, "c.png", 2) +
          R"(],"intrinsics":[{"key":0,"value":{"polymorphic_id":2147483649,"polymorphic_name":)"
          R"("pinhole_brown_t2","ptr_wrapper":{"id":2147483660,"data":{"width":8,"height":6,)"
          R"("focal_length":100,"principal_point":[4,3],"disto_t2":[0.1,0.2,0.3,0.4,0.5]}}}}],)"
          R"("extrinsics":[{"key":0,"value":)" +
          pose + R"(},{"key":1,"value":)" + pose +
          R"(}],"structure":[{"key":9,"value":{"X":[1,2,3],"observations":[]}}]})");
  const Scene scene = load();
  ASSERT_THAT(scene.views, SizeIs(2));
  expect_camera(scene.views[0], 4, 3);
  EXPECT_THAT(scene.views[0].distortion.coefficients,
              ElementsAre(0.1, 0.2, 0.4, 0.5, 0.3, 0, 0, 0));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("1 of 3 images have no pose")));
  EXPECT_THAT(scene.points, SizeIs(1));
}

class AliceVision : public ReadFormats {
 protected:
  /// One intrinsic's fields by the version of the file.
  void put_scene(const std::string& version, const std::string& lens) {
    std::string views, poses;
    for (const char* name : {"a", "b"}) {
      const std::string id = name == std::string("a") ? "0" : "1";
      views += concat(views.empty() ? "" : ",", R"({"viewId":")", id, R"(","poseId":")", id,
                      R"(","intrinsicId":"7","path":"/elsewhere/)", name,
                      R"(.png","width":"8","height":"6"})");
      // By columns.
      poses += concat(poses.empty() ? "" : ",", R"({"poseId":")", id,
                      R"(","pose":{"transform":{"rotation":)",
                      R"(["0","0","-1","1","0","0","0","-1","0"],"center":["5","0","0"]}}})");
    }
    put("cameras.sfm", concat(R"({"version":[)", version, R"(],"views":[)", views,
                              R"(],"intrinsics":[{"intrinsicId":"7","width":"8","height":"6",)",
                              lens, R"(}],"poses":[)", poses, "]}"));
  }
};

TEST_F(AliceVision, FocalLengthsAndPrincipalPointsFollowTheVersion) {
  put_scene(R"("1","0","0")", R"("type":"pinhole","pxFocalLength":"100",)"
                              R"("principalPoint":["4.5","2.5"])");
  expect_camera(load().views[0], 4.5, 2.5);
  put_scene(R"("1","2","0")", R"("type":"pinhole","pxFocalLength":["100","100"],)"
                              R"("principalPoint":["4.5","2.5"])");
  expect_camera(load().views[0], 4.5, 2.5);
  put_scene(R"("1","2","1")", R"("type":"pinhole","pxFocalLength":["100","100"],)"
                              R"("principalPoint":["0.5","-0.5"])");
  expect_camera(load().views[0], 4.5, 2.5);
  // 450 mm of 36 mm for 8 pixels.
  put_scene(R"("1","2","6")", R"("type":"radial3","focalLength":"450","sensorWidth":"36",)"
                              R"("pixelRatio":"1","principalPoint":["0.5","-0.5"],)"
                              R"("distortionParams":["0.1","0.2","0.3"])");
  expect_camera(load().views[0], 4.5, 2.5);
  EXPECT_THAT(load().views[0].distortion.coefficients, ElementsAre(0.1, 0.2, 0, 0, 0.3, 0, 0, 0));
}

TEST_F(AliceVision, PixelRatioTurnedRoundInVersion125) {
  const std::string lens = R"("type":"pinhole","focalLength":"450","pixelRatio":"2",)"
                           R"("principalPoint":["0","0"])";
  put_scene(R"("1","2","4")", lens);
  EXPECT_NEAR(load().views[0].camera.intrinsics.fy, 50, 1e-9);
  put_scene(R"("1","2","5")", lens);
  EXPECT_NEAR(load().views[0].camera.intrinsics.fy, 200, 1e-9);
}

TEST_F(AliceVision, UnknownLensesAreNamed) {
  put_scene(R"("1","2","6")", R"("type":"3deanamorphic4","focalLength":"450",)"
                              R"("principalPoint":["0","0"],"distortionParams":["1"])");
  EXPECT_THAT(error(), AllOf(HasSubstr("3deanamorphic4"), HasSubstr("known: pinhole")));
}

TEST_F(ReadFormats, MetashapeWithChunkTransform) {
  // The chunk is half as large, moved by (1, 0, 0) and turned by a quarter about z: the world's
  // (5, 0, 0) is the chunk's (0, -2, 0), its -x the chunk's y.
  const std::string transform = "<transform>1 0 0 0  0 0 1 -2  0 -1 0 0  0 0 0 1</transform>";
  put("cameras.xml",
      R"(<?xml version="1.0"?><document version="1.5.0"><chunk><sensors><sensor id="3">)"
      R"(<resolution width="8" height="6"/><calibration type="frame" class="adjusted">)"
      R"(<resolution width="8" height="6"/><f>100</f><cx>0.5</cx><cy>-0.5</cy><k1>0.1</k1>)"
      R"(<k4>0.4</k4><p1>0.01</p1><p2>0.02</p2></calibration></sensor></sensors><cameras>)"
      R"(<camera id="0" sensor_id="3" label="a">)" +
          transform + R"(</camera><group label="g"><camera id="1" sensor_id="3" label="b.png">)" +
          transform +
          R"(</camera></group><camera id="2" sensor_id="3" label="c"/></cameras><transform>)"
          R"(<rotation>0 -1 0 1 0 0 0 0 1</rotation><translation>1 0 0</translation>)"
          R"(<scale>2</scale></transform><region><center>0 0 0</center><size>1 2 3</size>)"
          R"(<R>1 0 0 0 1 0 0 0 1</R></region></chunk></document>)");
  const Scene scene = load();
  ASSERT_THAT(scene.views, SizeIs(2));
  EXPECT_EQ(scene.format, SceneFormat::kMetashape);
  // 4 + 0.5 in pixels whose first centre is 0.5.
  for (const SourceView& view : scene.views) expect_camera(view, 4, 2);
  EXPECT_EQ(scene.views[0].distortion.model, DistortionModel::kPolynomial);
  EXPECT_THAT(scene.views[0].distortion.coefficients,
              ElementsAre(0.1, 0, 0.02, 0.01, 0, 0.4, 0, 0));
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("1 images have no pose")));
  EXPECT_NEAR(glm::distance(scene.box->min, glm::dvec3(-1, -1, -3)), 0, 1e-12);
  EXPECT_NEAR(glm::distance(scene.box->max, glm::dvec3(3, 1, 3)), 0, 1e-12);
}

TEST_F(ReadFormats, RealityCapture) {
  // Looking at the horizon is a pitch of 90 degrees, towards -x a heading of 270.
  put("cams.csv",
      "#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n"
      "a.png,5,0,0,270,90,0,450,2.25,-2.25,0.1,0.2,0.3,0,0.01,0.02\n"
      "b.png,5,0,0,-90,90,0,450,0,0,0,0,0,0,0,0\n");
  const Scene scene = load();
  expect_camera(scene.views[0], 4, 2);
  expect_camera(scene.views[1], 3.5, 2.5);
  EXPECT_THAT(scene.views[0].distortion.coefficients,
              ElementsAre(0.1, 0.2, 0.01, 0.02, 0.3, 0, 0, 0));
  put("cams.csv", "#name,x,y,alt,heading\na.png,1,2,3,4\n");
  EXPECT_THAT(error(), HasSubstr("pitch is missing"));
}

TEST_F(ReadFormats, Strecha) {
  for (const char* name : {"a.png", "b.png"})
    put(std::string(name) + ".camera",
        "100 0 4\n0 100 3\n0 0 1\n0 0 0\n0 0 -1\n1 0 0\n0 -1 0\n5 0 0\n8 6\n");
  expect_camera(load().views[0], 4, 3);
  put("b.png.camera", "100 0 4\n0 100 3\n0 0 1\n0.1 0 0\n0 0 -1\n1 0 0\n0 -1 0\n5 0 0\n8 6\n");
  EXPECT_THAT(error(), HasSubstr("0 0 0"));
}

/// K [R | t] with K = (100, 0, 4; 0, 100, 3; 0, 0, 1), times two.
constexpr const char* kMatrix = "-8 200 0 40\n-6 0 -200 30\n-2 0 0 10\n";

TEST_F(ReadFormats, PmvsContours) {
  for (const char* name : {"00000000", "00000001"}) {
    put_image(concat("visualize/", name, ".png"));
    put(concat("txt/", name, ".txt"), concat("CONTOUR\n", kMatrix));
  }
  const Scene scene = load();
  EXPECT_EQ(scene.format, SceneFormat::kPmvs);
  expect_camera(scene.views[1], 4, 3);
}

TEST_F(ReadFormats, MvsNet) {
  for (const char* name : {"a", "b"})
    put(concat("cams/", name, "_cam.txt"),
        "extrinsic\n0 1 0 0\n0 0 -1 0\n-1 0 0 5\n0 0 0 1\n\nintrinsic\n100 0 4\n0 100 3\n0 0 1\n\n"
        "425 2.5\n");
  expect_camera(load().views[0], 4, 3);
  put("cams/b_cam.txt", "extrinsic\n0 1 0 0\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("b_cam.txt"), HasSubstr("ends within extrinsic")));
}

TEST_F(ReadFormats, Mve) {
  for (const char* name : {"view_0000", "view_0001", "view_0002"}) {
    put_image(concat("views/", name, ".mve/undistorted.png"));
    const bool calibrated = name != std::string("view_0001");
    put(concat("views/", name, ".mve/meta.ini"),
        concat("# MVE view meta data\n[view]\nid = 0\n[camera]\nfocal_length = ",
               calibrated ? "12.5" : "0",
               "\nprincipal_point = 0.5 0.5\npixel_aspect = 1\nradial_distortion = 0.1 0\n"
               "rotation = 0 1 0 0 0 -1 -1 0 0\ntranslation = 0 0 5\n"));
  }
  const Scene scene = load();
  ASSERT_THAT(scene.views, SizeIs(2));
  expect_camera(scene.views[0], 3.5, 2.5);
  EXPECT_EQ(scene.views[0].distortion.model, DistortionModel::kNone);  // it is undistorted
  EXPECT_THAT(scene.warnings, ElementsAre(HasSubstr("1 views have no camera")));
}

TEST_F(ReadFormats, ProjectionFilesAndLists) {
  put("a.png.P", kMatrix);
  put("b.png.P", "16 -400 0 -80 12 0 400 -60 4 0 0 -20");  // any scale and sign
  expect_camera(load().views[0], 4, 3);
  expect_camera(load().views[1], 4, 3);
  put("projections.txt", concat("a.png -8 200 0 40 -6 0 -200 30 -2 0 0 10\nb.png 1 0 0 0 1 0 0 0 "
                                "0 0 1 0\n"));
  EXPECT_THAT(error(), AllOf(HasSubstr("line 2"), HasSubstr("singular")));
}

TEST_F(ReadFormats, ProjectionsKeepSkewAndUnlikeFocalLengths) {
  Camera camera = example_scene(folder_).views[1].camera;
  camera.intrinsics.skew = -1.5;
  camera.intrinsics.fy = 17;
  const std::array<double, 12> rows = projection_rows(camera, 0);
  const Camera back = camera_of_projection(rows, "here");
  EXPECT_NEAR(back.intrinsics.skew, -1.5, 1e-12);
  EXPECT_NEAR(back.intrinsics.fx, camera.intrinsics.fx, 1e-12);
  EXPECT_NEAR(back.intrinsics.fy, 17, 1e-12);
}

/// A variable of MATLAB's, its elements put together from the format's definition.
std::string mat_element(std::uint32_t type, const std::string& data) {
  const auto size = std::uint32_t(data.size());
  std::string bytes(8, '\0');
  std::memcpy(bytes.data(), &type, 4);
  std::memcpy(bytes.data() + 4, &size, 4);
  return bytes + data + std::string((8 - data.size() % 8) % 8, '\0');
}

TEST_F(ReadFormats, MatlabCompressedWithSmallElements) {
  const std::int32_t dimensions[3] = {3, 4, 2};
  const double columns[12] = {-8, -6, -2, 200, 0, 0, 0, -200, 0, 40, 30, 10};
  std::string values;
  for (int i = 0; i < 2; ++i) values.append(reinterpret_cast<const char*>(columns), 96);
  const std::string flags("\6\0\0\0\0\0\0\0", 8), small_name("\1\0\1\0P\0\0\0", 8);
  const std::string array =
      mat_element(6, flags) +
      mat_element(5, std::string(reinterpret_cast<const char*>(dimensions), 12)) + small_name +
      mat_element(9, values);
  const std::string plain = mat_element(14, array);
  std::string packed(compressBound(plain.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(plain.data()), plain.size());
  packed.resize(size);
  std::string tag(8, '\0');
  const std::uint32_t words[2] = {15, std::uint32_t(size)};
  std::memcpy(tag.data(), words, 8);
  const std::string header = std::string(124, ' ') + std::string("\0\1IM", 4);
  for (const std::string& variable : {plain, tag + packed}) {
    put("dino.mat", header + variable);
    const Scene scene = load();
    EXPECT_EQ(scene.views[1].name, "b.png");  // the folder's images in their order
    expect_camera(scene.views[1], 4, 3);
  }
  LoadSceneOptions matlab;
  matlab.pixel_center = 1;
  expect_camera(load_scene(folder_, matlab).views[0], 3, 2);
  put_image("c.png");
  EXPECT_THAT(error(), AllOf(HasSubstr("holds 2 matrices"), HasSubstr("3 images")));
}

TEST_F(ReadFormats, OpenCvListAndEasyMocap) {
  const std::string k =
      "!!opencv-matrix\n      rows: 3\n      cols: 3\n      dt: d\n"
      "      data: [ 100., 0., 4., 0., 100., 3., 0., 0., 1. ]\n";
  const std::string entry = "   camera_matrix: " + k +
                            "   distortion_coefficients: [ 0.1, 0.2, 0.01, 0.02, 0.3 ]\n"
                            "   R: [ 0, 1, 0, 0, 0, -1, -1, 0, 0 ]\n   t: [ 0, 0, 5 ]\n";
  put("cameras.yml", "%YAML:1.0\n---\ncameras:\n -\n   image: \"a.png\"\n" + entry +
                         " -\n   image: \"b.png\"\n" + entry);
  expect_camera(load().views[1], 4, 3);
  EXPECT_EQ(load().views[0].distortion.coefficients[4], 0.3);
  fs::remove(folder_ / "cameras.yml");
  // A third of a turn about (-1, -1, 1): Rodrigues' vector of the rotation.
  const char* angle = "1.2091995761561452";  // 2 pi / 3 / sqrt 3
  put("intri.yml", "%YAML:1.0\n---\nnames:\n  - \"a\"\n  - \"b\"\nK_a: " + k + "K_b: " + k);
  std::string poses = "%YAML:1.0\n---\n";
  for (const char* name : {"a", "b"})
    poses += concat("R_", name, ": [ ", angle, ", ", angle, ", -", angle, " ]\nT_", name,
                    ": [ 0, 0, 5 ]\n");
  put("extri.yml", poses);
  const Scene scene = load();
  expect_camera(scene.views[0], 4, 3);
}

// OpenCV's parser does not come to an end on some of these.
TEST_F(ReadFormats, OpenCvFilesAreOneMapWhoseKeysBeginTheirLines) {
  for (const char* content : {"{a: 1}\n-5 \n- 3\n", " a: 1\nxyz-5\n", " - 1\nabc- 5\n"}) {
    put("cameras.yml", concat("%YAML:1.0\n---\n# cameras\n\n", content));
    EXPECT_THAT(error(), AllOf(HasSubstr("cameras.yml line 5"), HasSubstr("must be a key")));
  }
  put("cameras.yml", "%YAML:1.0\n---\na: 1\n---\nb: 1\n");
  EXPECT_THAT(error(), AllOf(HasSubstr("line 4"), HasSubstr("one YAML document")));
}

}  // namespace
}  // namespace photohull::io
