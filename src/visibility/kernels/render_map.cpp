// Based on: L. Williams, "Casting curved shadows on curved surfaces", SIGGRAPH 1978; depth peeling
// after C. Everitt, "Interactive order-independent transparency", 2001.
#include <algorithm>
#include <limits>

#include "core/error.h"
#include "gpu/gl.h"
#include "visibility/kernels/detail.h"
#include "visibility/kernels/visibility_map.h"

namespace photohull::visibility {
namespace {

using gpu::TextureArray;
using gpu::TextureFormat;

constexpr float kEmpty = std::numeric_limits<float>::infinity();

/// Vertices of the geometry for the raster stages.
class VertexArray {
 public:
  explicit VertexArray(const Geometry& geometry) {
    glCreateVertexArrays(1, &id_);
    glVertexArrayVertexBuffer(id_, 0, geometry.positions().id(), 0, 12);
    glVertexArrayAttribFormat(id_, 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(id_, 0, 0);
    glEnableVertexArrayAttrib(id_, 0);
    glVertexArrayElementBuffer(id_, geometry.indices().id());
    glBindVertexArray(id_);
  }
  ~VertexArray() {
    glBindVertexArray(0);
    glDeleteVertexArrays(1, &id_);
  }
  VertexArray(const VertexArray&) = delete;
  VertexArray& operator=(const VertexArray&) = delete;

 private:
  unsigned id_ = 0;
};

/// A depth buffer for the test, and textures to draw into; greater depth is nearer while it lives.
class Target {
 public:
  explicit Target(const glm::ivec2& size) {
    glCreateFramebuffers(1, &framebuffer_);
    glCreateRenderbuffers(1, &depth_);
    glNamedRenderbufferStorage(depth_, GL_DEPTH_COMPONENT32F, size.x, size.y);
    glNamedFramebufferRenderbuffer(framebuffer_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, size.x, size.y);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDepthFunc(GL_GREATER);
    glEnable(GL_DEPTH_TEST);
  }
  ~Target() {
    glDisable(GL_DEPTH_TEST);
    glDepthFunc(GL_LESS);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteRenderbuffers(1, &depth_);
  }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  /// Clears a layer of the textures and draws into it.
  void attach(int layer, const TextureArray& depths, const TextureArray* ids) {
    glNamedFramebufferTextureLayer(framebuffer_, GL_COLOR_ATTACHMENT0, depths.id(), 0, layer);
    if (ids)
      glNamedFramebufferTextureLayer(framebuffer_, GL_COLOR_ATTACHMENT1, ids->id(), 0, layer);
    else
      glNamedFramebufferTexture(framebuffer_, GL_COLOR_ATTACHMENT1, 0, 0);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(framebuffer_, ids ? 2 : 1, both);
    if (glCheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw Error(concat("the device cannot draw a visibility map of ", depths.width(), "x",
                         depths.height(), " texels"));
    const float empty[] = {kEmpty, 0, 0, 0}, farthest = 0;
    const std::uint32_t nothing[] = {shaders::kNoTriangle, 0, 0, 0};
    glClearNamedFramebufferfv(framebuffer_, GL_COLOR, 0, empty);
    if (ids) glClearNamedFramebufferuiv(framebuffer_, GL_COLOR, 1, nothing);
    glClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, &farthest);
  }

 private:
  unsigned framebuffer_ = 0, depth_ = 0;
};

}  // namespace

class MapRenderer {
 public:
  MapRenderer(gpu::Context& context, const Camera& viewpoint, const Geometry& geometry,
              const Technique& technique, const std::optional<Camera>& eye)
      : context_(context), viewpoint_(viewpoint), geometry_(geometry) {
    if (technique.march && !geometry.is_volume())
      throw UsageError("march: only volumes have bricks to march through");
    map_.technique_ = technique;
    map_.layout_ = lay_out(viewpoint, geometry.bounds(), geometry.origin(), technique, eye);
    map_.origin_ = geometry.origin();
    const glm::ivec2 size = map_.layout_.size;
    if (std::max(size.x, size.y) > context.limits().texture_size)
      throw Error(concat("this device has no textures of ", size.x, "x", size.y,
                         " texels; lower the resolution"));
    const shaders::MapInfo info = to_info(map_.layout_, technique, geometry.triangles());
    map_.info_.write(0, sizeof info, &info);
    map_.test_ = gpu::Program::compute(context, "visibility_test_receivers.comp.glsl",
                                       technique_defines(technique));
  }

  VisibilityMap run() {
    const Technique& t = map_.technique_;
    map_.info_.bind_uniform(shaders::kMapInfoBinding);
    if (t.detail != Detail::kNone) {
      draw_detail(context_, geometry_, map_);
      return std::move(map_);
    }
    map_.first_ = layers(TextureFormat::kR32f);
    if (t.needs_ids() || t.march) map_.ids_ = layers(TextureFormat::kR32ui);
    if (t.march)
      march();
    else
      draw(map_.first_, false);
    if (t.needs_second_depth()) {
      map_.second_ = layers(TextureFormat::kR32f);
      draw(map_.second_, true);
    }
    if (t.filter == Filter::kVariance) blur();
    return std::move(map_);
  }

 private:
  TextureArray layers(TextureFormat format) const {
    const glm::ivec2 size = map_.layout_.size;
    return {format, size.x, size.y, int(map_.layout_.parts.size())};
  }

  void draw(const TextureArray& depths, bool second) {
    const bool ids = map_.ids_.id() && !second;
    std::string defines = second ? "#define DRAW_SECOND\n" : "";
    if (ids) defines += geometry_.is_volume() ? "#define DRAW_BRICKS\n" : "#define DRAW_IDS\n";
    if (map_.technique_.bias == Bias::kSlope) defines += "#define DRAW_SLOPE\n";
    const auto program = gpu::Program::raster(context_, "visibility_draw_mesh.vert.glsl",
                                              "visibility_draw_mesh.frag.glsl", defines);
    const VertexArray vertices(geometry_);
    Target target(map_.layout_.size);
    if (second) map_.first_.bind(shaders::kFirstDepthUnit);
    if (geometry_.is_volume()) geometry_.face_bricks().bind_storage(shaders::kFaceBricksBinding);
    program->use();
    const bool anything = map_.layout_.far > map_.layout_.near;
    for (int part = 0; part < int(map_.layout_.parts.size()); ++part) {
      gpu::Launch launch(context_, "visibility_draw_mesh");
      target.attach(part, depths, ids ? &map_.ids_ : nullptr);
      program->set("part", part);
      if (anything)
        glDrawElements(GL_TRIANGLES, GLsizei(geometry_.triangles() * 3), GL_UNSIGNED_INT, nullptr);
    }
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    context_.check_errors("visibility_draw_mesh");
  }

  void march() {
    const auto program = gpu::Program::compute(context_, "visibility_march_bricks.comp.glsl");
    const GridSpec& grid = geometry_.grid();
    // Voxel coordinates with the corner of voxel (0, 0, 0) at 0.
    const auto to_voxels = [&](const glm::dvec3& p) {
      return (p - grid.origin) / grid.voxel_size + 0.5;
    };
    const double per_pixel = double(map_.layout_.size.x) / viewpoint_.intrinsics.width;
    const glm::dmat3 back =
        glm::inverse(viewpoint_.intrinsics.k() * viewpoint_.cam_from_world.rotation);
    const auto ray = [&](const glm::dvec3& pixel) {
      return glm::vec3(back * pixel / grid.voxel_size);
    };
    program->set("bricks", grid.bricks);
    program->set("viewpoint", glm::vec3(to_voxels(viewpoint_.center())));
    program->set("ray_x", ray({1 / per_pixel, 0, 0}));
    program->set("ray_y", ray({0, 1 / per_pixel, 0}));
    program->set("ray_1", ray({-0.5, -0.5, 1}));
    geometry_.table().bind_storage(shaders::kMarchTableBinding);
    geometry_.words().bind_storage(shaders::kMarchOccupancyBinding);
    map_.first_.bind_image(shaders::kMarchDepthsUnit, 0, true);
    map_.ids_.bind_image(shaders::kMarchIdsUnit, 0, true);
    program->dispatch(context_, "visibility_march_bricks",
                      gpu::group_count(std::size_t(map_.layout_.size.x), 8),
                      gpu::group_count(std::size_t(map_.layout_.size.y), 8));
  }

  void blur() {
    const std::string size = concat("#define FILTER_SIZE ", map_.technique_.filter_size, "\n");
    TextureArray rows = layers(TextureFormat::kRg32f);
    map_.moments_ = layers(TextureFormat::kRg32f);
    blur_along({1, 0}, "#define FROM_DEPTHS\n" + size, map_.first_, rows);
    blur_along({0, 1}, size, rows, map_.moments_);
    map_.first_ = {};
  }

  void blur_along(const glm::ivec2& direction, const std::string& defines,
                  const TextureArray& source, const TextureArray& result) {
    const auto program =
        gpu::Program::compute(context_, "visibility_blur_moments.comp.glsl", defines);
    program->set("direction", direction);
    source.bind(shaders::kBlurSourceUnit);
    result.bind_image(shaders::kBlurMomentsUnit, 0, true);
    program->dispatch(
        context_, "visibility_blur_moments", gpu::group_count(std::size_t(map_.layout_.size.x), 8),
        gpu::group_count(std::size_t(map_.layout_.size.y), 8), map_.layout_.parts.size());
  }

  gpu::Context& context_;
  const Camera& viewpoint_;
  const Geometry& geometry_;
  VisibilityMap map_;
};

VisibilityMap render_map(gpu::Context& context, const Camera& viewpoint, const Geometry& geometry,
                         const Technique& technique, const std::optional<Camera>& eye) {
  technique.validate();
  return MapRenderer(context, viewpoint, geometry, technique, eye).run();
}

}  // namespace photohull::visibility
