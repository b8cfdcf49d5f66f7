#include "tools.h"

#include <pybind11/stl.h>

#include "arrays.h"
#include "core/error.h"
#include "eval/evaluate.h"
#include "eval/evaluation_json.h"
#include "eval/truth.h"
#include "gpu/device.h"
#include "io/mesh/read_mesh.h"
#include "job.h"
#include "options.h"
#include "pipeline/mask_policy.h"
#include "scene.h"
#include "synth/synthesize.h"
#include "views/prepare_views.h"

namespace photohull::python {
namespace py = pybind11;
namespace {

py::object parsed(const std::string& json) {
  return py::module_::import("json").attr("loads")(json);
}

/// (name, mask or None, source, confidence) of each view.
py::list masks(const Scene& scene, const py::dict& given, const py::object& progress) {
  const pipeline::Photographs& photographs = scene.photographs;
  PrepareOptions options;
  Described described;
  describe(described, options);
  set_options(described, given, "photohull.masks");
  options.masks = pipeline::mask_policy(photographs.load.masks);
  options.strict = photographs.load.strict;
  Scene read = scene;
  const ViewLoader loader{
      [&](const std::filesystem::path& path) { return photographs.reader.image(path, 1); },
      [&](const std::filesystem::path& path) {
        return photographs.reader.mask(path, glm::dvec2(1));
      }};
  PreparedViews prepared;
  run_job(progress, 1, [&](Progress& to) {
    to.stage("masks", 1);
    prepared = prepare_views(read.photographs.scene, loader, options, to);
    for (const std::string& warning : prepared.warnings) to.warn(warning);
  });
  py::list list;
  for (std::size_t i = 0; i < prepared.views.size(); ++i) {
    const Mask& mask = prepared.views[i].mask;
    const py::object array =
        mask.empty() ? py::object(py::none())
                     : py::object(bytes_array(mask.coverage, mask.width, mask.height, 1));
    list.append(py::make_tuple(prepared.views[i].name, array, prepared.masks[i].source,
                               prepared.masks[i].confidence));
  }
  return list;
}

/// A file, or a pair of arrays: vertices (N, 3) and faces (M, 3).
TriMesh mesh_of(const py::object& value, const std::string& where) {
  if (!py::isinstance<py::tuple>(value)) {
    const std::string path = path_of(value);
    const py::gil_scoped_release free;
    return read_mesh(path, Faces::kOptional);
  }
  const py::tuple pair = value;
  if (pair.size() != 2) throw UsageError(where + ": expected a file, or (vertices, faces)");
  const auto vertices = numbers_of(pair[0], {{-1, 3}}, where + ": vertices");
  const auto faces = numbers_of(pair[1], {{-1, 3}}, where + ": faces");
  TriMesh mesh;
  const double* v = vertices.data();
  if (vertices.shape(0) > 0) mesh.origin = {v[0], v[1], v[2]};
  for (py::ssize_t i = 0; i < vertices.shape(0); ++i, v += 3)
    mesh.positions.emplace_back(glm::dvec3(v[0], v[1], v[2]) - mesh.origin);
  const double* f = faces.data();
  for (py::ssize_t i = 0; i < faces.shape(0); ++i, f += 3) {
    for (int c = 0; c < 3; ++c)
      if (!(f[c] >= 0 && f[c] < double(vertices.shape(0))))
        throw UsageError(
            concat(where, ": face ", i, " names the vertex ", f[c], " of ", vertices.shape(0)));
    mesh.triangles.push_back({std::uint32_t(f[0]), std::uint32_t(f[1]), std::uint32_t(f[2])});
  }
  return mesh;
}

eval::Truth truth_of(const py::object& value) {
  if (py::isinstance<py::tuple>(value)) return eval::Truth(mesh_of(value, "truth"));
  return eval::read_truth(path_of(value));
}

py::object evaluate(const py::object& mesh, const py::object& truth, const py::dict& given,
                    const py::object& progress) {
  eval::EvaluateOptions options;
  Described described;
  describe(described, options);
  set_options(described, given, "photohull.evaluate");
  options.validate();
  const TriMesh result = mesh_of(mesh, "mesh");
  const eval::Truth known = truth_of(truth);
  eval::Evaluation evaluation;
  run_job(progress, 12,
          [&](Progress& to) { evaluation = eval::evaluate(result, known, options, &to); });
  return parsed(eval::to_json(evaluation));
}

/// `spec` is JSON, relative paths in it are of `base`.
py::dict synthesize(const std::string& spec_text, const py::object& base, const py::object& folder,
                    const std::string& device, int threads, const py::object& progress) {
  const synth::Spec spec = synth::parse_spec(spec_text, "spec", path_of(base));
  const std::string out = path_of(folder);
  synth::SynthesizedScene made;
  run_job(progress, synth::total_weight(spec),
          [&](Progress& to) { made = synth::synthesize(spec, out, to, device, threads); });
  py::dict result;
  result["views"] = made.views;
  result["triangles"] = made.triangles;
  result["diagonal"] = made.diagonal;
  result["seen"] = made.seen;
  result["largest_fill"] = made.largest_fill;
  return result;
}

py::list devices() {
  std::vector<gpu::DeviceInfo> found;
  {
    const py::gil_scoped_release free;
    found = gpu::list_devices();
  }
  py::list list;
  for (const gpu::DeviceInfo& d : found) {
    py::dict entry;
    entry["index"] = d.index;
    entry["renderer"] = d.renderer;
    entry["vendor"] = d.vendor;
    entry["version"] = d.version;
    entry["software"] = d.software;
    entry["problem"] = d.problem;
    list.append(entry);
  }
  return list;
}

template <typename Options>
py::list options_of() {
  Options options;
  Described described;
  describe(described, options);
  return option_list(described);
}

}  // namespace

void bind_tools(py::module_& module) {
  module.def("masks", masks);
  module.def("mask_options", options_of<PrepareOptions>);
  module.def("evaluate", evaluate);
  module.def("evaluate_options", options_of<eval::EvaluateOptions>);
  module.def("synthesize", synthesize);
  module.def("devices", devices);
}

}  // namespace photohull::python
