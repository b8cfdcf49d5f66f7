// The program run while calls of a kind fail.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cli/sphere_scene.h"

namespace photohull::test {

/// Which calls fail, and how; see fault_shim.cpp.
struct Fault {
  std::string call;      ///< open, read, write, rename, unlink, sync, mkdir, gl or reset
  long what = 0;         ///< an error number, or what fault_shim.cpp knows beside them
  std::string folder;    ///< of the files; all, for gl and reset
  bool lasting = false;  ///< all calls from the first on, as on a full disk
};

/// Files by name below a folder, with their bytes.
using Files = std::map<std::string, std::string>;
Files contents(const std::string& folder);

/// A job without faults.
struct Reference {
  Files files;     ///< that it makes in out()
  long calls = 0;  ///< of the fault's kind
};

class FaultScene : public SphereScene {
 protected:
  /// Runs the job to its end and removes out(). Expects some calls of the fault's kind.
  Reference run_without(const Arguments& job, const Fault& fault) const;

  /// Runs the job while call `number` fails, and where the fault lasts those after it.
  Finished run_with(const Arguments& job, const Fault& fault, long number) const;

  /// Kills the job at that call for a file in out().
  void kill_at(const Arguments& job, const std::string& call, long number) const;

  /// Runs the job once for each of some places of the fault, evenly among all, and expects that it
  /// ends with the whole right output or fails with a sentence that names a file of the fault's
  /// folder, leaving no half file.
  void expect_no_harm(const Arguments& job, const Fault& fault, int places) const;

  /// Expects that every file in out() is one of `right`, byte by byte, and no temporary.
  void expect_whole_files(const Files& right) const;
  /// The same, and that none is missing.
  void expect_all_files(const Files& right) const;
};

/// `count` numbers from 1 to `last`, evenly spaced, both ends among them; all when there are fewer.
std::vector<long> spread(long last, int count);

}  // namespace photohull::test
