#include "pipeline/reconstruct.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "assess/verdict.h"
#include "assess/wrong_views.h"
#include "calib/crop.h"
#include "calib/mask_bias.h"
#include "calib/noise.h"
#include "calib/prepare_views.h"
#include "calib/silhouette.h"
#include "carving/fit_grid.h"
#include "carving/hull.h"
#include "carving/object_box.h"
#include "carving/photo.h"
#include "carving/thin_parts.h"
#include "core/error.h"
#include "io/image_file.h"
#include "pipeline/checks.h"
#include "pipeline/job_identity.h"
#include "pipeline/mask_policy.h"
#include "pipeline/result_files.h"
#include "pipeline/self_check.h"
#include "pipeline/stage_clock.h"
#include "pipeline/stage_weights.h"
#include "pipeline/tuning.h"
#include "projtex/image_set.h"
#include "projtex/sample_images.h"
#include "refine/refine.h"
#include "render/bake_colour.h"
#include "render/choose_views.h"
#include "render/preview.h"
#include "volume/attributes.h"
#include "volume/components.h"
#include "volume/extract_mesh.h"
#include "volume/remove_unseen.h"
#include "volume/sharpen_edges.h"
#include "volume/simplify_mesh.h"
#include "volume/write_mesh.h"
#include "volume/write_vdb.h"

namespace photohull::pipeline {
namespace {

namespace fs = std::filesystem;

// High quality: iterations of matching at the finest voxels, passes of fitting patches to the
// photographs after them, and Gauss-Newton steps of each.
constexpr int kHighIterations = 2, kHighPasses = 3, kHighSteps = 3;
// Masks that were made from the background are wrong in places, and mostly at their rims: a part
// comes back only when one view in so many asks for it, so many pixels within its mask.
constexpr int kDoubtingViews = 3;
constexpr double kDoubtfulRim = 2;
constexpr double kLeastEvidence = 0.1;    // share of the surface below which a result is doubtful
constexpr double kDebrisFraction = 5e-4;  // of the largest part's voxels
constexpr int kPhotometricVoxels = 160;   // along the box, of the hull that gains are measured on
constexpr double kOversized = 1.8;        // times the object's box: the box is made smaller
constexpr int kCropMargin = 24;           // pixels around the box's projection: patches, mip levels
constexpr double kDetail = 1.5;           // pixels: what refinement resolves, by its patches
constexpr std::size_t kFewestThinVoxels = 32;  // a hull of fewer, all of them thin, is none
constexpr double kBoxSlack = 0.5;              // voxels that the surface may stand out of the box

double longest_side(const Box& box) {
  const glm::dvec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

double voxel_size_of(const ReconstructOptions& options, const Box& box,
                     std::span<const Camera> cameras) {
  if (options.resolution) return carving::voxel_size_for(box, *options.resolution);
  const double largest = carving::voxel_size_for(box, 2);
  if (options.voxel_size) {
    if (*options.voxel_size > largest)
      throw UsageError(concat("--voxel-size ", *options.voxel_size, ": at most ", largest,
                              ", half of the box's longest side"));
    return *options.voxel_size;
  }
  const double footprint = carving::pixel_footprint(box, cameras);
  if (!(footprint > 0)) throw Error("no camera has the box's centre in front of it");
  const double size = footprint * footprint_factor(options.quality);
  if (size > largest)
    throw Error(concat("a pixel is ", footprint,
                       " world units large at the box's centre, too much for a box whose longest "
                       "side is ",
                       2 * largest, "; check the box's units, or give --voxel-size"));
  return size;
}

std::vector<Camera> cameras_of(std::span<const SourceView> views) {
  std::vector<Camera> cameras;
  for (const SourceView& view : views) cameras.push_back(view.camera);
  return cameras;
}

double median_noise(std::span<const View> views) {
  std::vector<double> values(views.size());
  tbb::parallel_for(std::size_t(0), views.size(),
                    [&](std::size_t i) { values[i] = estimate_image_noise(views[i].image); });
  std::nth_element(values.begin(), values.begin() + long(values.size() / 2), values.end());
  // Quantisation to 8 bits alone leaves about this much.
  return std::max(values[values.size() / 2], 1.0 / 255 / std::sqrt(12.0));
}

class Job {
 public:
  Job(const ReconstructOptions& options, Progress& progress)
      : options_(options), progress_(progress), clock_(report_, progress) {
    report_.version = PHOTOHULL_VERSION;
    report_.options = named_options(options);
  }

  Report run() {
    const auto start = std::chrono::steady_clock::now();
    clock_.run("scene", Weights::kScene, [&] { load(); });
    // What can fail at once does so before the photographs are decoded.
    std::vector<std::string> names = {"volume.vdb", "mesh.ply", "preview.png", "report.json"};
    if (options_.evidence) names.emplace_back("evidence.ply");
    ResultFiles files(options_.output, std::move(names));
    report_.files = files.names();
    clock_.run("device", Weights::kDevice, [&] { open_device(); });
    clock_.run("views", Weights::kViews, [&] { prepare(); });
    if (options_.refine_cameras != RefineCameras::kOff)
      clock_.run("cameras", Weights::kCameras, [&] { refine_cameras(); });
    tighten_box();
    fit_grid();
    crop();
    const bool refining = options_.effective_method() == Method::kRefine;
    SparseVolume volume = clock_.run("hull", Weights::kHull, [&] {
      measure_silhouettes();
      correct_masks();
      leave_out_wrong_views();
      return refining ? SparseVolume() : carve_hull();
    });
    // Before colours are compared, where silhouettes give a surface.
    const bool photometric = options_.photometric != Photometric::kOff;
    const bool on_hull = photometric && any_mask();
    if (on_hull)
      clock_.run("photometric", Weights::kPhotometric, [&] { correct_photometric_on_hull(); });
    // The other samplers weight by the masks.
    if (!refining && sampler() == projtex::Sampler::kMipmap)
      for (View& view : views_) std::vector<std::uint8_t>().swap(view.mask.coverage);
    context_->release_deleted();
    images_ = clock_.run("images", Weights::kImages,
                         [&] { return std::make_unique<projtex::ImageSet>(views_); });
    if (refining)
      volume = clock_.run("refine", Weights::kRefine, [&] { return refine(); });
    else if (options_.effective_method() != Method::kHull)
      volume = clock_.run("photo", Weights::kPhoto, [&] { return carve_photo(volume); });
    clock_.run("clean", Weights::kClean, [&] { remove_small_components(volume, kDebrisFraction); });
    TriMesh mesh = clock_.run("mesh", Weights::kMesh, [&] { return extract(volume); });
    if (photometric && !on_hull)
      clock_.run("photometric", Weights::kPhotometric, [&] {
        if (!correct_photometric(mesh, grid_.voxel_size)) return;
        images_.reset();
        context_->release_deleted();
        images_ = std::make_unique<projtex::ImageSet>(views_);
      });
    VolumeAttributes attributes = clock_.run("colour", Weights::kColour, [&] {
      colour(mesh, files);
      return attributes_from_mesh(volume, mesh);
    });
    images_.reset();
    context_->release_deleted();
    clock_.run("verdict", Weights::kVerdict, [&] { judge(mesh); });
    if (options_.unseen == Unseen::kOpen) open_unseen(mesh);
    report_.uniform_triangles = std::int64_t(mesh.triangles.size());
    if (options_.mesh_error.value > 0)
      clock_.run("simplify", Weights::kSimplify, [&] { simplify(mesh); });
    keep_only_preview_photograph(mesh);  // of the mesh that it will show
    clock_.run("files", Weights::kFiles, [&] { write(volume, attributes, mesh, files); });
    attributes = {};
    context_->release_deleted();
    clock_.run("preview", Weights::kPreview, [&] { write_preview(mesh, files); });
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    finish(volume, mesh, elapsed.count());
    const std::string report = report_.to_json();
    files.open("report.json").write(report.data(), report.size());
    progress_.check_cancelled();
    files.commit();
    if (refining) remove_checkpoint();
    return report_;
  }

 private:
  void warn(const std::string& text) {
    report_.warnings.push_back(text);
    progress_.warn(text);
  }

  void load() {
    scene_ = io::load_scene(options_.scene, options_.load);
    report_.scene = scene_.path.string();
    report_.format = to_string(scene_.format);
    report_.views = int(scene_.views.size());
    for (const std::string& text : scene_.warnings) warn(text);
    if (!scene_.box)
      throw Error(concat(scene_.path.string(),
                         ": nothing tells where the object is: give --box "
                         "\"x0 y0 z0 x1 y1 z1\" or a bbox.txt beside the scene"));
    report_.box = *scene_.box;
    report_.box_source = scene_.box_source;
    for (const std::string& text : check_box(*scene_.box, scene_.box_source, scene_.views))
      warn(text);
    // Else the voxels' size follows the box, which may become smaller.
    if (options_.resolution || options_.voxel_size) check_memory(lattice(cameras_of(scene_.views)));
  }

  /// A box that is much larger than the object would waste the voxels, and far from the object few
  /// views see what silhouettes do not reject.
  void tighten_box() {
    if (!carving::box_is_oversized(*scene_.box, views_)) return;
    const Box box = carving::object_box(*scene_.box, views_);
    const double factor = longest_side(*scene_.box) / longest_side(box);
    if (factor < kOversized) return;
    warn(concat("the box from ", scene_.box_source, " is ", std::round(10 * factor) / 10,
                " times larger than what the silhouettes leave: the object's own box is taken, "
                "and --resolution counts along that"));
    scene_.box = report_.box = box;
    scene_.box_source = report_.box_source += ", made smaller by the silhouettes";
  }

  GridSpec lattice(std::span<const Camera> cameras) const {
    return carving::fit_grid(*scene_.box, voxel_size_of(options_, *scene_.box, cameras));
  }

  void fit_grid() {
    check_cameras_outside(*scene_.box, scene_.box_source, scene_.views);
    cameras_ = projtex::cameras_of(views_);
    grid_ = lattice(cameras_);
    check_memory(grid_);
    report_.grid = grid_;
  }

  void prepare() {
    const ViewLoader loader{[](const fs::path& path) { return io::read_image(path); },
                            [](const fs::path& path) { return io::read_mask(path); }};
    PrepareOptions prepare_options;
    prepare_options.masks = mask_policy(options_.load.masks);
    PreparedViews prepared = prepare_views(scene_, loader, prepare_options, progress_);
    views_ = std::move(prepared.views);
    report_.noise_sigma = median_noise(views_);
    for (const std::string& text : prepared.warnings) warn(text);
    report_.mask_source = prepared.mask_source;
    report_.mask_confidence = prepared.mask_confidence;
    for (std::size_t i = 0; i < views_.size(); ++i)
      report_.masks.push_back(
          {views_[i].name, prepared.masks[i].source, prepared.masks[i].confidence});
  }

  void refine_cameras() {
    RefineCamerasOptions o;
    if (options_.refine_cameras == RefineCameras::kPosesAndIntrinsics)
      o.intrinsics = SharedIntrinsics::kAll;
    o.given = undistorted_tracks(scene_, views_);
    o.box = scene_.box;
    const CameraRefinement found = photohull::refine_cameras(views_, o, progress_);
    const bool use =
        found.changed && (options_.refine_cameras != RefineCameras::kAuto || pays(found));
    report_.camera_refinement = to_json(found, scene_, use);
    if (!use) return;
    cameras_moved_ = found.moved;
    apply(found, scene_);
    for (std::size_t i = 0; i < views_.size(); ++i) views_[i].camera = found.cameras[i];
  }

  void correct_photometric_on_hull() {
    const double coarse = carving::voxel_size_for(*scene_.box, kPhotometricVoxels);
    const GridSpec grid = carving::fit_grid(*scene_.box, std::max(coarse, grid_.voxel_size));
    correct_photometric(extract_mesh(hull_at(grid)), grid.voxel_size);
  }

  /// Whether the views' pixels changed.
  bool correct_photometric(const TriMesh& mesh, double voxel_size) {
    const PhotometricOutcome found = pipeline::correct_photometric(
        options_.photometric, scene_, mesh, voxel_size, report_.noise_sigma, views_, progress_);
    report_.photometric = found.json;
    report_.photometric_line = found.line;
    if (!found.warning.empty()) warn(found.warning);
    return found.used;
  }

  void crop() {
    for (View& view : views_) crop_to_box(scene_.box.value(), kCropMargin, view);
    cameras_ = projtex::cameras_of(views_);
  }

  void open_device() {
    context_ = gpu::Context::create(options_.device, options_.threads);
    report_.device = context_->device().renderer;
  }

  bool any_mask() const {
    return std::any_of(views_.begin(), views_.end(), [](const View& v) { return !v.mask.empty(); });
  }

  void measure_silhouettes() {
    silhouette_distances_.resize(views_.size());
    tbb::parallel_for(std::size_t(0), views_.size(), [&](std::size_t i) {
      if (!views_[i].mask.empty()) silhouette_distances_[i] = silhouette_distance(views_[i].mask);
    });
  }

  /// Masks that are all too small carve the object itself away.
  void correct_masks() {
    double offset = options_.mask_offset.value_or(0);
    if (!options_.mask_offset) {
      const MaskBias bias = measure_mask_bias(views_, silhouette_distances_);
      if (bias.counts()) offset = bias.pixels;
    }
    report_.mask_offset = offset;
    if (offset == 0) return;
    if (!options_.mask_offset)
      warn(concat("the masks are about ", std::round(10 * std::abs(offset)) / 10, " px too ",
                  offset > 0 ? "small" : "large",
                  ": outlines are taken from where the photographs' edges are (--mask-offset 0 "
                  "takes the masks as they are)"));
    for (std::size_t i = 0; i < views_.size(); ++i)
      if (!views_[i].mask.empty()) move_outline(offset, views_[i].mask, silhouette_distances_[i]);
  }

  /// One view that is far off carves away what all others have.
  void leave_out_wrong_views() {
    const assess::SilhouetteConsistency found =
        assess::find_wrong_views(*scene_.box, cameras_, pointers(silhouette_distances_));
    contradiction_ = found.uncovered_left;
    for (auto i = found.wrong.rbegin(); i != found.wrong.rend(); ++i) {
      warn(concat("view ", views_[*i].name,
                  " is left out: without it the other views' silhouettes agree; check its camera "
                  "and its mask"));
      report_.left_out.push_back(views_[*i].name);
      views_.erase(views_.begin() + *i);
      scene_.views.erase(scene_.views.begin() + *i);
      cameras_.erase(cameras_.begin() + *i);
      silhouette_distances_.erase(silhouette_distances_.begin() + *i);
    }
  }

  std::vector<carving::Silhouette> silhouettes() const {
    std::vector<carving::Silhouette> out;
    for (std::size_t i = 0; i < views_.size(); ++i)
      out.push_back(
          {&views_[i].mask, views_[i].mask.empty() ? nullptr : &silhouette_distances_[i]});
    return out;
  }

  SparseVolume hull_at(const GridSpec& grid) {
    const std::vector<carving::Silhouette> silhouettes = this->silhouettes();
    carving::HullOptions hull_options;
    hull_options.min_views = any_mask() ? 1 : 2;
    Box box = *scene_.box;
    box.min -= kBoxSlack * grid.voxel_size;
    box.max += kBoxSlack * grid.voxel_size;
    carving::HullReport counts;
    Progress silent;
    SparseVolume volume = carving::carve_silhouette(*context_, grid, box, cameras_, silhouettes,
                                                    hull_options, silent, &counts);
    const std::size_t thin =
        carving::keep_thin_parts(volume, box, cameras_, silhouettes, hull_options);
    const std::size_t inside = volume.inside_voxels();
    const bool specks = grid.voxel_size == grid_.voxel_size && inside == thin &&
                        thin < kFewestThinVoxels;  // coarse grids may hold no more of it
    if (inside == 0 || specks)
      throw Error(explain_empty_hull(*scene_.box, views_, grid.voxel_size));
    report_.nodes_tested += counts.nodes_tested;
    report_.bricks_evaluated += counts.bricks_evaluated;
    hull_samples_ += counts.samples;
    return volume;
  }

  SparseVolume refine() {
    refine::RefineOptions o;
    o.noise_sigma = report_.noise_sigma;
    if (options_.quality == Quality::kHigh) {
      o.fine_iterations = kHighIterations;
      o.photometric = kHighPasses;
      o.fit.steps = kHighSteps;
    }
    if (report_.mask_confidence < 1) {
      o.restore.least_views =
          std::max(o.restore.least_views, int(cameras_.size()) / kDoubtingViews);
      o.restore.least_inside = kDoubtfulRim;
    }
    tune(options_.tune, o, sharpen_);
    const refine::CheckpointFile checkpoint{checkpoint_path(),
                                            job_identity(options_, scene_, grid_, report_.device)};
    if (options_.fresh) remove_checkpoint();
    refine::RefineReport counts;
    SparseVolume volume = refine::refine_surface(
        *context_, grid_, [&](const GridSpec& grid) { return hull_at(grid); }, silhouettes(),
        *images_, cameras_, o, progress_, &counts, &checkpoint);
    report_.resumed_levels = counts.resumed;
    for (const refine::FitReport& fit : counts.fits)
      report_.refine_fits.push_back(
          {fit.seconds, fit.held_before, fit.held_after, fit.mean_move, fit.kept});
    for (const refine::LevelReport& level : counts.levels) {
      report_.refine_levels.push_back({level.voxel_size, level.seconds, level.surfels,
                                       level.samples, level.bricks, level.restored, level.freed,
                                       level.split, level.settled_pixels, level.settled_plain,
                                       level.settled_flat, level.mean_move, level.evidence});
      refine_samples_ += level.samples;
    }
    if (volume.inside_voxels() == 0)
      throw Error(
          "refinement left nothing: the photographs disagree everywhere; check the cameras "
          "(photohull info) or use --method hull");
    const double evidence = counts.levels.back().evidence;
    if (evidence < kLeastEvidence)
      warn(concat("the photographs tell where the surface is on ", std::lround(100 * evidence),
                  " % of it only (too little texture, or too few cameras that see the same): the "
                  "rest is the hull's guess"));
    return volume;
  }

  fs::path checkpoint_path() const { return options_.output / ".photohull-checkpoint"; }

  void remove_checkpoint() const {
    std::error_code ignored;  // what cannot be removed belongs to another job, or to this one anew
    fs::remove(checkpoint_path(), ignored);
  }

  SparseVolume carve_hull() {
    if (!any_mask() && options_.effective_method() == Method::kHull)
      warn(
          "without masks the hull is the box clipped by the frusta: give masks or use "
          "--method refine");
    return hull_at(grid_);
  }

  SparseVolume carve_photo(const SparseVolume& hull) {
    carving::PhotoOptions photo;
    photo.method = options_.effective_method() == Method::kVoxelColoring
                       ? carving::PhotoMethod::kVoxelColoring
                       : carving::PhotoMethod::kSpaceCarving;
    photo.noise_sigma = report_.noise_sigma;
    photo.supersample = options_.supersample.value_or(photo.supersample);
    photo.statistic = options_.consistency.value_or(photo.statistic);
    photo.visibility = options_.visibility.value_or(photo.visibility);
    tune(options_.tune, photo);
    carving::PhotoReport counts;
    SparseVolume volume = sweep(hull, photo, counts);
    report_.sweeps = counts.sweeps;
    report_.voxels_judged = counts.judged;
    report_.voxels_carved = counts.carved;
    report_.voxels_undecided = counts.undecided + counts.reverted;
    photo_samples_ = counts.samples;
    if (volume.inside_voxels() == 0)
      throw Error(
          "photo-consistency carved everything away: the photographs disagree everywhere; "
          "check the cameras (photohull info) or use --method hull");
    if (counts.judged == 0)
      warn("no voxel was seen by enough cameras to be judged: the result is the hull");
    else if (report_.voxels_undecided >= counts.judged)
      warn(
          "the photographs show too little texture to decide on any voxel: the result is the hull");
    return volume;
  }

  projtex::Sampler sampler() const { return options_.sampler.value_or(projtex::kDefaultSampler); }

  SparseVolume sweep(const SparseVolume& hull, const carving::PhotoOptions& photo,
                     carving::PhotoReport& counts) {
    report_.sampling = {projtex::to_string(sampler()), photo.supersample,
                        carving::to_string(photo.statistic),
                        visibility::to_string(photo.visibility)};
    if (sampler() == projtex::Sampler::kMipmap)
      return carving::carve_photo(*context_, hull, *images_, cameras_, photo, progress_, &counts);
    const projtex::SampleImages images(views_, sampler());
    return carving::carve_photo(*context_, hull, images, cameras_, photo, progress_, &counts);
  }

  TriMesh extract(const SparseVolume& volume) {
    TriMesh mesh = extract_mesh(volume);
    if (options_.effective_method() == Method::kRefine) {
      const double detail = kDetail * carving::pixel_footprint(*scene_.box, cameras_);
      report_.sharpened_vertices = std::int64_t(
          sharpen_edges(sharpen_, grid_.voxel_size, std::max(detail, grid_.voxel_size), mesh));
    }
    return mesh;
  }

  void colour(TriMesh& mesh, ResultFiles& files) {
    if (mesh.triangles.empty())
      throw Error(
          "the volume holds no surface: every part is thinner than a voxel; raise --resolution");
    const bool silhouettes = options_.effective_method() == Method::kHull;
    std::vector<render::PooledEvidence> evidence;
    photohull::bake_colour(
        *context_, grid_, *images_, cameras_, report_.noise_sigma,
        silhouettes ? render::Shaping::kSilhouettes : render::Shaping::kPhotographs, mesh,
        progress_, nullptr, options_.evidence ? &evidence : nullptr);
    if (options_.evidence) write_evidence(mesh, evidence, files);
    const auto unseen = std::count(mesh.confidence.begin(), mesh.confidence.end(), 0.0f);
    report_.unseen_share = double(unseen) / double(mesh.confidence.size());
    if (report_.unseen_share > 0.5)
      warn(concat(std::lround(100 * report_.unseen_share),
                  " % of the surface is seen by no camera: it is the hull's guess"));
  }

  void write_evidence(const TriMesh& mesh, const std::vector<render::PooledEvidence>& evidence,
                      ResultFiles& files) {
    VertexScalars scalars;
    for (const render::PooledEvidence& e : evidence) {
      scalars["scatter"].push_back(e.scatter);
      scalars["disagreement"].push_back(e.disagreement);
      scalars["fine_share"].push_back(e.fine_share);
    }
    write_ply(files.open("evidence.ply"), mesh, scalars);
  }

  void judge(const TriMesh& mesh) {
    const assess::Signals signals = gather_signals({.mesh = &mesh,
                                                    .box = &*scene_.box,
                                                    .voxel_size = grid_.voxel_size,
                                                    .views = views_,
                                                    .silhouettes = silhouette_distances_,
                                                    .mask_confidence = report_.mask_confidence,
                                                    .contradiction = contradiction_,
                                                    .cameras_moved = cameras_moved_});
    std::vector<std::string> names;
    for (const View& view : views_) names.push_back(view.name);
    report_.verdict = assess::judge(signals, names);
    report_.verdict_json = to_json(report_.verdict, signals, views_);
  }

  /// After colouring, which tells what is seen, and before simplification, which keeps the border.
  void open_unseen(TriMesh& mesh) {
    mesh = remove_unseen(mesh);
    if (mesh.triangles.empty())
      throw Error(
          "--unseen open leaves nothing: no camera sees any of the surface; check the cameras "
          "(photohull info) or use --unseen closed");
  }

  void simplify(TriMesh& mesh) {
    const double voxel = grid_.voxel_size;
    const double error = options_.mesh_error.value * (options_.mesh_error.world_units ? 1 : voxel);
    TriMesh simple = simplify_mesh(mesh, error);
    progress_.check_cancelled();
    const MeshDistance d = measure_distance(mesh, simple, mean_edge(mesh));
    report_.mesh_error = MeshErrorReport{error / voxel, d.mean / voxel, d.p95 / voxel,
                                         d.p999 / voxel, d.max / voxel};
    mesh = std::move(simple);
  }

  void write(const SparseVolume& volume, const VolumeAttributes& attributes, const TriMesh& mesh,
             ResultFiles& files) {
    if (vdb_unit(grid_.voxel_size) != 1)
      warn(concat("volume.vdb counts in ", vdb_unit(grid_.voxel_size),
                  " scene units (its metadata scene_unit): OpenVDB has no voxels as small as ",
                  grid_.voxel_size));
    write_vdb(files.open("volume.vdb"), volume, attributes, {{"photohull_options", option_line()}});
    progress_.check_cancelled();
    write_ply(files.open("mesh.ply"), mesh);
  }

  /// The other photographs' pixels have done their work; memory peaks in the stages to come.
  void keep_only_preview_photograph(const TriMesh& mesh) {
    const int kept = render::choose_main_view(mesh, views_);
    for (int i = 0; i < int(views_.size()); ++i)
      if (i != kept) std::vector<std::uint8_t>().swap(views_[i].image.bytes);
  }

  void write_preview(const TriMesh& mesh, ResultFiles& files) {
    const PreviewImage preview = render_preview(*context_, mesh, views_);
    io::write_png(files.open("preview.png"), preview.width, preview.height, 3, preview.rgb);
  }

  std::string option_line() const {
    std::string line;
    for (const auto& [name, value] : report_.options)
      line += (line.empty() ? "" : " ") + name + "=" + value;
    return line;
  }

  void finish(const SparseVolume& volume, const TriMesh& mesh, double wall_seconds) {
    for (StageReport& stage : report_.stages) {
      if (stage.name == "hull") stage.samples = hull_samples_;
      if (stage.name == "photo") stage.samples = photo_samples_;
      if (stage.name == "refine") stage.samples = refine_samples_;
    }
    report_.voxels_kept = std::int64_t(volume.inside_voxels());
    report_.bricks_stored = std::int64_t(volume.bricks.size());
    report_.vertices = std::int64_t(mesh.positions.size());
    report_.triangles = std::int64_t(mesh.triangles.size());
    report_.wall_seconds = wall_seconds;
    report_.cpu_seconds = process_cpu_seconds();
    report_.peak_memory_bytes = process_peak_memory();
  }

 private:
  const ReconstructOptions& options_;
  Progress& progress_;
  Report report_;
  StageClock clock_;
  Scene scene_;
  GridSpec grid_;
  std::vector<View> views_;
  std::vector<Camera> cameras_;
  std::unique_ptr<gpu::Context> context_;
  std::unique_ptr<projtex::ImageSet> images_;
  std::vector<SilhouetteDistance> silhouette_distances_;
  double contradiction_ = 0;  ///< of the silhouettes that are used
  double cameras_moved_ = 0;  ///< pixels
  SharpenOptions sharpen_;
  std::int64_t hull_samples_ = 0, photo_samples_ = 0, refine_samples_ = 0;
};

}  // namespace

Report reconstruct(const ReconstructOptions& options, Progress& progress) {
  options.validate();
  std::unique_ptr<tbb::global_control> limit;
  if (options.threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  std::size_t(options.threads));
  Job job(options, progress);
  return job.run();
}

}  // namespace photohull::pipeline
