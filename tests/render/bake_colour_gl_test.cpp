#include "render/bake_colour.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/meshes.h"
#include "render/surface_points.h"
#include "support/gl_context.h"
#include "support/ray_cast.h"

namespace photohull {
namespace {

using render::reference::BakeView;

constexpr double kNoise = 0.01;
const GridSpec kGrid{{3, -2, 7}, 0.05, {6, 6, 6}};

std::vector<Camera> cameras_of(std::span<const PreparedView> views) {
  return projtex::cameras_of(views);
}

PreparedView plain_view(const Camera& camera, const glm::dvec3& colour) {
  PreparedView view;
  view.camera = camera;
  view.image = test::ray_cast(
      camera, [&](const glm::dvec3&, const glm::dvec3&) { return colour; }, 1);
  return view;
}

BakeReport bake(const std::vector<PreparedView>& views, TriMesh& mesh) {
  Progress silent;
  gpu::Context& context = test::gl_context();  // before the images need it
  const projtex::ImageSet images(views);
  const std::vector<Camera> cameras = cameras_of(views);
  return bake_colour(context, kGrid, {images, cameras, kNoise}, render::Shaping::kPhotographs, mesh,
                     silent);
}

/// The reference's depth maps of a mesh that consists of vertices only.
std::vector<BakeView> reference_views(const std::vector<PreparedView>& views,
                                      const std::vector<render::SurfacePoint>& vertices) {
  const std::vector<Camera> cameras = cameras_of(views);
  const visibility::DepthMaps maps = render::occluder_maps(cameras, kGrid);
  std::vector<BakeView> out;
  for (std::size_t i = 0; i < views.size(); ++i) {
    BakeView view{projtex::to_grid(cameras[i], kGrid),
                  maps.infos()[i],
                  {},
                  &views[i].image,
                  std::min(views[i].sharpness / 0.9, 1.0)};
    view.depths.assign(std::size_t(view.depth_info.size.x) * view.depth_info.size.y, 1e30);
    for (const auto& v : vertices)
      render::reference::splat_point(glm::dvec3(v.position), glm::dvec3(v.normal), view);
    out.push_back(std::move(view));
  }
  return out;
}

/// Points strewn over the grid, a tenth of them without a normal; what hides what is chance.
TriMesh random_points(test::Rng& rng, int count) {
  TriMesh mesh;
  mesh.origin = kGrid.bounds().center();
  const Box box{kGrid.bounds().min - mesh.origin, kGrid.bounds().max - mesh.origin};
  for (int i = 0; i < count; ++i) {
    mesh.positions.emplace_back(test::uniform_in(rng, box));
    mesh.normals.emplace_back(i % 10 ? test::random_direction(rng) : glm::dvec3(0));
  }
  return mesh;
}

/// Random cameras, the last of them amid the points: most lie behind it or off its image.
std::vector<PreparedView> random_views(test::Rng& rng, int count) {
  std::vector<PreparedView> views;
  for (int i = 0; i < count; ++i) {
    PreparedView view;
    const Box box = kGrid.bounds();
    view.camera = i + 1 < count ? test::random_camera(rng, box, 96, 64)
                                : test::look_at(box.center(), box.max, 60, 96, 64);
    view.image = test::random_image(rng, 96, 64);
    for (std::size_t p = 3; p < view.image.bytes.size() / 4; p += 4) view.image.bytes[p] = 0;
    views.push_back(std::move(view));
  }
  return views;
}

class BakeAgainstReference : public ::testing::TestWithParam<int> {};

TEST_P(BakeAgainstReference, AgreesOnRandomPoints) {
  test::Rng rng(GetParam());
  std::vector<PreparedView> views = random_views(rng, GetParam());
  TriMesh mesh = random_points(rng, 4000);
  for (PreparedView& view : views)
    if (std::uniform_int_distribution(0, 1)(rng))
      view.sharpness = std::uniform_real_distribution(0.5, 1.3)(rng);
  const auto vertices = render::to_voxels(kGrid, mesh);
  const auto baked = bake(views, mesh).evidence;  // of single points: nothing to pool
  const std::vector<BakeView> expected = reference_views(views, vertices);
  int seen = 0, wrong = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto e = render::reference::bake_vertex(
        expected, kNoise, glm::dvec3(vertices[i].position), glm::dvec3(vertices[i].normal));
    if (i % 10 == 0) {
      EXPECT_EQ(mesh.confidence[i], 0) << "a vertex without a normal";
    }
    TriMesh point;
    point.positions.resize(1);
    const auto pooled = render::pool_evidence(point, {&e.evidence, 1})[0];
    seen += pooled.seen;
    bool close = pooled.seen == baked[i].seen && pooled.seen == (mesh.confidence[i] > 0);
    if (pooled.seen)
      close = close && glm::distance(e.colour, glm::dvec3(mesh.colours[i])) < 0.02 &&
              std::abs(pooled.scatter - baked[i].scatter) < 1e-3 &&
              std::abs(pooled.disagreement - baked[i].disagreement) < 0.01 &&
              std::abs(pooled.fine_share - baked[i].fine_share) < 0.02;
    wrong += !close;
  }
  // A point on the border of a texel, of an image or between two levels may fall either way.
  EXPECT_LE(wrong, 30);
  EXPECT_GT(seen, 500);
}

INSTANTIATE_TEST_SUITE_P(Views, BakeAgainstReference, ::testing::Values(2, 3, 6, 13, 40));

TEST(BakeColour, VertexBehindTheOnlyCameraIsUnseen) {
  const glm::dvec3 eye = kGrid.world({24, 24, 24});
  const auto camera = test::look_at(eye, eye + glm::dvec3(0, 0, 1), 100, 64, 64, {0, 1, 0});
  TriMesh mesh;
  mesh.origin = eye;
  mesh.positions = {{0, 0, -0.5}, {0, 0, 0}, {0, 0, 0.5}};
  mesh.normals.assign(3, {0, 0, -1});
  mesh.normals[0] = {0, 0, 1};
  const BakeReport report = bake({plain_view(camera, {0.2, 0.4, 0.6})}, mesh);
  EXPECT_EQ(mesh.confidence[0], 0);
  EXPECT_EQ(mesh.confidence[1], 0) << "at the optical centre";
  EXPECT_GT(mesh.confidence[2], 0);
  EXPECT_EQ(report.seen, 1);
  // The others take the mean of the seen.
  EXPECT_NEAR(mesh.colours[0].g, 0.4, 0.01);
}

TEST(BakeColour, HiddenVertexGetsNothingFromTheCameraThatCannotSeeIt) {
  const double voxel = kGrid.voxel_size;
  TriMesh mesh;
  mesh.origin = kGrid.world({24, 24, 0});
  test::add_plate(0, 0, 30 * voxel, 12 * voxel, voxel, mesh);
  const std::size_t back = mesh.positions.size();
  test::add_plate(0, 0, 20 * voxel, 6 * voxel, voxel, mesh);
  const glm::dvec3 target = kGrid.world({24, 24, 30});
  const Camera ahead =
      test::look_at(target - glm::dvec3(0, 0, 6), target, 300, 128, 128, {0, 1, 0});
  const Camera aside =
      test::look_at(target - glm::dvec3(6, 0, 5), target, 300, 128, 128, {0, 1, 0});
  const PreparedView red = plain_view(ahead, {0.8, 0.1, 0.1}),
                     green = plain_view(aside, {0.1, 0.8, 0.1});
  TriMesh lone = mesh;
  bake({red, green}, mesh);
  bake({red}, lone);
  int hidden = 0;
  for (std::size_t i = 0; i < back; ++i) {
    const glm::vec2 at = glm::abs(glm::vec2(mesh.positions[i])) / float(voxel);
    if (std::max(at.x, at.y) > 4) continue;
    EXPECT_EQ(lone.confidence[i], 0);
    // From aside, too, the front plate hides some of the back plate.
    if (mesh.confidence[i] == 0) continue;
    ++hidden;
    EXPECT_NEAR(mesh.colours[i].r, 0.1, 0.01);
    EXPECT_NEAR(mesh.colours[i].g, 0.8, 0.01);
  }
  EXPECT_GT(hidden, 20);
  EXPECT_GT(lone.confidence[0], 0) << "a corner of the back plate is in plain sight";
}

TEST(BakeColour, LargeTrianglesHideWhatIsBehindThem) {
  const double voxel = kGrid.voxel_size;
  TriMesh mesh;
  mesh.origin = kGrid.world({24, 24, 0});
  test::add_plate(0, 0, 20 * voxel, 18 * voxel, 36 * voxel, mesh);
  const std::size_t back = mesh.positions.size();
  test::add_plate(0, 0, 30 * voxel, 8 * voxel, voxel, mesh);
  const glm::dvec3 target = kGrid.world({24, 24, 30});
  const Camera ahead =
      test::look_at(target - glm::dvec3(0, 0, 6), target, 300, 128, 128, {0, 1, 0});
  bake({plain_view(ahead, {0.8, 0.1, 0.1})}, mesh);
  EXPECT_EQ(std::count(mesh.confidence.begin() + long(back), mesh.confidence.end(), 0.0f),
            long(mesh.confidence.size() - back));
}

TEST(BakeColour, BlurredViewsSayLess) {
  const double voxel = kGrid.voxel_size;
  TriMesh mesh;
  mesh.origin = kGrid.world({24, 24, 24});
  test::add_plate(0, 0, 0, 10 * voxel, voxel, mesh);
  const glm::dvec3 target = mesh.origin;
  const auto from = [&](double x) {
    return test::look_at(target - glm::dvec3(x, 0, 6), target, 300, 128, 128, {0, 1, 0});
  };
  std::vector<PreparedView> views = {plain_view(from(-1), {0.3, 0.3, 0.3}),
                                     plain_view(from(1), {0.33, 0.3, 0.3})};
  const auto red = [&] {
    TriMesh copy = mesh;
    bake(views, copy);
    return copy.colours[copy.colours.size() / 2].r;
  };
  const float even = red();
  views[1].sharpness = 0.5;
  const float first = red();
  views[0].sharpness = 0.5;
  EXPECT_LT(first, even);
  EXPECT_NEAR(red(), even, 1e-4);
}

TEST(BakeColour, EmptyMesh) {
  const Camera camera = test::look_at({0, 0, 0}, kGrid.bounds().center(), 100, 32, 32);
  TriMesh mesh;
  const BakeReport report = bake({plain_view(camera, {0.5, 0.5, 0.5})}, mesh);
  EXPECT_TRUE(mesh.colours.empty());
  EXPECT_EQ(report.vertices, 0);
}

}  // namespace
}  // namespace photohull
