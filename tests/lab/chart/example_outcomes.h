// Hand-made outcomes with laws that are known.
#pragma once

#include <vector>

#include "lab/chart/outcome.h"

namespace photohull::chart::test {

/// Scenes "ball" and "cube": the hull at 50, 100 and 200 voxels (F = 100 - 2000 / N, error 10 / N,
/// time (N / 50)^2, memory N), "carving" at 100 (failed) and 200 (F = 95), and an external peer.
inline std::vector<Outcome> example_outcomes() {
  std::vector<Outcome> all;
  for (const std::string scene : {"ball", "cube"}) {
    for (const int n : {50, 100, 200}) {
      Outcome o;
      o.scene = scene;
      o.variant = "hull";
      o.resolution = n;
      o.cpu_seconds = n / 50.0 * (n / 50.0);
      o.wall_seconds = *o.cpu_seconds / 2;
      o.peak_mb = n;
      o.figures.f_percent = {{0.1, 50.0}, {0.25, 100 - 2000.0 / n}};
      o.figures.accuracy_percent = 10.0 / n;
      o.stages = {{"views", 1.0}, {"hull", 2.0 * n / 50}};
      all.push_back(o);
    }
    Outcome failed;
    failed.scene = scene;
    failed.variant = "carving";
    failed.resolution = 100;
    failed.failed = true;
    failed.failure = "reconstruct: exit code 1: <b>out & about</b>";
    failed.cpu_seconds = 12;
    all.push_back(failed);
    Outcome carving = all[2];
    carving.scene = scene;
    carving.variant = "carving";
    carving.cpu_seconds = 40;
    carving.figures.f_percent[0.25] = 95;
    all.push_back(carving);
    Outcome peer;
    peer.scene = scene;
    peer.variant = "peer";
    peer.external = true;
    peer.cpu_seconds = 80;
    peer.figures.f_percent[0.25] = 94;
    all.push_back(peer);
  }
  return all;
}

}  // namespace photohull::chart::test
