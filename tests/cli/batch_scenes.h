// A batch of the sphere, in many sizes.
#pragma once

#include <map>
#include <string>

#include "child_process.h"
#include "core/error.h"
#include "sphere_scene.h"

namespace photohull::test {

class BatchScenes : public SphereScene {
 protected:
  /// The sphere as many scenes, which differ in their voxels.
  std::string list_of(int count) const {
    std::string list;
    for (int i = 0; i < count; ++i)
      list += concat("\"", scene(), "\" --name s", i, " --resolution ", 20 + 2 * i, "\n");
    return list;
  }
  Arguments batch(const std::string& list, const std::string& to,
                  const Arguments& more = {}) const {
    return command("batch", list, to, more);
  }
  /// `batch` or `plan`.
  Arguments command(const std::string& name, const std::string& list, const std::string& to,
                    const Arguments& more = {}) const {
    write_bytes(folder_ / "list.txt", list);
    Arguments all = {name,      "--list",        path("list.txt"), "--out", path(to),
                     "--masks", path("cutouts"), "--method",       "hull",  "--report-page",
                     "off"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::string table(const std::string& out) const {
    return read_bytes(folder_ / out / "batch.csv");
  }
  /// Every file of the pieces but reports, which tell the time.
  std::map<std::string, std::string> results(const std::string& out, int count) const {
    std::map<std::string, std::string> files;
    for (int i = 0; i < count; ++i)
      for (const char* name : {"volume.vdb", "mesh.ply", "preview.png"}) {
        const std::string file = concat("s", i, "/", name);
        files[file] = read_bytes(folder_ / out / file);
      }
    return files;
  }
};

}  // namespace photohull::test
