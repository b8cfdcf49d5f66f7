// A script that stands in the place of COLMAP.
#pragma once

#include <filesystem>
#include <string>

#include "child_process.h"
#include "core/atomic_file.h"

namespace photohull::test {

/// The script lies in `folder`; `body` sees the command as $1.
inline RunOptions with_colmap(const std::filesystem::path& folder, const std::string& body) {
  const std::filesystem::path program = folder / "bin/colmap";
  std::filesystem::create_directories(program.parent_path());
  write_atomically(program, "#!/bin/sh\n[ \"$2\" = --help ] && exit 0\n" + body + "\n");
  std::filesystem::permissions(program, std::filesystem::perms::owner_all);
  RunOptions options;
  options.environment = {"PATH=" + program.parent_path().string() + ":/usr/bin:/bin"};
  return options;
}

}  // namespace photohull::test
