#include "result.h"

#include <pybind11/stl.h>

#include "arrays.h"
#include "core/error.h"
#include "job.h"
#include "options.h"
#include "pipeline/stage_weights.h"
#include "pipeline/write_results.h"
#include "scene.h"
#include "volume/write_vdb.h"

namespace photohull::python {
namespace py = pybind11;
namespace {

/// Of a result, which lives as long as any of its arrays.
struct Mesh {
  std::shared_ptr<Result> result;
  const TriMesh& mesh() const { return result->made.mesh; }
};
struct Volume {
  std::shared_ptr<Result> result;
  const SparseVolume& volume() const { return result->made.volume; }
};

template <typename Element, typename Vector>
py::object rows_of(const Mesh& mesh, const std::vector<Vector>& rows, const py::object& owner) {
  if (rows.empty() && !mesh.mesh().positions.empty()) return py::none();
  return view_of(reinterpret_cast<const Element*>(rows.data()),
                 {py::ssize_t(rows.size()), py::ssize_t(sizeof(Vector) / sizeof(Element))}, owner);
}

py::array_t<double> world_vertices(const Mesh& mesh) {
  const TriMesh& m = mesh.mesh();
  py::array_t<double> out({py::ssize_t(m.positions.size()), py::ssize_t(3)});
  double* to = out.mutable_data();
  for (std::size_t v = 0; v < m.positions.size(); ++v) {
    const glm::dvec3 p = m.world(v);
    to[3 * v] = p.x, to[3 * v + 1] = p.y, to[3 * v + 2] = p.z;
  }
  return out;
}

void fill_brick(const SparseVolume& volume, const glm::ivec3& brick, float* out) {
  const glm::ivec3 n = volume.grid.voxels();
  const std::uint32_t slot = volume.table[volume.grid.brick_index(brick)];
  const bool stored = slot != SparseVolume::kOutside && slot != SparseVolume::kInside;
  const float value = slot == SparseVolume::kInside ? -SparseVolume::kBand : SparseVolume::kBand;
  const glm::ivec3 low = brick * kBrickEdge;
  for (int x = 0; x < kBrickEdge; ++x)
    for (int y = 0; y < kBrickEdge; ++y) {
      float* row = out + (std::size_t(low.x + x) * n.y + low.y + y) * n.z + low.z;
      if (stored) {
        const float* from =
            volume.distance.data() + std::size_t(slot) * kBrickVoxels + voxel_offset({x, y, 0});
        std::copy(from, from + kBrickEdge, row);
      } else {
        std::fill(row, row + kBrickEdge, value);
      }
    }
}

py::array_t<float> dense(const Volume& v) {
  const SparseVolume& volume = v.volume();
  const glm::ivec3 n = volume.grid.voxels(), bricks = volume.grid.bricks;
  py::array_t<float> out({n.x, n.y, n.z});
  float* to = out.mutable_data();
  const py::gil_scoped_release free;
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x) fill_brick(volume, {x, y, z}, to);
  return out;
}

void save_vdb(const Volume& v, const py::object& path) {
  const std::string file = path_of(path);
  const pipeline::Reconstruction& made = v.result->made;
  const py::gil_scoped_release free;
  write_vdb(file, made.volume, made.attributes, {{"photohull_options", made.report.option_line}});
}

std::shared_ptr<Result> reconstruct(const Scene& scene, const py::dict& given,
                                    const py::object& progress) {
  auto result = std::make_shared<Result>();
  pipeline::ReconstructOptions& options = result->options;
  options.box = scene.box;
  io::LoadSceneOptions load;
  Described described;
  describe(described, options, load);
  set_options(described, given, "photohull.reconstruct");
  const pipeline::Reconstructor reconstructor(options);
  run_job(progress, pipeline::total_weight(options),
          [&](Progress& to) { result->made = reconstructor.run(scene.photographs, to); });
  return result;
}

std::vector<std::string> write(const Result& result, const py::object& folder,
                               const py::object& progress) {
  const std::string path = path_of(folder);
  pipeline::Report report;
  run_job(progress, pipeline::Weights::kFiles, [&](Progress& to) {
    report =
        pipeline::write(result.made, path, to, result.options.exports, result.options.mesh_files);
  });
  return report.files;
}

py::object report_of(const Result& result) {
  return py::module_::import("json").attr("loads")(result.made.report.to_json());
}

void bind_mesh(py::module_& module) {
  py::class_<Mesh>(module, "Mesh")
      .def("__repr__",
           [](const Mesh& m) {
             return concat("<photohull.Mesh of ", m.mesh().positions.size(), " vertices and ",
                           m.mesh().triangles.size(), " faces>");
           })
      .def("world_vertices", world_vertices)
      .def_property_readonly("positions",
                             [](const py::object& self) {
                               const Mesh& m = self.cast<const Mesh&>();
                               return rows_of<float>(m, m.mesh().positions, self);
                             })
      .def_property_readonly("origin", [](const Mesh& m) { return vector_array(m.mesh().origin); })
      .def_property_readonly("faces",
                             [](const py::object& self) {
                               const TriMesh& m = self.cast<const Mesh&>().mesh();
                               return view_of(
                                   reinterpret_cast<const std::uint32_t*>(m.triangles.data()),
                                   {py::ssize_t(m.triangles.size()), 3}, self);
                             })
      .def_property_readonly("normals",
                             [](const py::object& self) {
                               const Mesh& m = self.cast<const Mesh&>();
                               return rows_of<float>(m, m.mesh().normals, self);
                             })
      .def_property_readonly("colours",
                             [](const py::object& self) {
                               const Mesh& m = self.cast<const Mesh&>();
                               return rows_of<float>(m, m.mesh().colours, self);
                             })
      .def_property_readonly("confidence", [](const py::object& self) -> py::object {
        const TriMesh& m = self.cast<const Mesh&>().mesh();
        if (m.confidence.empty() && !m.positions.empty()) return py::none();
        return view_of(m.confidence.data(), {py::ssize_t(m.confidence.size())}, self);
      });
}

void bind_volume(py::module_& module) {
  py::class_<Volume>(module, "Volume")
      .def("__repr__",
           [](const Volume& v) {
             const glm::ivec3 n = v.volume().grid.voxels();
             return concat("<photohull.Volume of ", n.x, " x ", n.y, " x ", n.z, " voxels of ",
                           v.volume().grid.voxel_size, ">");
           })
      .def_property_readonly("shape",
                             [](const Volume& v) {
                               const glm::ivec3 n = v.volume().grid.voxels();
                               return py::make_tuple(n.x, n.y, n.z);
                             })
      .def_property_readonly("origin",
                             [](const Volume& v) { return vector_array(v.volume().grid.origin); })
      .def_property_readonly("voxel_size",
                             [](const Volume& v) { return v.volume().grid.voxel_size; })
      .def_property_readonly("inside_voxels",
                             [](const Volume& v) { return v.volume().inside_voxels(); })
      .def_property_readonly("bricks",
                             [](const py::object& self) {
                               const SparseVolume& v = self.cast<const Volume&>().volume();
                               return view_of(
                                   reinterpret_cast<const std::int32_t*>(v.bricks.data()),
                                   {py::ssize_t(v.bricks.size()), 3}, self);
                             })
      .def_property_readonly(
          "distances",
          [](const py::object& self) {
            const SparseVolume& v = self.cast<const Volume&>().volume();
            return view_of(v.distance.data(),
                           {py::ssize_t(v.bricks.size()), kBrickEdge, kBrickEdge, kBrickEdge},
                           self);
          })
      .def("dense", dense)
      .def("save_vdb", save_vdb, py::arg("path"));
}

}  // namespace

void bind_result(py::module_& module) {
  bind_mesh(module);
  bind_volume(module);
  py::class_<Result, std::shared_ptr<Result>>(module, "Result")
      .def("__repr__",
           [](const Result& r) {
             return concat("<photohull.Result, ",
                           assess::to_string(r.made.report.verdict.verdict.level), ", of ",
                           r.made.report.photographs.views, " views>");
           })
      .def_property_readonly("mesh", [](std::shared_ptr<Result> r) { return Mesh{std::move(r)}; })
      .def_property_readonly("volume",
                             [](std::shared_ptr<Result> r) { return Volume{std::move(r)}; })
      .def_property_readonly("report", report_of)
      .def_property_readonly(
          "verdict",
          [](const Result& r) { return assess::to_string(r.made.report.verdict.verdict.level); })
      .def_property_readonly("reasons",
                             [](const Result& r) { return r.made.report.verdict.verdict.reasons; })
      .def_property_readonly("up", [](const Result& r) { return vector_array(r.made.up); })
      .def_property_readonly(
          "preview",
          [](const std::shared_ptr<Result>& r) {
            const RgbImage& image = r->made.preview;
            return view_of(image.rgb.data(), {image.height, image.width, 3}, py::cast(r));
          })
      .def("_write", write);
  module.def("reconstruct", reconstruct);
  module.def("reconstruct_options", [] {
    pipeline::ReconstructOptions options;
    io::LoadSceneOptions load;
    Described described;
    describe(described, options, load);
    return option_list(described);
  });
}

}  // namespace photohull::python
