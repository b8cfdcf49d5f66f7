#include "render/rasterizer.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"
#include "gpu/gl.h"
#include "render/photograph.h"
#include "shared/mesh_pages.h"

namespace photohull::render {
namespace {

constexpr int kSupersample = 2;  // samples along each side of a pixel
constexpr float kClayGrey = 0.45f;
constexpr int kPageLevels = 6;  // mip levels: coarser ones mix charts that lie side by side
const glm::dvec3 kSideLight(-0.66, -0.56, -0.5);  // towards it, camera axes; render_mesh.frag.glsl
constexpr double kLightDistance = 6;              // radii of the mesh's bounding sphere

/// Of the side light: soft to about two texels.
visibility::Technique shadows() {
  visibility::Technique out;
  out.name = "side light";
  out.resolution = 512;
  out.bias_texels = 2;
  out.virtual_samples = visibility::VirtualSamples::kNormal;
  out.filter = visibility::Filter::kPcf;
  out.filter_size = 2;
  return out;
}

/// Mean over kSupersample^2 samples in linear light.
RgbImage resolve(const std::vector<std::uint8_t>& rgba, int width, int height) {
  RgbImage out{width, height, std::vector<std::uint8_t>(std::size_t(width) * height * 3)};
  const std::size_t stride = std::size_t(width) * kSupersample * 4;
  std::uint8_t* target = out.rgb.data();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, target += 3) {
      const std::uint8_t* corner = &rgba[y * kSupersample * stride + x * kSupersample * 4];
      for (int c = 0; c < 3; ++c) {
        float sum = 0;
        for (int j = 0; j < kSupersample; ++j)
          for (int i = 0; i < kSupersample; ++i) sum += decode_srgb(corner[j * stride + i * 4 + c]);
        target[c] = encode_srgb(sum / float(kSupersample * kSupersample));
      }
    }
  return out;
}

/// Clip coordinates from positions relative to `origin`. Rows run downwards as in images, so that
/// pictures are read back the right way up and front faces turn clockwise.
glm::mat4 clip_from_mesh(const Camera& camera, const glm::dvec3& origin, const Window& window) {
  const glm::dmat4x3 p = camera.projection();
  const double slack = 1e-3 * window.far;
  const double near = std::max(window.near - slack, 0.5 * window.near), far = window.far + slack;
  glm::dmat4 out(0.0);
  for (int column = 0; column < 4; ++column) {
    const glm::dvec3 h = column < 3 ? p[column] : p * glm::dvec4(origin, 1);
    out[column] = {2 * (h.x - window.x * h.z) / window.width - h.z,
                   2 * (h.y - window.y * h.z) / window.height - h.z,
                   (far + near) / (far - near) * h.z, h.z};
  }
  out[3].z -= 2 * far * near / (far - near);
  return glm::mat4(out);
}

std::vector<std::array<std::uint8_t, 4>> encode_colours(const TriMesh& mesh) {
  std::vector<std::array<std::uint8_t, 4>> out;
  out.reserve(mesh.positions.size());
  const std::uint8_t clay = encode_srgb(kClayGrey);
  for (const glm::vec3& c : mesh.colours)
    out.push_back({encode_srgb(c.r), encode_srgb(c.g), encode_srgb(c.b), 255});
  out.resize(mesh.positions.size(), {clay, clay, clay, 255});
  return out;
}

/// A vertex for each corner: its places on the pages differ.
TriMesh unjoined(const TriMesh& mesh) {
  TriMesh out;
  out.origin = mesh.origin;
  for (const auto& triangle : mesh.triangles) {
    const auto first = std::uint32_t(out.positions.size());
    for (const std::uint32_t vertex : triangle) {
      out.positions.push_back(mesh.positions[vertex]);
      out.normals.push_back(mesh.normals[vertex]);
    }
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

/// Of each corner its place and its page.
std::vector<glm::vec3> places_on_pages(const MeshTexture& texture) {
  std::vector<glm::vec3> places;
  places.reserve(3 * texture.corners.size());
  for (std::size_t t = 0; t < texture.corners.size(); ++t)
    for (const glm::vec2& corner : texture.corners[t])
      places.emplace_back(corner, float(texture.page[t]));
  return places;
}

gpu::TextureArray to_device(const std::vector<RgbImage>& pages) {
  const int width = pages.front().width, height = pages.front().height;
  gpu::TextureArray out(gpu::TextureFormat::kSrgb8Alpha8, width, height, int(pages.size()),
                        kPageLevels);
  std::vector<std::uint8_t> rgba(std::size_t(width) * std::size_t(height) * 4, 255);
  for (std::size_t page = 0; page < pages.size(); ++page) {
    PHOTOHULL_CHECK(pages[page].width == width && pages[page].height == height);
    for (std::size_t i = 0; 4 * i < rgba.size(); ++i)
      std::copy_n(&pages[page].rgb[3 * i], 3, &rgba[4 * i]);
    out.upload(int(page), width, height, rgba.data());
  }
  out.generate_mipmaps();
  out.set_filter(true);
  return out;
}

}  // namespace

/// Colour (two attachments) and depth to draw into.
class Rasterizer::Target {
 public:
  Target(int width, int height, const Colour& background) : width_(width), height_(height) {
    glCreateFramebuffers(1, &framebuffer_);
    glCreateRenderbuffers(3, buffers_.data());
    for (int i = 0; i < 2; ++i) {
      glNamedRenderbufferStorage(buffers_[i], GL_RGBA8, width, height);
      glNamedFramebufferRenderbuffer(framebuffer_, GLenum(GL_COLOR_ATTACHMENT0 + i),
                                     GL_RENDERBUFFER, buffers_[i]);
    }
    glNamedRenderbufferStorage(buffers_[2], GL_DEPTH_COMPONENT32F, width, height);
    glNamedFramebufferRenderbuffer(framebuffer_, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers_[2]);
    const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glNamedFramebufferDrawBuffers(framebuffer_, 2, attachments);
    if (glCheckNamedFramebufferStatus(framebuffer_, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
      release();
      throw Error(concat("the device cannot draw a picture of ", width, "x", height, " pixels"));
    }
    const float clear[] = {float(background[0]) / 255.0f, float(background[1]) / 255.0f,
                           float(background[2]) / 255.0f, 1};
    const float farthest = 1;
    for (int i = 0; i < 2; ++i) glClearNamedFramebufferfv(framebuffer_, GL_COLOR, i, clear);
    glClearNamedFramebufferfv(framebuffer_, GL_DEPTH, 0, &farthest);
  }
  ~Target() { release(); }
  Target(const Target&) = delete;
  Target& operator=(const Target&) = delete;

  void bind() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, width_, height_);
  }

  std::vector<std::uint8_t> read(int attachment) const {
    std::vector<std::uint8_t> rgba(std::size_t(width_) * height_ * 4);
    glReadBuffer(GLenum(GL_COLOR_ATTACHMENT0 + attachment));
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    gpu::count_download(rgba.size());
    return rgba;
  }

 private:
  void release() {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteRenderbuffers(3, buffers_.data());
  }
  int width_, height_;
  unsigned framebuffer_ = 0;
  std::array<unsigned, 3> buffers_{};
};

Rasterizer::Rasterizer(gpu::Context& context, const TriMesh& mesh)
    : Rasterizer(context, mesh, gpu::Buffer::of(encode_colours(mesh)), 4) {}

Rasterizer::Rasterizer(gpu::Context& context, const TexturedMesh& textured)
    : Rasterizer(context, unjoined(textured.mesh),
                 gpu::Buffer::of(places_on_pages(textured.texture)), 3) {
  pages_ = to_device(textured.texture.pages);
}

Rasterizer::Rasterizer(gpu::Context& context, const TriMesh& mesh, gpu::Buffer colours,
                       int components)
    : context_(context),
      geometry_(visibility::Geometry::of_mesh(mesh)),
      normals_(gpu::Buffer::of(mesh.normals)),
      colours_(std::move(colours)),
      program_(gpu::Program::raster(context, "render_mesh.vert.glsl", "render_mesh.frag.glsl",
                                    visibility::technique_defines(shadows()) +
                                        (components == 3 ? "#define TEXTURED\n" : ""))) {
  const bool bytes = components == 4;
  glCreateVertexArrays(1, &vertex_array_);
  glVertexArrayVertexBuffer(vertex_array_, 0, geometry_.positions().id(), 0, sizeof(glm::vec3));
  glVertexArrayVertexBuffer(vertex_array_, 1, normals_.id(), 0, sizeof(glm::vec3));
  glVertexArrayVertexBuffer(vertex_array_, 2, colours_.id(), 0, bytes ? 4 : sizeof(glm::vec3));
  glVertexArrayAttribFormat(vertex_array_, 0, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(vertex_array_, 1, 3, GL_FLOAT, GL_FALSE, 0);
  glVertexArrayAttribFormat(vertex_array_, 2, components, bytes ? GL_UNSIGNED_BYTE : GL_FLOAT,
                            bytes, 0);
  for (unsigned i = 0; i < 3; ++i) {
    glVertexArrayAttribBinding(vertex_array_, i, i);
    glEnableVertexArrayAttrib(vertex_array_, i);
  }
  glVertexArrayElementBuffer(vertex_array_, geometry_.indices().id());
}

Rasterizer::~Rasterizer() { glDeleteVertexArrays(1, &vertex_array_); }

visibility::VisibilityMap Rasterizer::side_light(const Camera& camera) const {
  const double radius =
      std::max(0.5 * glm::length(geometry_.bounds().max - geometry_.bounds().min), 1e-9);
  const int texels = shadows().resolution;
  Camera light;
  light.intrinsics.width = light.intrinsics.height = texels;
  light.intrinsics.fx = light.intrinsics.fy =
      0.48 * texels * std::sqrt(kLightDistance * kLightDistance - 1);
  light.intrinsics.cx = light.intrinsics.cy = 0.5 * (texels - 1);
  const glm::dmat3 world_from_camera = glm::transpose(camera.cam_from_world.rotation);
  const glm::dvec3 towards = world_from_camera * glm::normalize(kSideLight);
  const glm::dvec3 x = glm::normalize(glm::cross(world_from_camera[1], -towards));
  light.cam_from_world.rotation = glm::transpose(glm::dmat3(x, glm::cross(-towards, x), -towards));
  light.cam_from_world.translation =
      -(light.cam_from_world.rotation *
        (geometry_.bounds().center() + kLightDistance * radius * towards));
  return visibility::render_map(context_, light, geometry_, shadows());
}

void Rasterizer::draw_into(const Target& target, const Camera& camera, const Window& window) {
  const visibility::VisibilityMap light = side_light(camera);
  target.bind();
  program_->set("clip_from_mesh", clip_from_mesh(camera, geometry_.origin(), window));
  program_->set("camera_from_mesh", glm::mat4(glm::dmat4(camera.cam_from_world.rotation)));
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_CULL_FACE);
  glFrontFace(GL_CW);
  program_->use();
  light.bind();
  if (pages_.id()) pages_.bind(shaders::kMeshPagesUnit);
  glBindVertexArray(vertex_array_);
  {
    gpu::Launch launch(context_, "render_mesh");
    glDrawElements(GL_TRIANGLES, GLsizei(3 * geometry_.triangles()), GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
  context_.check_errors("render_mesh");
}

Rendering Rasterizer::draw(const Camera& camera, const Window& window, int width, int height) {
  const Target target(width * kSupersample, height * kSupersample,
                      {kBackground, kBackground, kBackground});
  draw_into(target, camera, window);
  return {resolve(target.read(0), width, height), resolve(target.read(1), width, height)};
}

RgbImage Rasterizer::draw(const Camera& camera, const Window& window, int width, int height,
                          Look look, const Colour& background) {
  const Target target(width * kSupersample, height * kSupersample, background);
  draw_into(target, camera, window);
  return resolve(target.read(look == Look::kClay ? 1 : 0), width, height);
}

}  // namespace photohull::render
