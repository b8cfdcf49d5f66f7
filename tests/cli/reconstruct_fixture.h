// Reconstructions of the ball, and what they wrote.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "io/mesh/write_mesh.h"
#include "sphere_scene.h"

namespace photohull::test {

class Reconstruct : public SphereScene {
 protected:
  TriMesh mesh() const { return read_ply(path("out/mesh.ply")); }
  nlohmann::json report() const {
    return nlohmann::json::parse(read_bytes(path("out/report.json")));
  }
};

}  // namespace photohull::test
