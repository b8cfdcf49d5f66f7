// The visual hull as it is (--method hull).
#include "pipeline/estimate.h"
#include "pipeline/methods/method.h"

namespace photohull::pipeline {
namespace {

Surface carve(const SurfaceJob&, SparseVolume hull) { return {std::move(hull), {}}; }

}  // namespace

const MethodEntry kHullMethod = {.method = Method::kHull,
                                 .name = "hull",
                                 .sweeps = false,
                                 .by_silhouettes = true,
                                 .needs_no_silhouettes = false,
                                 .matches_larger = false,
                                 .follows = false,
                                 .in_parts = true,
                                 .from_hull = true,
                                 .stage = nullptr,
                                 .weight = 0,
                                 .cost = {2e-6, 2e-6, 377},
                                 .describe = nullptr,
                                 .carve = carve,
                                 .sharpen = nullptr,
                                 .carve_around = nullptr};

}  // namespace photohull::pipeline
