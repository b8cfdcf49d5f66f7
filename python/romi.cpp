#include "romi.h"

#include <pybind11/numpy.h>

#include "arrays.h"
#include "carving/back_projection.h"
#include "core/error.h"

namespace photohull::python {
namespace py = pybind11;
namespace {

template <typename Element>
using Exact = py::array_t<Element, py::array::c_style>;

carving::DenseLattice lattice_of(const py::handle& shape, const py::handle& origin,
                                 double voxel_size) {
  const py::array_t<double> n = numbers_of(shape, {{3}}, "shape"),
                            o = numbers_of(origin, {{3}}, "origin");
  for (int axis = 0; axis < 3; ++axis)
    if (!(n.at(axis) >= 1 && n.at(axis) < 1 << 20 && n.at(axis) == std::int64_t(n.at(axis))))
      throw UsageError(
          concat("shape holds ", n.at(axis), ": expected whole numbers of voxels, at least 1"));
  if (!(voxel_size > 0 && std::isfinite(voxel_size)))
    throw UsageError(concat("voxel_size=", voxel_size, ": must be finite and positive"));
  return {{int(n.at(0)), int(n.at(1)), int(n.at(2))}, {o.at(0), o.at(1), o.at(2)}, voxel_size};
}

carving::TruncatingCamera camera_of(const py::handle& intrinsics, const py::handle& rotation,
                                    const py::handle& translation) {
  const py::array_t<double> k = numbers_of(intrinsics, {{4}, {3, 3}}, "intrinsics"),
                            r = numbers_of(rotation, {{3, 3}, {9}}, "rot"),
                            t = numbers_of(translation, {{3}, {3, 1}}, "tvec");
  const double *a = k.data(), *v = r.data();
  carving::TruncatingCamera camera;
  if (k.ndim() == 1) {
    camera.fx = a[0], camera.fy = a[1], camera.cx = a[2], camera.cy = a[3];
  } else {
    if (a[1] != 0 || a[3] != 0 || a[6] != 0 || a[7] != 0 || a[8] != 1)
      throw UsageError("intrinsics: K must be [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]");
    camera.fx = a[0], camera.fy = a[4], camera.cx = a[2], camera.cy = a[5];
  }
  camera.rotation =
      glm::transpose(glm::dmat3(v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8]));
  camera.translation = {t.data()[0], t.data()[1], t.data()[2]};
  return camera;
}

/// The lattice, and what carving knows of its blocks. Arrays of voxels are Python's.
class BackProjector {
 public:
  BackProjector(const py::handle& shape, const py::handle& origin, double voxel_size)
      : lattice_(lattice_of(shape, origin, voxel_size)) {
    clear();
  }
  void clear() { blocks_ = carving::carving_blocks(lattice_); }

  void carve(const py::handle& k, const py::handle& r, const py::handle& t,
             const Exact<std::uint8_t>& mask, Exact<std::int32_t>& labels) {
    const carving::TruncatingCamera camera = camera_of(k, r, t);
    const carving::PixelView<std::uint8_t> pixels{
        {mask.data(), std::size_t(mask.size())}, int(mask.shape(1)), int(mask.shape(0))};
    const std::span values(labels.mutable_data(), std::size_t(labels.size()));
    const py::gil_scoped_release free;
    carving::carve_dense(lattice_, camera, pixels, values, blocks_);
  }
  void add(const py::handle& k, const py::handle& r, const py::handle& t, const Exact<float>& image,
           Exact<float>& sums) const {
    const carving::TruncatingCamera camera = camera_of(k, r, t);
    const carving::PixelView<float> pixels{
        {image.data(), std::size_t(image.size())}, int(image.shape(1)), int(image.shape(0))};
    const std::span values(sums.mutable_data(), std::size_t(sums.size()));
    const py::gil_scoped_release free;
    carving::add_dense(lattice_, camera, pixels, values);
  }

 private:
  carving::DenseLattice lattice_;
  std::vector<std::uint8_t> blocks_;
};

}  // namespace

void bind_romi(py::module_& module) {
  py::class_<BackProjector>(module, "BackProjector")
      .def(py::init<py::handle, py::handle, double>())
      .def("clear", &BackProjector::clear)
      .def("carve", &BackProjector::carve)
      .def("add", &BackProjector::add);
}

}  // namespace photohull::python
