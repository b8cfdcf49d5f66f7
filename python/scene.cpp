#include "scene.h"

#include <pybind11/stl.h>

#include "arrays.h"
#include "core/error.h"
#include "io/matrix_camera.h"
#include "options.h"

namespace photohull::python {
namespace py = pybind11;
namespace {

Scene load(const py::object& path, const py::dict& options) {
  Scene scene;
  Described described;
  describe_scene(described, scene);
  set_options(described, options, "photohull.load");
  scene.box.validate();
  scene.photographs.load.validate();
  scene.photographs.load.most_views = io::kEnoughViews;
  const std::string file = path_of(path);
  const py::gil_scoped_release free;
  scene.photographs = pipeline::load_photographs(file, scene.photographs.load);
  return scene;
}

/// The matrices of each view: one for all, or one each.
class ViewNumbers {
 public:
  ViewNumbers(const py::handle& value, std::vector<int> shape, std::size_t views,
              const std::string& name)
      : size_(1) {
    for (const int length : shape) size_ *= std::size_t(length);
    std::vector<int> each = shape;
    each.insert(each.begin(), int(views));
    std::vector<std::vector<int>> shapes = {each, shape};
    if (name == "t") shapes.push_back({int(views), 3, 1});
    numbers_ = numbers_of(value, shapes, name);
    one_ = numbers_.ndim() == py::ssize_t(shape.size());
  }
  const double* of(std::size_t view) const { return numbers_.data() + (one_ ? 0 : view * size_); }

 private:
  py::array_t<double> numbers_;
  std::size_t size_;
  bool one_ = false;
};

glm::dmat3 from_rows(const double* v) {
  return glm::transpose(glm::dmat3(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]));
}

/// Of one lens for all views, (N,), or one each, (views, N); OpenCV's order.
std::vector<Distortion> distortions_of(const py::object& value, std::size_t views) {
  std::vector<Distortion> out(views);
  if (value.is_none()) return out;
  const py::array_t<double> all = numbers_of(value, {{-1}, {int(views), -1}}, "distortion");
  const std::size_t count = std::size_t(all.shape(all.ndim() - 1));
  if (count != 4 && count != 5 && count != 8)
    throw UsageError(concat("distortion has ", count,
                            " coefficients: expected 4, 5 or 8 in OpenCV's order (k1, k2, p1, p2, "
                            "k3, k4, k5, k6)"));
  for (std::size_t v = 0; v < views; ++v) {
    out[v].model = DistortionModel::kBrown;
    const double* row = all.data() + (all.ndim() == 2 ? v * count : 0);
    std::copy(row, row + count, out[v].coefficients.begin());
  }
  return out;
}

void check_count(std::size_t count, std::size_t views, const char* name) {
  if (count != views)
    throw UsageError(
        concat(name, " has ", count, " entries for ", views, " images: give one for each"));
}

struct ArrayViews {
  py::sequence images;
  py::object k, r, t, masks, names, distortion;
};

std::vector<pipeline::MemoryPhotograph> photographs_of(const ArrayViews& a) {
  const std::size_t views = a.images.size();
  if (views == 0) throw UsageError("images is empty: give a list of arrays");
  const ViewNumbers k(a.k, {3, 3}, views, "K"), r(a.r, {3, 3}, views, "R"), t(a.t, {3}, views, "t");
  const std::vector<Distortion> distortions = distortions_of(a.distortion, views);
  std::vector<std::string> names;
  if (!a.names.is_none()) {
    names = a.names.cast<std::vector<std::string>>();
    check_count(names.size(), views, "names");
  }
  if (!a.masks.is_none()) check_count(py::len(a.masks), views, "masks");
  std::vector<pipeline::MemoryPhotograph> out;
  for (std::size_t v = 0; v < views; ++v) {
    const std::string where = concat("images[", v, "]");
    pipeline::MemoryPhotograph p;
    char number[24];
    std::snprintf(number, sizeof number, "%04zu", v);
    p.name = names.empty() ? number : names[v];
    p.image = image_of(a.images[v], where);
    p.distortion = distortions[v];
    const double* move = t.of(v);
    p.camera = io::camera_of_matrices(
        {from_rows(k.of(v)), from_rows(r.of(v)), {move[0], move[1], move[2]}}, p.distortion,
        {p.image.width, p.image.height}, concat("the camera of ", where));
    if (!a.masks.is_none())
      p.mask = mask_of(py::object(a.masks[py::int_(v)]), concat("masks[", v, "]"));
    out.push_back(std::move(p));
  }
  return out;
}

Scene scene_of_arrays(const ArrayViews& arrays, const py::object& box, const py::dict& options) {
  Scene scene;
  Described described;
  std::optional<Box> none;
  describe(described, scene.box, none);
  set_options(described, options, "photohull.scene");
  std::optional<Box> given;
  if (!box.is_none()) given = box_of(box, "box");
  std::vector<pipeline::MemoryPhotograph> photographs = photographs_of(arrays);
  const py::gil_scoped_release free;
  scene.photographs = pipeline::photographs_in_memory(std::move(photographs), given);
  return scene;
}

const SourceView& view_at(const Scene& scene, int index) {
  const auto& views = scene.photographs.scene.views;
  if (index < 0 || std::size_t(index) >= views.size())
    throw py::index_error(
        concat("view ", index, ": the scene has ", views.size(), " views, counted from 0"));
  return views[std::size_t(index)];
}

/// uint8 sRGB, or float32 linear light where the file has more than 8 bits.
py::array image_at(const Scene& scene, int index) {
  const SourceView& view = view_at(scene, index);
  ColourImage image;
  {
    const py::gil_scoped_release free;
    image = scene.photographs.reader.image(view.image, 1);
  }
  if (image.encoding == ColourImage::Encoding::kSrgb8)
    return bytes_array(image.bytes, image.width, image.height,
                       4)[py::make_tuple(py::ellipsis(), py::slice(0, image.has_alpha ? 4 : 3, 1))];
  py::array_t<float> out({image.height, image.width, image.has_alpha ? 4 : 3});
  auto values = out.mutable_unchecked<3>();
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::vec4 pixel = image.linear(x, y);
      for (int c = 0; c < values.shape(2); ++c) values(y, x, c) = pixel[c];
    }
  return out;
}

py::object mask_at(const Scene& scene, int index) {
  const SourceView& view = view_at(scene, index);
  if (view.mask.empty()) return py::none();
  const Mask mask = scene.photographs.reader.mask(view.mask, glm::dvec2(1));
  return bytes_array(mask.coverage, mask.width, mask.height, 1);
}

template <typename Value>
py::list for_views(const Scene& scene, const Value& value) {
  py::list list;
  for (const SourceView& view : scene.photographs.scene.views) list.append(value(view));
  return list;
}

py::array intrinsics_of(const SourceView& view) { return matrix_array(view.camera.intrinsics.k()); }
py::array rotation_of(const SourceView& view) {
  return matrix_array(view.camera.cam_from_world.rotation);
}
py::array translation_of(const SourceView& view) {
  return vector_array(view.camera.cam_from_world.translation);
}

py::object box_of_scene(const Scene& scene) {
  const auto& box = scene.photographs.scene.box;
  return box ? py::object(box_array(*box)) : py::none();
}

}  // namespace

void describe_scene(Described& to, Scene& scene) {
  io::describe_views(to, scene.photographs.load);
  describe(to, scene.box, scene.photographs.load.box);
  io::describe_reading(to, scene.photographs.load);
}

void bind_scene(py::module_& module) {
  py::class_<Scene>(module, "Scene",
                    "Photographs with their cameras; made by photohull.load and photohull.scene.")
      .def("__len__", [](const Scene& s) { return s.photographs.scene.views.size(); })
      .def("__repr__",
           [](const Scene& s) {
             return concat("<photohull.Scene of ", s.photographs.scene.views.size(), " views from ",
                           s.photographs.scene.path.string(), ">");
           })
      .def_property_readonly(
          "names", [](const Scene& s) { return for_views(s, [](auto& v) { return v.name; }); },
          "Of the views, in their order.")
      .def_property_readonly(
          "K", [](const Scene& s) { return for_views(s, intrinsics_of); },
          "A (3, 3) float64 camera matrix a view, in pixels; the top-left pixel's centre is (0, "
          "0).")
      .def_property_readonly(
          "R", [](const Scene& s) { return for_views(s, rotation_of); },
          "A (3, 3) float64 rotation a view: x_camera = R @ x_world + t.")
      .def_property_readonly(
          "t", [](const Scene& s) { return for_views(s, translation_of); },
          "A (3,) float64 translation a view: x_camera = R @ x_world + t.")
      .def_property_readonly("box", box_of_scene,
                             "The region of interest, (2, 3) float64, world units, least corner "
                             "first; None: to be found.")
      .def_property_readonly(
          "warnings", [](const Scene& s) { return s.photographs.scene.warnings; },
          "What is to be known of how the scene was read; sentences.")
      .def("image", image_at, py::arg("view"),
           "A view's photograph with its lens distortion: (height, width, 3 or 4) uint8 sRGB, or "
           "float32 linear light where the file has more than 8 bits.")
      .def(
          "mask", mask_at, py::arg("view"),
          "A view's mask as it was given: (height, width) uint8, 255 object; None: there is none.");
  module.def("load", load);
  module.def("scene",
             [](const py::sequence& images, const py::object& k, const py::object& r,
                const py::object& t, const py::object& masks, const py::object& names,
                const py::object& distortion, const py::object& box, const py::dict& options) {
               return scene_of_arrays({images, k, r, t, masks, names, distortion}, box, options);
             });
  module.def("load_options", [] {
    Scene scene;
    Described described;
    describe_scene(described, scene);
    return option_list(described);
  });
}

}  // namespace photohull::python
