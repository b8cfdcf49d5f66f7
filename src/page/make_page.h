// The report as one HTML page with the model in it (docs/guide/report_page.md).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/camera.h"
#include "page/encode_model.h"

namespace photohull::page {

/// A view as the page shows it.
struct ShownView {
  std::string name;
  Camera camera;                   ///< of the photograph's size before it was made smaller
  std::vector<std::uint8_t> jpeg;  ///< the photograph, small; empty: without
};

/// What the page shows beside the report's figures.
struct Shown {
  Model model;
  std::vector<ShownView> views;
  std::vector<std::uint8_t> texture{};  ///< JPEG, where the model has places on one
  glm::dvec3 up{0, 0, 1};               ///< unit, world: the model turns about it
  int first_view = 0;  ///< the model is looked at from the side of this one at first
};

/// One file that loads nothing, for a browser of 2023 or later: three.js, the model, the views and
/// the report. `report` is report.json; `command` the command line that makes the result again.
/// Texts of any kind, from names of files and folders above all, are shown as they are and are
/// never read as HTML or as a script. The same input gives the same page. Throws Error where
/// `report` is not JSON.
std::string make_page(const std::string& report, const std::string& command, const Shown& shown);

}  // namespace photohull::page
