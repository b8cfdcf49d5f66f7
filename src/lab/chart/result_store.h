// The folder that a chart keeps its results in.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/chart/run_record.h"

namespace photohull::chart {

///   runs/ID.json   one finished run each          meshes/ID.ply   meshes of plans that keep them
///   scenes/NAME/   synthetic scenes               work/           a run's files while it lasts
///   results.json   everything                     *.svg *.png index.html
class ResultStore {
 public:
  explicit ResultStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~ResultStore();
  ResultStore(const ResultStore&) = delete;
  ResultStore& operator=(const ResultStore&) = delete;

  /// Makes the folders, takes the lock and clears what an earlier process left in work/. Throws
  /// Error when the folder cannot be written or another process has the lock.
  void open();

  const std::filesystem::path& folder() const { return folder_; }
  /// An empty folder for a run's files, and its removal.
  std::filesystem::path make_work_folder(const std::string& id) const;
  void clear_work_folder(const std::string& id) const;
  std::filesystem::path scene_folder(const std::string& name) const {
    return folder_ / "scenes" / name;
  }
  /// The name of a kept mesh, relative to the folder.
  static std::string mesh_name(const std::string& id) { return "meshes/" + id + ".ply"; }

  /// The record of a run. Nothing where there is none, or where it is damaged or of another
  /// layout, which `warn` is told.
  std::optional<RunRecord> load(const std::string& id,
                                const std::function<void(const std::string&)>& warn) const;
  void save(const RunRecord& record) const;

 private:
  std::filesystem::path folder_;
  int lock_ = -1;
};

/// A folder for a run's files, removed with them however the run ends.
class WorkFolder {
 public:
  WorkFolder(const ResultStore& store, std::string id)
      : store_(store), id_(std::move(id)), path_(store.make_work_folder(id_)) {}
  ~WorkFolder() { store_.clear_work_folder(id_); }
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  const ResultStore& store_;
  std::string id_;
  std::filesystem::path path_;
};

}  // namespace photohull::chart
