// Compiled shader programs.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace photohull::gpu {

class Context;

/// A move-only linked program made of embedded shaders.
class Program {
 public:
  /// A compute program from one entry point; `defines` are lines of "#define A B\n". Made at the
  /// first call and kept by the context: drivers compile again for every program that is made anew.
  /// Who dispatches it sets all its uniforms, for others use it, too. Throws Error with the
  /// compiler's log, its file numbers replaced by names.
  static std::shared_ptr<const Program> compute(Context& context, std::string_view path,
                                                std::string_view defines = {});
  static std::shared_ptr<const Program> raster(Context& context, std::string_view vertex_path,
                                               std::string_view fragment_path,
                                               std::string_view defines = {});
  Program(Program&& other) noexcept { swap(other); }
  Program& operator=(Program&& other) noexcept {
    swap(other);
    return *this;
  }
  ~Program();

  unsigned id() const { return id_; }
  void use() const;
  /// Sets a uniform of the program; CHECKs that it exists.
  void set(const char* name, int value) const;
  void set(const char* name, unsigned value) const;
  void set(const char* name, float value) const;
  void set(const char* name, const glm::ivec2& value) const;
  void set(const char* name, const glm::ivec3& value) const;
  void set(const char* name, const glm::ivec4& value) const;
  void set(const char* name, const glm::vec2& value) const;
  void set(const char* name, const glm::vec3& value) const;
  void set(const char* name, const glm::vec4& value) const;
  void set(const char* name, const glm::mat4& value) const;

  /// Runs `groups` work groups under `name` (see Launch) and waits for their writes to be visible;
  /// in parts where the device launches fewer at once (include/dispatch.glsl).
  void dispatch(Context& context, const char* name, std::size_t groups_x, std::size_t groups_y = 1,
                std::size_t groups_z = 1) const;

 private:
  void swap(Program& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(first_group_, other.first_group_);
  }
  explicit Program(unsigned id);
  int location(const char* name) const;
  unsigned id_ = 0;
  int first_group_ = -1;  ///< uniform; -1 in programs that launch one group
};

/// Work groups of `size` that cover `count` items.
inline std::size_t group_count(std::size_t count, std::size_t size) {
  return (count + size - 1) / size;
}

}  // namespace photohull::gpu
