#include "pipeline/reconstruct.h"

#include <malloc.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <memory>
#include <span>
#include <utility>

#include "core/error.h"
#include "core/option_word.h"
#include "core/process_limits.h"
#include "mesh/join_meshes.h"
#include "photo/opencv_threads.h"
#include "pipeline/check_room.h"
#include "pipeline/device_work.h"
#include "pipeline/finish_mesh.h"
#include "pipeline/given_words.h"
#include "pipeline/judge_result.h"
#include "pipeline/keep_evidence.h"
#include "pipeline/larger_photographs.h"
#include "pipeline/look.h"
#include "pipeline/photometric_stage.h"
#include "pipeline/place_lattice.h"
#include "pipeline/prepare_subject.h"
#include "pipeline/recording_progress.h"
#include "pipeline/show_result.h"
#include "pipeline/stage_weights.h"
#include "pipeline/surroundings.h"
#include "pipeline/texture_stage.h"
#include "projtex/gpu_views.h"
#include "render/choose_views.h"
#include "render/preview.h"

namespace photohull::pipeline {
namespace {

/// From silhouettes to the surface, its colours, and what is to be thought of it.
class Carver {
 public:
  Carver(Run& run, Prepared prepared)
      : run_(run),
        method_(method_of(run.options)),
        subject_(std::move(prepared.subject)),
        bounded_(prepared.masks),
        cameras_(std::move(prepared.cameras)),
        silhouettes_(std::move(prepared.silhouettes)),
        hull_(run.options, subject_, *run.context, run.progress) {}

  Reconstruction carve() {
    StageClock& clock = run_.clock;
    Reconstruction out;
    SparseVolume carved = carve_surface();
    out.volume =
        clock.run("clean", Weights::kClean, [&] { return remove_dust(job(), std::move(carved)); });
    ExtractedSurface extracted =
        clock.run("mesh", Weights::kMesh, [&] { return extract_surface(job(), out.volume); });
    make_alike_on_mesh(extracted.mesh);
    ColouredSurface coloured = colour(std::move(extracted.mesh), out);
    OpenSurface surface{
        std::move(coloured.mesh), seen_vertices(std::exchange(coloured.evidence, {})), {}};
    // What silhouettes bound is judged by them as a whole; else what is delivered is.
    const bool open = leaves_open(run_.options, bounded_);
    if (open && !bounded_) surface = open_unseen(job(), surface.mesh, std::move(surface.seen));
    const Around around = surround(surface.mesh, open);
    images_->give_back(subject_.views);
    images_.reset();
    run_.context->release_deleted();
    hand_over_volume(out);
    if (part())
      take_own(surface);
    else
      judge(surface.mesh, extracted.findings, around, out.evidence);
    if (open && bounded_) surface = open_unseen(job(), surface.mesh, std::move(surface.seen));
    run_.report.mesh = {.extract = extracted.findings,
                        .colour = coloured.findings,
                        .islands = surface.findings,
                        .error = {}};
    append_mesh(around.mesh, surface.mesh);
    deliver(std::move(surface.mesh), surface.seen, out);
    return out;
  }

 private:
  SurfaceJob job() {
    return {
        run_.options,  run_.photographs, subject_,      *run_.context, hull_,
        images_.get(), bounded_,         run_.progress, larger_.get(), run_.earlier.given_moment(),
        part(),        beside_};
  }

  /// That is carved alone; null: the whole is.
  const Part* part() const { return run_.earlier.given_part(); }

  SparseVolume carve_surface() {
    subject_.held_bytes = check_room(run_.options, subject_, hull_);
    SparseVolume hull = run_.clock.run("hull", Weights::kHull, [&] { return carve_hull(); });
    alike_ = any_mask(subject_.views) || gains_are_known(photometric_job());
    if (alike_)
      make_alike([&] { return measure_gains_on_hull(photometric_job(), hull_, subject_); });
    if (!masks_are_needed(run_.options, subject_.views))
      subject_.views = without_masks(std::move(subject_.views));
    if (method_.from_hull) hull_.release_textures();
    run_.context->release_deleted();
    run_.clock.run("images", Weights::kImages, [&] {
      upload();
      if (run_.earlier.part) {
        beside_ = depths_beside(*run_.context, *part(), projtex::cameras_of(subject_.views));
        run_.earlier.part->beside = {};
      }
      larger_ = larger_photographs(run_.photographs.reader, subject_, gains_, run_.options,
                                   run_.progress);
    });
    if (alike_ && !method_.sweeps)
      images_->lend(subject_.views);  // no stage looks at them meanwhile
    Surface surface;
    const auto work = [&] {
      if (!method_.from_hull) {
        bounded_ = part() ? any_mask(subject_.views) : hull_.bounded();
        warn_of_surroundings(run_.options, bounded_, run_.progress);
      }
      return method_.carve(job(), std::move(hull));
    };
    if (method_.stage) {
      surface = run_.clock.run(method_.stage, method_.weight, work);
      run_.clock.count_samples(method_.stage, surface.findings.samples);
    } else {
      surface = work();
    }
    larger_.reset();
    run_.earlier.before.reset();
    if (run_.earlier.part) run_.earlier.part->near = {};
    hull_.release_textures();
    run_.report.surface = std::move(surface.findings);
    return std::move(surface.volume);
  }

  SparseVolume carve_hull() {
    if (!method_.from_hull) return {};
    if (method_.by_silhouettes && !any_mask(subject_.views))
      run_.progress.warn(
          concat("without masks the hull is the box clipped by the frusta: give "
                 "masks or use ",
                 option_word("method", "refine")));
    return part() ? hull_.carve_box(subject_.grid, subject_.box) : hull_.carve(subject_.grid);
  }

  void upload() {
    images_ = std::make_unique<projtex::ImageSet>(subject_.views, part() ? projtex::kCutPixels : 1);
  }

  PhotometricJob photometric_job() {
    return {run_.options, subject_.noise_sigma, run_.progress, run_.earlier.given_rig()};
  }

  /// Divides the photographs by the gains that `measure` finds, before colours are compared. Did
  /// pixels change?
  template <typename Measure>
  bool make_alike(const Measure& measure) {
    if (run_.options.photometric == Photometric::kOff) return false;
    return run_.clock.run("photometric", Weights::kPhotometric, [&] {
      const MeasuredGains found = measure();
      run_.report.photometric = found.findings;
      gains_ = found.gains;
      if (gains_) subject_.views = divide_by_gains(std::move(subject_.views), *gains_);
      return gains_.has_value();
    });
  }

  /// Where there were no silhouettes, gains are measured on the surface that was found.
  void make_alike_on_mesh(const TriMesh& mesh) {
    if (alike_) return;
    const bool changed = make_alike([&] {
      return measure_gains_on(photometric_job(), mesh, subject_.grid.voxel_size, subject_.views);
    });
    if (!changed) return;
    images_.reset();
    run_.context->release_deleted();
    upload();
  }

  /// The volume gets its attributes from the mesh.
  ColouredSurface colour(TriMesh mesh, Reconstruction& out) {
    return run_.clock.run("colour", Weights::kColour, [&] {
      ColouredSurface coloured = colour_surface(job(), std::move(mesh));
      if (run_.options.evidence) out.evidence = keep_evidence(coloured.mesh, coloured.evidence);
      if (part()) out.volume = own_of(*part(), out.volume);
      out.attributes = attributes_from_mesh(out.volume, coloured.mesh);
      return coloured;
    });
  }

  void hand_over_volume(Reconstruction& out) {
    run_.report.voxels_kept = std::int64_t(out.volume.inside_voxels());
    run_.report.bricks_stored = std::int64_t(out.volume.bricks.size());
    if (!run_.take_volume) return;
    run_.clock.run("volume", Weights::kVolume, [&] {
      run_.take_volume(std::exchange(out.volume, {}), std::exchange(out.attributes, {}));
    });
    malloc_trim(0);  // the C library keeps what was freed
  }

  Around surround(const TriMesh& mesh, bool open) {
    if (bounded_ || !has_surroundings(run_.options, subject_.box_found, subject_.views)) return {};
    Around around = run_.clock.run("surroundings", Weights::kSurroundings,
                                   [&] { return make_surroundings(job(), mesh, open); });
    hull_.release_textures();
    run_.clock.count_samples("surroundings", around.samples);
    run_.report.surroundings = around.findings;
    return around;
  }

  /// What is the part's own, and the whole's verdict: photographs show more than a part.
  void take_own(OpenSurface& surface) {
    surface.mesh = own_of(*part(), std::move(surface.mesh));
    surface.seen = {};
    run_.report.verdict = run_.earlier.verdict;
  }

  void judge(const TriMesh& mesh, const ExtractFindings& extracted, const Around& around,
             std::optional<Evidence>& evidence) {
    Judgement judgement = run_.clock.run("verdict", Weights::kVerdict, [&] {
      return judge_result(job(), {mesh, around, cameras_, silhouettes_, extracted.stem_vertices},
                          evidence.has_value());
    });
    malloc_trim(0);  // the rays' tree was large
    run_.report.verdict = std::move(judgement.findings);
    if (!evidence) return;
    evidence->missing = std::move(judgement.missing);
    evidence->explained = std::move(judgement.explained);
  }

  /// The meshes of the files, and what is shown of them: `whole` is all of the surface, of which
  /// `seen` tells.
  void deliver(TriMesh whole, const SeenVertices& seen, Reconstruction& out) {
    MeshFindings& found = run_.report.mesh;
    found.uniform_triangles = std::int64_t(whole.triangles.size());
    out.mesh = std::move(whole);
    const bool textured = makes_texture(run_.options);
    if (!textured) drop_distances(subject_.views);
    const bool page = run_.options.report_page == ReportPage::kOn;
    const TriMesh uniform = textured ? out.mesh : TriMesh();
    if (page && !textured)
      out.shown = run_.clock.run("page", Weights::kPage,
                                 [&] { return show_result(out.mesh, seen, subject_.views); });
    if (run_.options.mesh_error.value > 0) {
      SimplifiedSurface simple =
          run_.clock.run("simplify", Weights::kSimplify, [&] { return simplify(job(), out.mesh); });
      found.error = simple.findings;
      out.mesh = std::move(simple.mesh);
    }
    found.vertices = std::int64_t(out.mesh.positions.size());
    found.triangles = std::int64_t(out.mesh.triangles.size());
    out.up = upward_axis(subject_.views);
    if (textured) {
      MadeTexture made = run_.clock.run("texture", Weights::kTexture,
                                        [&] { return make_textured(job(), uniform, out.mesh); });
      run_.report.texture = made.findings;
      out.textured = std::move(made.mesh);
    }
    if (page && textured)
      out.shown = run_.clock.run("page", Weights::kPage, [&] {
        return show_textured(*out.textured, uniform, seen, subject_.views);
      });
    run_.report.hull = hull_.findings();
    run_.clock.count_samples("hull", hull_.findings().samples);  // later stages carve hulls, too
    draw(out);
  }

  void draw(Reconstruction& out) {
    // The preview chooses its view by the mesh that it draws, and no other photograph is kept.
    const TriMesh& drawn = out.textured ? out.textured->mesh : out.mesh;
    const int main = render::choose_main_view(drawn, subject_.views);
    run_.report.look = look_at(drawn, subject_.views, main);
    if (out.shown) {
      out.shown->first_view = main;
      out.shown->up = run_.report.look.up;
    }
    keep_only_photograph(main, subject_.views);
    out.preview = run_.clock.run("preview", Weights::kPreview, [&] {
      return out.textured ? render_preview(*run_.context, *out.textured, subject_.views)
                          : render_preview(*run_.context, out.mesh, subject_.views);
    });
  }

  Run& run_;
  const MethodEntry& method_;
  Subject subject_;
  bool bounded_;  // do silhouettes bound the space that they leave?
  const CameraFindings cameras_;
  const SilhouetteFindings silhouettes_;
  Hull hull_;
  std::unique_ptr<projtex::ImageSet> images_;
  std::vector<DepthMap> beside_;                 // the part, if one is carved alone
  std::optional<PhotometricCalibration> gains_;  // that pixels were divided by
  std::unique_ptr<projtex::OutOfCorePhotographs> larger_;
  bool alike_ = false;  // were the photographs' gains looked at on the hull?
};

std::unique_ptr<tbb::global_control> limit_threads(int threads) {
  if (threads == 0) return nullptr;
  return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                               std::size_t(threads));
}

}  // namespace

Reconstructor::Reconstructor(ReconstructOptions options) : options_(std::move(options)) {
  options_.validate();
}

Reconstruction Reconstructor::run(const Photographs& photographs, Progress& given,
                                  const TakeVolume& take_volume) const {
  const auto start = std::chrono::steady_clock::now();
  const double cpu = process_cpu_seconds();
  check_process_limits(options_.threads);
  const auto limit = limit_threads(options_.threads);
  const OneOpenCvThread one_thread;
  RecordingProgress progress(given);
  EarlierResults earlier = read_earlier(options_);
  const ReconstructOptions options = options_of(earlier.part, options_);
  std::optional<Photographs> of_whole;
  if (earlier.part) of_whole = photographs_of(*earlier.part, photographs);
  Run run{options, of_whole ? *of_whole : photographs, progress, take_volume};
  run.earlier = std::move(earlier);
  Prepared prepared = prepare(run);
  Reconstruction out = Carver(run, std::move(prepared)).carve();
  out.report = std::move(run.report);
  out.report.version = PHOTOHULL_VERSION;
  out.report.options = named_options(options_, photographs.load);
  out.report.option_line = option_line(options_, photographs.load);
  out.report.given_words = given_words(options_, photographs.load);
  out.report.warnings = progress.warnings();
  out.report.stages = run.clock.stages();
  out.report.device_work = device_work(*run.context);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  out.report.wall_seconds = elapsed.count();
  out.report.cpu_seconds = process_cpu_seconds() - cpu;
  out.report.peak_memory_bytes = process_peak_memory();
  return out;
}

}  // namespace photohull::pipeline
