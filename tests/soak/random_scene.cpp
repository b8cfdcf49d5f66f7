#include "random_scene.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <span>

#include "core/error.h"
#include "synth/shapes.h"

namespace photohull::test {
namespace {

/// Draws by number: nothing of what is drawn depends on a standard library's distributions.
class Draw {
 public:
  explicit Draw(std::uint64_t number) : random_(number) {}
  double between(double low, double high) {
    return low + (high - low) * double(random_()) / double(random_.max());
  }
  int whole(int low, int high) { return low + int(random_() % std::uint64_t(high - low + 1)); }
  bool one_in(int count) { return whole(1, count) == 1; }

 private:
  std::mt19937_64 random_;
};

}  // namespace

synth::Spec random_spec(std::uint64_t number) {
  Draw draw(number);
  const auto shapes = synth::shapes();
  nlohmann::json j;
  j["seed"] = number;
  j["geometry"] = {{"shape", shapes[std::size_t(draw.whole(0, int(shapes.size()) - 1))].name},
                   {"scale", std::pow(10.0, draw.between(-3, 3))},
                   {"rotate", {draw.between(0, 360), draw.between(0, 360), draw.between(0, 360)}}};
  j["material"] = {{"contrast", draw.between(0, 1)}, {"gloss", draw.one_in(4) ? 0.4 : 0.0}};
  j["background"] = {{"type", draw.one_in(4) ? "clutter" : "colour"}};
  j["image"] = {{"width", draw.whole(40, 80)}, {"height", draw.whole(40, 80)},
                {"samples", draw.whole(1, 2)}, {"bits", draw.one_in(4) ? 16 : 8},
                {"maps", draw.one_in(8)},      {"masks", !draw.one_in(6)}};
  j["cameras"] = {
      {"layout", "hemisphere"}, {"count", draw.whole(6, 14)}, {"lowest", -40}, {"highest", 80}};
  j["degradations"] = {{"read_noise", draw.one_in(3) ? 0.01 : 0.0},
                       {"jpeg", j["image"]["bits"] == 8 && draw.one_in(5) ? 70 : 0},
                       {"exposure", draw.one_in(5) ? 0.2 : 0.0},
                       {"pose_error", draw.one_in(4) ? 0.5 : 0.0},
                       {"k1", draw.one_in(4) ? -0.05 : 0.0}};
  j["truth_samples"] = 1000;
  return synth::parse_spec(j.dump(), concat("scene ", number), "");
}

pipeline::ReconstructOptions random_job(std::uint64_t number, const std::filesystem::path& scene,
                                        const std::filesystem::path& output) {
  using pipeline::Method;
  Draw draw(~number);
  pipeline::ReconstructOptions job;
  job.scene = scene;
  job.output = output;
  job.resolution = draw.whole(12, 32);
  const Method methods[] = {Method::kHull, Method::kVoxelColoring, Method::kSpaceCarving,
                            Method::kRefine, Method::kRefine};
  job.method = methods[draw.whole(0, 4)];
  if (draw.one_in(4)) job.mesh_error.value = 0.25;
  if (draw.one_in(4)) job.unseen = pipeline::Unseen::kOpen;
  if (draw.one_in(4)) job.photometric = pipeline::Photometric::kOn;
  if (draw.one_in(6)) job.refine_cameras = pipeline::RefineCameras::kAuto;
  job.evidence = draw.one_in(6);
  return job;
}

}  // namespace photohull::test
