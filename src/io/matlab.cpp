// 3x4 projection matrices in a MATLAB file: a 3 x 4 x N array or a cell array of N matrices, as
// Oxford's dinosaur has them, for the images of the folder in natural order or those that a cell
// array of names lists.
#include <algorithm>

#include "core/atomic_file.h"
#include "core/error.h"
#include "io/find_files.h"
#include "io/matlab_file.h"
#include "io/pose_parts.h"
#include "io/scene_readers.h"
#include "io/text_file.h"
#include "io/write_scene_parts.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

using Rows = std::array<double, 12>;

bool is_matrix(const MatArray& a) { return a.values.size() == 12 && a.dimensions[0] == 3; }

/// By rows, from values by columns.
Rows rows_of(const double* columns) {
  Rows rows;
  for (int i = 0; i < 12; ++i) rows[i] = columns[i % 4 * 3 + i / 4];
  return rows;
}

std::vector<Rows> matrices_of(const MatArray& a) {
  std::vector<Rows> matrices;
  const std::vector<std::size_t>& n = a.dimensions;
  if (!a.values.empty() && n.size() >= 2 && n.size() <= 3 && n[0] == 3 && n[1] == 4)
    for (std::size_t i = 0; i < a.values.size() / 12; ++i)
      matrices.push_back(rows_of(&a.values[12 * i]));
  if (!a.cells.empty() && std::all_of(a.cells.begin(), a.cells.end(), is_matrix))
    for (const MatArray& cell : a.cells) matrices.push_back(rows_of(cell.values.data()));
  return matrices;
}

std::vector<std::string> names_of(const MatArray& a) {
  std::vector<std::string> names;
  for (const MatArray& cell : a.cells) {
    if (cell.text.empty()) return {};
    names.push_back(cell.text);
  }
  return names;
}

/// The variable called "P" where several hold matrices.
std::vector<Rows> choose_matrices(const std::vector<MatArray>& variables, const fs::path& file) {
  std::vector<Rows> chosen;
  std::string found;
  for (const MatArray& variable : variables) {
    std::vector<Rows> matrices = matrices_of(variable);
    if (matrices.empty()) continue;
    found += (found.empty() ? "" : ", ") + variable.name;
    if (chosen.empty() || variable.name == "P") chosen = std::move(matrices);
    if (variable.name == "P") return chosen;
  }
  if (chosen.empty())
    throw Error(concat(file.string(),
                       ": no variable is a 3 x 4 x N array or a cell array of 3 x 4 "
                       "matrices"));
  if (found.find(',') != std::string::npos)
    throw Error(concat(file.string(), ": several variables hold matrices (", found,
                       "); call the right one P"));
  return chosen;
}

std::vector<std::string> choose_names(const std::vector<MatArray>& variables, std::size_t count,
                                      const RawScene& scene) {
  for (const MatArray& variable : variables) {
    std::vector<std::string> names = names_of(variable);
    if (names.size() == count) return names;
  }
  std::size_t most = 0;
  for (const fs::path& folder : scene.image_folders) {
    std::vector<std::string> names;
    for (const fs::path& image : images_in(folder)) names.push_back(image.filename().string());
    if (names.size() == count) return names;
    most = std::max(most, names.size());
  }
  throw Error(concat(scene.file.string(), ": holds ", count, " matrices, but ", most,
                     " images lie beside it; add a cell array of their names"));
}

}  // namespace

fs::path find_matlab(const fs::path& folder) { return only_file_ending(folder, ".mat"); }

bool is_matlab(const fs::path& file) { return file.extension() == ".mat"; }

RawScene read_matlab(const fs::path& file, const fs::path& images) {
  RawScene scene;
  scene.format = SceneFormat::kMatlab;
  scene.file = file;
  const fs::path folder = folder_of(file);
  scene.image_folders = {folder, folder / "images", folder / ".." / "images"};
  if (!images.empty()) scene.image_folders = {images};
  const std::vector<MatArray> variables = read_mat_file(file);
  const std::vector<Rows> matrices = choose_matrices(variables, file);
  const std::vector<std::string> names = choose_names(variables, matrices.size(), scene);
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    RawView view;
    view.listed = names[i];
    view.where = concat(file.string(), " matrix ", i + 1);
    view.camera = camera_of_projection(matrices[i], view.where);
    scene.views.push_back(std::move(view));
  }
  return scene;
}

void write_matlab(const Scene& scene, const fs::path& folder) {
  make_folder(folder);
  MatArray matrices{"P", {3, 4, scene.views.size()}, {}, {}, {}};
  MatArray names{"names", {1, scene.views.size()}, {}, {}, {}};
  for (const SourceView& view : scene.views) {
    require_pinhole(view, "a projection matrix");
    const Rows rows = projection_rows(view.camera, 0);
    for (int i = 0; i < 12; ++i) matrices.values.push_back(rows[i % 3 * 4 + i / 3]);
    const std::string name = listed_name(view, folder, {".", "images"});
    names.cells.push_back({"", {1, name.size()}, {}, name, {}});
  }
  const MatArray variables[] = {matrices, names};
  write_atomically(folder / "projections.mat", mat_file_bytes(variables));
  write_bbox_file(scene, folder);
}

}  // namespace photohull::io
