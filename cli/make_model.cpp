#include "make_model.h"

#include <malloc.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/folder_lock.h"
#include "core/too_many_voxels.h"
#include "kept_steps.h"
#include "piece_progress.h"
#include "pipeline/join_parts.h"
#include "pipeline/part.h"
#include "pipeline/part_options.h"
#include "pipeline/photographs.h"
#include "pipeline/stage_weights.h"
#include "pipeline/write_results.h"
#include "reconstruct_scene.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kCoarsest = 4;         // times that the whole's voxels are doubled, at most
constexpr double kWholeShare = 0.2;  // of the time that all takes
constexpr double kLessRoom = 0.9;    // than a part had that did not fit

MadeModel of_report(pipeline::Report report) {
  return {report.verdict, int(report.photographs.views), report.grid.voxel_size,
          report.mesh.triangles, std::move(report)};
}

/// Makes a scene that has too many voxels.
class PartByPart {
 public:
  PartByPart(const pipeline::ReconstructOptions& job, const io::LoadSceneOptions& load,
             const fs::path& scene, const fs::path& out, Progress& progress)
      : job_(job),
        load_(load),
        scene_(scene),
        out_(out),
        folder_(made_folder(out / "parts")),
        lock_(folder_, "out"),
        steps_(folder_ / "steps.json"),
        progress_(progress) {}

  MadeModel make(const TooManyVoxels& problem) {
    job_.resolution.reset();
    job_.voxel_size = problem.voxel_size();
    make_whole(problem);
    const std::vector<fs::path> parts = make_parts(problem);
    progress_.stage("join", 1);
    malloc_trim(0);
    const pipeline::JoinedParts joined =
        pipeline::join_parts(whole_, parts, out_, job_.max_memory, progress_);
    std::error_code ignored;
    if (joined.joined) fs::remove_all(folder_, ignored);
    return {joined.verdict, joined.views, joined.voxel_size, joined.triangles, {}};
  }

 private:
  static fs::path made_folder(fs::path folder) {
    std::error_code failure;
    fs::create_directories(folder, failure);
    if (failure)
      throw Error(concat(folder.string(), ": cannot make this folder: ", failure.message()));
    return folder;
  }

  /// On voxels as small as memory has room for. Throws what was the matter with the model where it
  /// has none.
  void make_whole(const TooManyVoxels& of_model) {
    pipeline::ReconstructOptions whole;
    for (finer_ = 1;; ++finer_) {
      whole = pipeline::options_of_whole(job_, finer_);
      whole.report_page = pipeline::ReportPage::kOff;
      try {
        make_piece("whole", whole, kWholeShare);
        return;
      } catch (const TooManyVoxels& problem) {
        if (finer_ < kCoarsest && problem.room() > 0) continue;
        std::error_code ignored;
        fs::remove_all(folder_, ignored);
        fs::remove(out_, ignored);  // if nothing else is in it
        throw of_model;
      }
    }
  }

  /// As few as fit. Throws what was the matter with the model where none do.
  std::vector<fs::path> make_parts(const TooManyVoxels& of_model) {
    const SparseVolume surface = pipeline::bricks_of_whole(whole_);
    for (double room = of_model.room(); room > 0;) {
      const std::optional<int> count = pipeline::fewest_parts(surface, finer_, room);
      if (!count) break;
      progress_.note(concat(of_model.problem(), ": it is made in ", *count, " parts"));
      std::vector<fs::path> made;
      pipeline::PartNumber part{1, *count};
      try {
        for (; part.number <= part.count; ++part.number) made.push_back(make_part(part));
        return made;
      } catch (const TooManyVoxels& too_many) {
        room = kLessRoom * std::max(too_many.room(), 0.0) *
               pipeline::share_of_part(surface, part, finer_);
      }
    }
    throw of_model;
  }

  fs::path make_part(const pipeline::PartNumber& part) {
    const std::string name = concat("part", part.number, "of", part.count);
    return make_piece(name, pipeline::options_of_part(job_, part, finer_, whole_),
                      (1 - kWholeShare) / part.count);
  }

  fs::path make_piece(const std::string& name, const pipeline::ReconstructOptions& job,
                      double share) {
    const fs::path folder = folder_ / name;
    const std::string identity = model_identity(job, load_, scene_, folder);
    if (job.fresh || !steps_.has(name, identity) || !has_results(folder)) {
      const double weight = share * pipeline::total_weight(job_);
      PieceProgress progress(progress_, name, weight, pipeline::total_weight(job), &said_);
      steps_.begin(name);
      malloc_trim(0);  // the C library keeps what was freed
      pipeline::reconstruct_to_folder(job, pipeline::load_photographs(scene_, load_), folder,
                                      progress);
      steps_.done(name, identity);
    }
    return folder;
  }

  pipeline::ReconstructOptions job_;
  const io::LoadSceneOptions& load_;
  const fs::path &scene_, &out_;
  const fs::path folder_, whole_ = folder_ / "whole";
  const FolderLock lock_;
  KeptSteps steps_;
  Progress& progress_;
  std::set<std::string> said_;
  int finer_ = 1;
};

}  // namespace

MadeModel make_model(const pipeline::ReconstructOptions& job, const io::LoadSceneOptions& load,
                     const fs::path& scene, const fs::path& out, Progress& progress) {
  std::optional<TooManyVoxels> problem;
  try {
    return of_report(pipeline::reconstruct_to_folder(job, pipeline::load_photographs(scene, load),
                                                     out, progress));
  } catch (const TooManyVoxels& too_many) {
    problem = too_many;
  }
  if (problem->room() <= 0 || job.part || !job.follow.empty()) throw *problem;
  try {
    pipeline::options_of_part(job, {}, 1, out);
  } catch (const UsageError& refused) {
    throw TooManyVoxels(problem->problem(), concat("in parts it cannot be made: ", refused.what()),
                        problem->voxel_size(), 0);
  }
  return PartByPart(job, load, scene, out, progress).make(*problem);
}

}  // namespace photohull::cli
