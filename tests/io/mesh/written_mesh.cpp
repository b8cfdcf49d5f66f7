#include "written_mesh.h"

#include <deque>
#include <fstream>
#include <sstream>

namespace photohull {

std::filesystem::path write(const ScratchFolder& folder, const std::string& format,
                            const MeshContents& contents) {
  const std::filesystem::path path = folder / ("mesh." + format);
  std::deque<AtomicFile> beside;
  AtomicFile file(path);
  find_mesh_writer("format", format)
      .write(file, contents, [&](const std::string& name) -> AtomicFile& {
        return beside.emplace_back(folder / name);
      });
  file.commit();
  for (AtomicFile& f : beside) f.commit();
  return path;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace photohull
