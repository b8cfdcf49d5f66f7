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

std::string random_spec_text(std::uint64_t number) {
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
  return j.dump();
}

synth::Spec random_spec(std::uint64_t number) {
  return synth::parse_spec(random_spec_text(number), concat("scene ", number), "");
}

pipeline::ReconstructOptions random_job(std::uint64_t number) {
  using pipeline::Method;
  Draw draw(~number);
  pipeline::ReconstructOptions job;
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

std::vector<std::string> random_arguments(std::uint64_t number) {
  Draw draw(number ^ 0x9e3779b97f4a7c15);
  std::vector<std::string> words;
  const auto choose = [&](int one_in, const char* option, std::vector<std::string> values) {
    if (!draw.one_in(one_in)) return;
    words.push_back(option);
    words.push_back(values[std::size_t(draw.whole(0, int(values.size()) - 1))]);
  };
  const auto flag = [&](int one_in, const char* option) {
    if (draw.one_in(one_in)) words.push_back(option);
  };
  const auto number_in = [&](double low, double high) { return concat(draw.between(low, high)); };
  if (draw.one_in(3))
    choose(1, "--quality", {"draft", "normal", "high"});
  else
    choose(1, "--resolution", {concat(draw.whole(8, 64)), concat(draw.whole(8, 32)), "100"});
  choose(1, "--method", {"hull", "voxel-coloring", "space-carving", "refine", "refine"});
  choose(3, "--masks", {"auto", "background", "none"});
  choose(4, "--box", {"auto", "-1 -1 -1 1 1 1", "0 0 0 0.2 0.1 0.3", "2 2 2 -2 -2 -2"});
  choose(5, "--box-scale", {number_in(0.3, 3)});
  choose(5, "--views", {"0-4", "spread:5", "0,2,4,5", concat("0-", draw.whole(1, 13))});
  choose(6, "--hold-out", {"0", "1,3"});
  choose(5, "--lattice", {"fit", "fixed"});
  flag(6, "--box-exact");
  choose(6, "--sampler", {"mipmap", "centroid", "nearest", "bilinear", "trilinear"});
  choose(6, "--supersample", {concat(draw.whole(1, 8))});
  choose(6, "--visibility", {"plain", "receiver-plane", "virtual-normal", "pcf3"});
  choose(6, "--r-consistency", {number_in(0, 4)});
  choose(5, "--mesh-error", {"0.25", number_in(0, 4), "0.001u"});
  choose(4, "--unseen", {"auto", "closed", "open"});
  choose(6, "--surroundings", {"on", "off", "auto"});
  choose(4, "--refine-cameras", {"off", "auto", "poses", "poses+intrinsics"});
  choose(4, "--photometric", {"off", "auto", "on"});
  choose(6, "--mask-offset", {"auto", number_in(-2, 2)});
  choose(6, "--mask-holes", {"mend", "keep"});
  choose(5, "--views-may-miss", {"auto", concat(draw.whole(0, 20))});
  choose(6, "--noise", {number_in(0, 20)});
  flag(6, "--keep-views");
  choose(5, "--image-scale", {"auto", "1/2", number_in(0.05, 1)});
  choose(6, "--max-memory", {"auto", "64M", "300M", "2G"});
  choose(3, "--threads", {"1", "2", "3"});
  flag(6, "--evidence");
  flag(6, "--fresh");
  flag(6, "--strict");
  flag(6, "--json");
  return words;
}

}  // namespace photohull::test
