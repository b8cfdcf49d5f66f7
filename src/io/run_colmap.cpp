#include "io/run_colmap.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numeric>

#include "core/atomic_file.h"
#include "core/child_process.h"
#include "core/error.h"
#include "core/option_word.h"
#include "io/colmap_log.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/scene_masks.h"
#include "io/text_file.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kColmapProgram = "colmap";
constexpr const char* kMark = "made_by_photohull";  // a file of the folder
constexpr const char* kList = "images.txt";         // another: photographs of one run of COLMAP
constexpr std::size_t kFewestPosed = 3;
constexpr int kFewFeatures = 200;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// The folder without what an earlier job left there.
void clear(const fs::path& folder) {
  std::error_code failure;
  if (fs::exists(folder, failure) && !fs::is_empty(folder, failure) && !is_file(folder / kMark))
    throw Error(concat(folder.string(),
                       ": there is something that this program did not make; move it away, or give "
                       "another folder with ",
                       option_word("out")));
  fs::create_directories(folder, failure);
  if (failure) throw Error(concat(folder.string(), ": cannot be made (", failure.message(), ")"));
  write_atomically(folder / kMark, "COLMAP's work. It is replaced when cameras are found anew.\n");
  for (const char* name : {"images", "masks", "sparse", kList, "database.db", "database.db-wal",
                           "database.db-shm", "colmap.log"})
    fs::remove_all(folder / name, failure);
}

/// Links to the photographs, a folder for each lens, and the masks as COLMAP wants them.
class Links {
 public:
  Links(const ColmapJob& job, Progress& progress) {
    std::map<std::string, std::size_t> lenses;
    for (const ColmapPhoto& photo : job.photos) lenses.emplace(photo.lens, lenses.size());
    for (std::size_t i = 0; i < job.photos.size(); ++i) {
      progress.check_cancelled();
      const ColmapPhoto& photo = job.photos[i];
      char number[32];
      std::snprintf(number, sizeof number, "%05zu_", i + 1);
      names_.push_back(
          concat("lens_", lenses.at(photo.lens) + 1, "/", number, photo.image.filename().string()));
      const fs::path link = job.folder / "images" / names_.back();
      std::error_code failure;
      fs::create_directories(link.parent_path(), failure);
      fs::create_symlink(fs::absolute(photo.image).lexically_normal(), link, failure);
      if (failure)
        throw Error(concat(link.string(), ": the link to the photograph cannot be made (",
                           failure.message(), ")"));
      if (!photo.mask.empty()) write_mask(photo, job.folder / "masks" / (names_.back() + ".png"));
    }
  }
  const std::vector<std::string>& names() const { return names_; }

 private:
  static void write_mask(const ColmapPhoto& photo, const fs::path& file) {
    const FileMask mask = read_mask(photo.mask);
    const ImageSize size = read_image_size(photo.image);
    if (mask.width != size.width || mask.height != size.height)
      throw Error(concat(photo.mask.string(), ": the mask is ", mask.width, " x ", mask.height,
                         " but its photograph ", photo.image.string(), " is ", size.width, " x ",
                         size.height, "; give one of the same size"));
    std::error_code failure;
    fs::create_directories(file.parent_path(), failure);
    write_png(file, mask.width, mask.height, 1, mask.coverage);
  }

  std::vector<std::string> names_;
};

/// COLMAP's commands, one after the other.
class Runs {
 public:
  Runs(const ColmapJob& job, Progress& progress)
      : folder_(job.folder), progress_(progress), log_(job.photos.size(), progress) {}

  /// True where it ended well.
  bool run(const std::vector<std::string>& words) {
    begin_ = log_.text().size();
    ended_ = run_child(kColmapProgram, words, kNoLimit, progress_,
                       [&](std::string_view text) { log_.hear(text); });
    log_.end_command();
    write_atomically(folder_ / "colmap.log", log_.text());
    return ended_.ok();
  }
  void must_run(const std::vector<std::string>& words) {
    if (!run(words)) fail(words.front());
  }
  [[noreturn]] void fail(const std::string& command) const {
    const std::string last = log_.last_lines(begin_);
    throw Error(concat(kColmapProgram, " ", command, " failed (",
                       ended_.signal ? concat("signal ", ended_.signal, " ended it")
                                     : concat("exit code ", ended_.exit_code),
                       "); it said last: ", last.empty() ? "nothing" : last, "; all is in ",
                       (folder_ / "colmap.log").string()));
  }
  bool said(const std::string& words) const {
    return log_.text().find(words, begin_) != std::string::npos;
  }
  const ColmapLog& log() const { return log_; }

 private:
  fs::path folder_;
  Progress& progress_;
  ColmapLog log_;
  Finished ended_;
  std::size_t begin_ = 0;
};

/// From 3.12 on these options have other names.
struct OptionNames {
  std::string extraction = "--SiftExtraction.use_gpu", matching = "--SiftMatching.use_gpu";
};

OptionNames option_names(const Progress& progress) {
  if (!is_on_path(kColmapProgram))
    throw Error(
        concat("cameras are found by the program COLMAP, which is not installed; install "
               "the package ",
               kColmapProgram, ", or photograph the object on a printed sheet and give ",
               option_word("board")));
  const Finished help =
      run_child(kColmapProgram, {"feature_extractor", "--help"}, kNoLimit, progress);
  OptionNames names;
  if ((help.out + help.err).find("--FeatureExtraction.use_gpu") != std::string::npos)
    names = {"--FeatureExtraction.use_gpu", "--FeatureMatching.use_gpu"};
  return names;
}

/// One lens a folder of photographs, with one radial term and its principal point in the middle:
/// with more terms, wrong focal lengths fit the first few views that the mapper has as well as the
/// right one.
std::vector<std::string> extractor_words(const ColmapJob& job, const OptionNames& options) {
  std::vector<std::string> words = {"feature_extractor",
                                    "--database_path",
                                    (job.folder / "database.db").string(),
                                    "--image_path",
                                    (job.folder / "images").string(),
                                    "--ImageReader.single_camera_per_folder",
                                    "1",
                                    "--ImageReader.camera_model",
                                    "SIMPLE_RADIAL",
                                    options.extraction,
                                    "0"};
  if (std::ranges::any_of(job.photos, [](const ColmapPhoto& p) { return !p.mask.empty(); })) {
    words.push_back("--ImageReader.mask_path");
    words.push_back((job.folder / "masks").string());
  }
  return words;
}

/// The photographs' links by the focal length that their lens is given, 0 where it is given none.
/// Lenses with a focal length are apart, for the principal point is given with it.
std::map<std::pair<double, std::string>, std::vector<std::size_t>> by_given_focal(
    const ColmapJob& job) {
  std::map<std::string, double> of_lens;
  for (const ColmapPhoto& photo : job.photos) of_lens.emplace(photo.lens, photo.focal);
  std::map<std::pair<double, std::string>, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < job.photos.size(); ++i) {
    const std::string& lens = job.photos[i].lens;
    const double focal = of_lens.at(lens);
    groups[{focal, focal > 0 ? lens : std::string()}].push_back(i);
  }
  return groups;
}

void find_features(const ColmapJob& job, const OptionNames& options, const Links& links,
                   Runs& runs) {
  const std::vector<std::string> words = extractor_words(job, options);
  for (const auto& [key, photos] : by_given_focal(job)) {
    std::vector<std::string> all = words;
    if (photos.size() < job.photos.size()) {
      std::string list;
      for (const std::size_t i : photos) list += links.names()[i] + "\n";
      write_atomically(job.folder / kList, list);
      all.insert(all.end(), {"--image_list_path", (job.folder / kList).string()});
    }
    if (const double focal = key.first; focal > 0) {
      const ImageSize size = read_image_size(job.photos[photos.front()].image);
      all.insert(all.end(), {"--ImageReader.camera_params",
                             concat(focal, ",", 0.5 * size.width, ",", 0.5 * size.height, ",0")});
    }
    runs.must_run(all);
  }
}

void match_features(const ColmapJob& job, const OptionNames& options, Runs& runs) {
  std::vector<std::string> words = {job.ordered ? "sequential_matcher" : "exhaustive_matcher",
                                    "--database_path", (job.folder / "database.db").string(),
                                    options.matching, "0"};
  if (!job.ordered) {
    words.push_back("--ExhaustiveMatching.block_size");
    words.push_back("10");
  }
  runs.must_run(words);
}

Scene read_model(const ColmapJob& job, const fs::path& folder) {
  LoadSceneOptions options;
  options.format = SceneFormat::kColmapBinary;
  options.images = job.folder / "images";
  options.masks = MaskSource::kNone;
  options.box = Box{glm::dvec3(-1), glm::dvec3(1)};  // none is looked for
  return load_scene(folder, options);
}

/// Makes the models, and reads them, the one with the most photographs first.
std::vector<Scene> make_models(const ColmapJob& job, Runs& runs) {
  const fs::path sparse = job.folder / "sparse";
  std::error_code failure;
  fs::create_directories(sparse, failure);
  const bool well = runs.run({"mapper", "--database_path", (job.folder / "database.db").string(),
                              "--image_path", (job.folder / "images").string(), "--output_path",
                              sparse.string(), "--Mapper.min_model_size", "3"});
  std::vector<fs::path> folders;
  for (fs::directory_iterator i(sparse, failure), end; !failure && i != end; i.increment(failure))
    if (is_file(i->path() / "images.bin")) folders.push_back(i->path());
  std::sort(folders.begin(), folders.end());
  if (!well &&
      !(folders.empty() && (runs.said("failed to create") || runs.said("No good initial"))))
    runs.fail("mapper");
  std::vector<Scene> models;
  for (const fs::path& folder : folders) models.push_back(read_model(job, folder));
  std::stable_sort(models.begin(), models.end(),
                   [](const Scene& a, const Scene& b) { return a.views.size() > b.views.size(); });
  return models;
}

/// The index of the photograph that a view of COLMAP's model is.
std::size_t index_of(const SourceView& view) {
  return std::size_t(std::stoul(view.image.filename().string())) - 1;
}

std::string reason_of(const ColmapLog::Heard& heard, bool elsewhere) {
  if (!heard.problem.empty()) return concat("COLMAP says: ", heard.problem);
  if (elsewhere)
    return "COLMAP connects it with a few others only, which are not connected with the rest; "
           "photographs between them are missing";
  if (heard.features >= 0 && heard.features < kFewFeatures)
    return concat("COLMAP found only ", heard.features,
                  " features in it: it is blurred, dark, or shows little texture");
  return concat(
      "COLMAP could not connect it with the others",
      heard.features < 0 ? std::string() : concat(" (", heard.features, " features were found)"),
      "; photographs from places between are missing");
}

/// The model's views in the order of the photographs, its tracks with them.
void sort_views(Scene& scene) {
  std::vector<std::size_t> order(scene.views.size()), place(order.size());
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, {}, [&](std::size_t i) { return index_of(scene.views[i]); });
  std::vector<SourceView> views;
  for (std::size_t i = 0; i < order.size(); ++i) {
    views.push_back(std::move(scene.views[order[i]]));
    place[order[i]] = i;
  }
  scene.views = std::move(views);
  for (SceneTrack& track : scene.tracks) {
    for (SceneTrack::Observation& o : track.observations) o.view = int(place[std::size_t(o.view)]);
    std::ranges::sort(track.observations, {}, &SceneTrack::Observation::view);
  }
}

ColmapFound gather(const ColmapJob& job, const Links& links, std::vector<Scene> models,
                   const ColmapLog& log) {
  ColmapFound found;
  found.models = int(models.size());
  found.photos.resize(job.photos.size());
  for (std::size_t i = 0; i < job.photos.size(); ++i) {
    const auto heard = log.images().find(links.names()[i]);
    found.photos[i].features = heard == log.images().end() ? -1 : heard->second.features;
    bool elsewhere = false;
    for (const Scene& model : models)
      for (const SourceView& view : model.views) elsewhere |= index_of(view) == i;
    found.photos[i].reason =
        reason_of(heard == log.images().end() ? ColmapLog::Heard() : heard->second, elsewhere);
  }
  if (models.empty()) return found;
  found.scene = std::move(models.front());
  found.scene.box.reset();
  found.model = found.scene.path;
  sort_views(found.scene);
  std::map<std::string, std::size_t> lenses;
  for (SourceView& view : found.scene.views) {
    const std::size_t i = index_of(view);
    found.lens_of_view.push_back(lenses.emplace(job.photos[i].lens, lenses.size()).first->second);
    found.photos[i].posed = true;
    found.photos[i].reason.clear();
    view.name = job.photos[i].name;
    view.image = fs::absolute(job.photos[i].image).lexically_normal();
    if (!job.photos[i].mask.empty())
      view.mask = fs::absolute(job.photos[i].mask).lexically_normal();
  }
  return found;
}

}  // namespace

ColmapFound run_colmap(const ColmapJob& job, Progress& progress) {
  if (job.photos.size() < kFewestPosed)
    throw Error(concat("COLMAP needs three photographs at least, and there are ", job.photos.size(),
                       "; take 20 or more, from all around"));
  const OptionNames options = option_names(progress);
  clear(job.folder);
  const Links links(job, progress);
  Runs runs(job, progress);
  progress.stage("features", 0.3);
  find_features(job, options, links, runs);
  progress.stage("matches", 0.4);
  match_features(job, options, runs);
  progress.stage("cameras", 0.3);
  ColmapFound found = gather(job, links, make_models(job, runs), runs.log());
  if (found.scene.views.size() >= kFewestPosed) return found;
  std::string named;
  for (std::size_t i = 0; i < found.photos.size() && named.empty(); ++i)
    if (!found.photos[i].posed) named = concat(job.photos[i].name, ": ", found.photos[i].reason);
  throw Error(concat("COLMAP found the cameras of ", found.scene.views.size(), " of ",
                     job.photos.size(), " photographs, and three are needed (", named,
                     "); photographs must overlap and show texture: take more, closer together, "
                     "or put the object on a printed sheet and give ",
                     option_word("board")));
}

std::vector<fs::path> find_masks(const std::vector<fs::path>& images, const fs::path& folder) {
  std::error_code failure;
  if (!fs::is_directory(folder, failure))
    throw Error(concat(folder.string(), ": there is no such mask folder"));
  std::vector<fs::path> masks;
  for (const fs::path& image : images)
    masks.push_back(find_mask(folder, image, image.filename().string()));
  if (std::ranges::all_of(masks, [](const fs::path& mask) { return mask.empty(); }))
    throw Error(concat(folder.string(), ": there is no mask for any of the ", images.size(),
                       " photographs; name the masks as the photographs, such as ",
                       images.front().filename().string(), ".png"));
  return masks;
}

}  // namespace photohull::io
