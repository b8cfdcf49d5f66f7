#include "pipeline/reconstruct.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "assess/verdict.h"
#include "carving/fit_grid.h"
#include "carving/fit_stems.h"
#include "core/error.h"
#include "core/process_limits.h"
#include "io/image_file.h"
#include "io/mesh/write_mesh.h"
#include "mesh/join_meshes.h"
#include "mesh/remove_islands.h"
#include "mesh/remove_unseen.h"
#include "mesh/sharpen_edges.h"
#include "mesh/simplify_mesh.h"
#include "pipeline/checks.h"
#include "pipeline/explained_picture.h"
#include "pipeline/hull_stage.h"
#include "pipeline/inputs.h"
#include "pipeline/missing_picture.h"
#include "pipeline/refine_stage.h"
#include "pipeline/result_files.h"
#include "pipeline/self_check.h"
#include "pipeline/stage_clock.h"
#include "pipeline/stage_weights.h"
#include "pipeline/surroundings.h"
#include "pipeline/sweep_stage.h"
#include "pipeline/tuning.h"
#include "projtex/image_set.h"
#include "refine/dust.h"
#include "render/bake_colour.h"
#include "render/choose_views.h"
#include "render/preview.h"
#include "volume/attributes.h"
#include "volume/components.h"
#include "volume/extract_mesh.h"
#include "volume/write_vdb.h"

namespace photohull::pipeline {
namespace {

constexpr double kDebrisFraction = 5e-4;  // of the largest part's voxels
constexpr double kDetail = 1.5;           // pixels: what refinement resolves, by its patches
constexpr const char* kMissingPicture = "missing.png";
constexpr const char* kExplainedPicture = "explained.png";
constexpr double kMoreLikelyRight = 0.5;  // confidence is the chance to be right

class Job {
 public:
  Job(const ReconstructOptions& options, Progress& progress)
      : options_(options),
        progress_(progress),
        clock_(report_, progress),
        in_(options, report_, progress) {
    report_.version = PHOTOHULL_VERSION;
    report_.options = named_options(options);
  }

  Report run() {
    const auto start = std::chrono::steady_clock::now();
    clock_.run("scene", Weights::kScene, [&] {
      in_.load();
      report_.inputs = hash_inputs(in_.scene);
    });
    // What can fail at once does so before the photographs are decoded.
    std::vector<std::string> names = {"volume.vdb", "mesh.ply", "preview.png", "report.json"};
    if (options_.evidence)
      names.insert(names.end(), {"evidence.ply", kMissingPicture, kExplainedPicture});
    ResultFiles files(options_.output, std::move(names));
    report_.files = files.names();
    clock_.run("device", Weights::kDevice, [&] { open_device(); });
    clock_.run("views", Weights::kViews, [&] { in_.prepare(); });
    if (const double weight = Weights::cameras(options_); weight > 0)
      clock_.run("cameras", weight, [&] { in_.refine_cameras(); });
    in_.tighten_box();
    in_.fit_grid();
    in_.crop();
    const bool refining = options_.effective_method() == Method::kRefine;
    bounded_ = in_.any_mask();
    SparseVolume volume = clock_.run("hull", Weights::kHull, [&] {
      in_.measure_silhouettes();
      in_.measure_sharpness();
      in_.correct_masks();
      in_.trace_outlines();
      in_.leave_out_wrong_views();
      in_.bear_disagreement();
      in_.widen_lines();
      in_.explain_foreground();
      hull_ = std::make_unique<HullStage>(options_, in_, *context_, report_);
      return refining ? SparseVolume() : hull_->carve_alone();
    });
    // Before colours are compared, where silhouettes give a surface.
    const bool photometric = options_.photometric != Photometric::kOff;
    const bool on_hull = photometric && in_.any_mask();
    if (on_hull)
      clock_.run("photometric", Weights::kPhotometric,
                 [&] { hull_->correct_photometric(progress_); });
    // The other samplers weight by the masks, and lines get their width from them.
    if (!refining && sampler_of(options_) == projtex::Sampler::kMipmap) in_.forget_masks();
    context_->release_deleted();
    images_ = clock_.run("images", Weights::kImages,
                         [&] { return std::make_unique<projtex::ImageSet>(in_.views); });
    if (refining)
      volume = clock_.run("refine", Weights::kRefine, [&] { return refine(); });
    else if (options_.effective_method() != Method::kHull)
      volume = clock_.run("photo", Weights::kPhoto, [&] { return sweep(volume); });
    clock_.run("clean", Weights::kClean, [&] { remove_dust(volume); });
    TriMesh mesh = clock_.run("mesh", Weights::kMesh, [&] { return extract(volume); });
    if (photometric && !on_hull)
      clock_.run("photometric", Weights::kPhotometric, [&] {
        if (options_.photometric == Photometric::kAuto &&
            photographs_are_alike(mesh, in_.grid.voxel_size, in_, report_, progress_))
          return;
        if (!correct_photometric(options_.photometric, mesh, in_.grid.voxel_size, in_, report_,
                                 progress_))
          return;
        images_.reset();
        context_->release_deleted();
        images_ = std::make_unique<projtex::ImageSet>(in_.views);
      });
    VolumeAttributes attributes = clock_.run("colour", Weights::kColour, [&] {
      colour(mesh, files);
      return attributes_from_mesh(volume, mesh);
    });
    // What silhouettes bound is judged by them as a whole; else what is delivered is.
    if (is_open() && !bounded_) open_unseen(mesh);
    if (in_.has_surroundings() && !bounded_)
      clock_.run("surroundings", Weights::kSurroundings, [&] { surround(mesh); });
    images_.reset();
    context_->release_deleted();
    clock_.run("verdict", Weights::kVerdict, [&] { judge(mesh, files); });
    if (is_open() && bounded_) open_unseen(mesh);
    append_mesh(around_.mesh, mesh);
    around_ = {};
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
    if (refining) refine_->remove_checkpoint();
    return report_;
  }

 private:
  void open_device() {
    context_ = gpu::Context::create(options_.device, options_.threads);
    report_.device = context_->device().renderer;
  }

  SparseVolume refine() {
    refine_ = std::make_unique<RefineStage>(options_, in_, *context_, report_, progress_);
    bounded_ = hull_->bounded();
    if (bounded_ && options_.surroundings == Surroundings::kOn)
      in_.warn(
          "--surroundings on: silhouettes bound the object, and what surrounds it is in none of "
          "them; it is left out (--masks none reconstructs without silhouettes)");
    return refine_->run(*hull_, *images_, bounded_);
  }

  SparseVolume sweep(const SparseVolume& hull) {
    return sweep_hull(options_, hull, *images_, in_, *context_, report_, progress_, photo_samples_);
  }

  void surround(const TriMesh& mesh) {
    around_ = make_surroundings(
        {options_, in_, *context_, *hull_, *refine_, *images_, report_, progress_}, mesh,
        is_open());
  }

  /// Small pieces go, but for those that masks ask for.
  void remove_dust(SparseVolume& volume) {
    remove_small_components(volume, kDebrisFraction, [&](auto pieces) {
      return refine::are_asked_for(*context_, volume, pieces, in_.cameras,
                                   in_.silhouettes_of_views(), {});
    });
  }

  TriMesh extract(const SparseVolume& volume) {
    TriMesh mesh = extract_mesh(volume);
    if (options_.effective_method() == Method::kRefine) {
      const double detail = kDetail * carving::pixel_footprint(*in_.scene.box, in_.cameras);
      report_.sharpened_vertices = std::int64_t(sharpen_edges(
          refine_->sharpen(), in_.grid.voxel_size, std::max(detail, in_.grid.voxel_size), mesh));
    }
    fit_stems(mesh);
    context_->release_deleted();  // stages to come need large pieces, and this one left small ones
    return mesh;
  }

  /// Stems that are thinner than voxels get their width from the masks.
  void fit_stems(TriMesh& mesh) {
    std::vector<carving::StemView> views;
    for (std::size_t i = 0; i < in_.views.size(); ++i)
      if (!in_.views[i].mask.empty())
        views.push_back({in_.cameras[i], &in_.views[i].mask, &in_.lines[i]});
    report_.thin.stem_vertices =
        std::int64_t(carving::fit_stems(views, in_.grid.voxel_size, mesh, tuned(options_).stems));
  }

  void colour(TriMesh& mesh, ResultFiles& files) {
    if (mesh.triangles.empty())
      throw Error(
          "the volume holds no surface: every part is thinner than a voxel; raise --resolution");
    const bool silhouettes = options_.effective_method() == Method::kHull;
    std::vector<render::PooledEvidence> evidence;
    photohull::bake_colour(
        *context_, in_.grid, *images_, in_.cameras, report_.noise_sigma,
        silhouettes ? render::Shaping::kSilhouettes : render::Shaping::kPhotographs, mesh,
        progress_, nullptr, &evidence);
    for (const render::PooledEvidence& e : evidence) views_that_see_.push_back(e.views);
    if (options_.evidence) write_evidence(mesh, evidence, files);
    const auto unseen = std::count(mesh.confidence.begin(), mesh.confidence.end(), 0.0f);
    report_.unseen_share = double(unseen) / double(mesh.confidence.size());
    if (report_.unseen_share > 0.5)
      in_.warn(concat(std::lround(100 * report_.unseen_share),
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

  void judge(const TriMesh& mesh, ResultFiles& files) {
    const CheckedResult result{
        .mesh = &mesh,
        .box = &*in_.scene.box,
        .around = &around_.mesh,
        .around_box = &around_.box,
        .voxel_size = in_.grid.voxel_size,
        .hull = options_.effective_method() == Method::kHull,
        .bounded = bounded_,
        .share_beyond = hull_->share_beyond(),
        .views = in_.views,
        .silhouettes = in_.silhouettes,
        .widened = in_.widened,
        .lines = in_.lines,
        .mask_confidence = report_.mask_confidence,
        .noise_sigma = report_.noise_sigma,
        .stems = double(report_.thin.stem_vertices) /
                 double(std::max<std::size_t>(mesh.positions.size(), 1)),
        .stems_restored = double(report_.thin.restored_pixels) /
                          double(std::max<std::int64_t>(report_.thin.line_pixels, 1)),
        .contradiction = in_.contradiction,
        .common = in_.common_error,
        .cameras_moved = in_.cameras_moved,
        .cameras_moved_alike = in_.cameras_moved_alike};
    std::vector<assess::SilhouetteFit> fits;
    const assess::Signals signals = gather_signals(result, &fits);
    std::vector<std::string> names;
    for (const View& view : in_.views) names.push_back(view.name);
    report_.verdict = assess::judge(signals, names);
    report_.verdict_json = to_json(report_.verdict, signals, in_.views);
    if (!options_.evidence) return;
    report_.missing_view = write_picture(kMissingPicture, draw_missing(result, fits), files);
    report_.explained_view =
        write_picture(kExplainedPicture, draw_explained(in_.views, signals.explained), files);
  }

  /// Scenes have one of the two pictures, by whether they have masks. Returns the view that it is
  /// of.
  std::string write_picture(const char* name, const MissingPicture& picture, ResultFiles& files) {
    if (picture.rgb.empty())
      std::erase(report_.files, name);
    else
      io::write_png(files.open(name), picture.width, picture.height, 3, picture.rgb);
    return picture.view;
  }

  /// Without silhouettes knowledge ends where the photographs do.
  bool is_open() const {
    return options_.unseen == Unseen::kOpen || (options_.unseen == Unseen::kAuto && !bounded_ &&
                                                options_.effective_method() == Method::kRefine);
  }

  /// After colouring, which tells what is seen, and before simplification, which keeps the border.
  void open_unseen(TriMesh& mesh) {
    const bool by_photographs = !bounded_;
    mesh = remove_unseen(mesh, by_photographs ? kMoreLikelyRight : 0, &views_that_see_);
    if (by_photographs) {
      const RemovedIslands gone =
          remove_islands(mesh, views_that_see_, {.voxel_size = in_.grid.voxel_size});
      report_.islands = std::int64_t(gone.pieces);
      report_.islands_area_share = gone.area_share;
    }
    if (mesh.triangles.empty())
      throw Error(concat(
          "no surface was found that a camera sees and that is more likely right than wrong; check "
          "the cameras (photohull info), or look at all of it with --unseen closed",
          told_of_cameras_within(*in_.scene.box, in_.scene.box_source, in_.scene.views)));
  }

  void simplify(TriMesh& mesh) {
    const double voxel = in_.grid.voxel_size;
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
    if (vdb_unit(in_.grid.voxel_size) != 1)
      in_.warn(concat("volume.vdb counts in ", vdb_unit(in_.grid.voxel_size),
                      " scene units (its metadata scene_unit): OpenVDB has no voxels as small as ",
                      in_.grid.voxel_size));
    write_vdb(files.open("volume.vdb"), volume, attributes,
              {{"photohull_options", option_line(options_)}});
    progress_.check_cancelled();
    write_ply(files.open("mesh.ply"), mesh);
  }

  /// The other photographs' pixels have done their work; memory peaks in the stages to come.
  void keep_only_preview_photograph(const TriMesh& mesh) {
    const int kept = render::choose_main_view(mesh, in_.views);
    for (int i = 0; i < int(in_.views.size()); ++i)
      if (i != kept) std::vector<std::uint8_t>().swap(in_.views[i].image.bytes);
  }

  void write_preview(const TriMesh& mesh, ResultFiles& files) {
    const PreviewImage preview = render_preview(*context_, mesh, in_.views);
    io::write_png(files.open("preview.png"), preview.width, preview.height, 3, preview.rgb);
  }

  void finish(const SparseVolume& volume, const TriMesh& mesh, double wall_seconds) {
    for (StageReport& stage : report_.stages) {
      if (stage.name == "hull") stage.samples = hull_->samples();
      if (stage.name == "photo") stage.samples = photo_samples_;
      if (stage.name == "refine") stage.samples = refine_->samples();
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
  Inputs in_;
  std::unique_ptr<gpu::Context> context_;
  std::unique_ptr<projtex::ImageSet> images_;
  std::unique_ptr<HullStage> hull_;
  std::unique_ptr<RefineStage> refine_;
  Around around_;
  bool bounded_ = false;               // do silhouettes bound the space that they leave?
  std::vector<float> views_that_see_;  ///< of the mesh's vertices
  std::int64_t photo_samples_ = 0;
};

}  // namespace

Report reconstruct(const ReconstructOptions& options, Progress& progress) {
  options.validate();
  check_process_limits(options.threads);
  std::unique_ptr<tbb::global_control> limit;
  if (options.threads > 0)
    limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                  std::size_t(options.threads));
  Job job(options, progress);
  return job.run();
}

}  // namespace photohull::pipeline
