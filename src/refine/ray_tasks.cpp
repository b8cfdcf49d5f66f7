#include "refine/ray_tasks.h"

#include <cstdint>
#include <system_error>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/read_file.h"

namespace photohull::refine {
namespace {

namespace fs = std::filesystem;

struct SentLattice {
  double stride = 1;
  int width = 0, height = 0;
  glm::dvec2 shift{0};
};

RayMap read_map(const std::string& bytes) {
  ListReader reader(bytes);
  RayMap out;
  const auto lattice = reader.one<SentLattice>();
  out.stride = lattice.stride, out.width = lattice.width, out.height = lattice.height;
  out.shift = lattice.shift;
  out.depth = reader.list<float>();
  out.weight = reader.list<float>();
  out.before = reader.list<glm::vec3>();
  out.through = reader.list<glm::vec3>();
  const std::size_t rays = std::size_t(out.width) * std::size_t(out.height);
  if (out.depth.size() != rays || out.weight.size() != rays)
    throw Error("a result is of other rays");
  return out;
}

void write_ray_space(const fs::path& file, const RaySearched& space) {
  AtomicFile out(file);
  ListWriter writer([&](const void* data, std::size_t size) { out.write(data, size); });
  writer.one(space.options);
  writer.one(std::uint8_t(space.surface != nullptr));
  write_volume(space.hull, writer);
  if (space.surface) write_volume(*space.surface, writer);
  out.commit();
}

}  // namespace

RaySpace read_ray_space(const fs::path& file) {
  const std::string bytes = read_whole_file(file);
  ListReader reader(bytes);
  RaySpace out;
  out.options = reader.one<VoteOptions>();
  const bool known = reader.one<std::uint8_t>() != 0;
  out.hull = read_volume(reader);
  if (known) out.surface = read_volume(reader);
  return out;
}

std::vector<RayMap> map_in_tasks(SharedWork& shared, const std::string& device,
                                 const RaySearched& space, std::size_t views,
                                 const ViewMapper& map_of) {
  const std::string name = shared.next_name("rays");
  const fs::path file = shared.folder() / (name + ".space");
  std::vector<RayMap> maps(views);
  try {
    write_ray_space(file, space);
  } catch (const Error& problem) {
    shared.close(problem);
    for (std::size_t view = 0; view < views; ++view) maps[view] = map_of(view);
    return maps;
  }
  shared.do_all(
      {name, views,
       [&](std::size_t view) {
         std::string task;
         ListWriter writer(task);
         TaskHead{shared.job(), device, TaskKind::kRays, 0}.write(writer);
         writer.text(file.filename().string());
         writer.one(view);
         return task;
       },
       [&](std::size_t view, const std::string& result) { maps[view] = read_map(result); }},
      [&](const std::string& task) {
        ListReader reader(task);
        TaskHead::read(reader);
        return bytes_of(map_of(read_ray_task(reader).view));
      });
  std::error_code ignored;
  fs::remove(file, ignored);
  return maps;
}

RayTask read_ray_task(ListReader& task) {
  RayTask out;
  out.space = task.text();
  out.view = task.one<std::size_t>();
  return out;
}

std::string bytes_of(const RayMap& map) {
  std::string out;
  ListWriter writer(out);
  writer.one(SentLattice{map.stride, map.width, map.height, map.shift});
  writer.list(map.depth);
  writer.list(map.weight);
  writer.list(map.before);
  writer.list(map.through);
  return out;
}

}  // namespace photohull::refine
