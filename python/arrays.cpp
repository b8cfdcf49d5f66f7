#include "arrays.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <sstream>

#include "core/error.h"

namespace photohull::python {
namespace py = pybind11;
namespace {

constexpr float kLargestHalf = 65504;

std::string shape_text(const py::array& array) {
  std::ostringstream out;
  out << "(";
  for (py::ssize_t i = 0; i < array.ndim(); ++i) out << (i ? ", " : "") << array.shape(i);
  out << (array.ndim() == 1 ? ",)" : ")");
  return out.str();
}

std::string type_text(const py::array& array) { return py::str(array.dtype()); }

/// The value as an array, whatever it is; arrays are not copied.
py::array array_of(const py::handle& value, const std::string& where) {
  py::array array = py::array::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw UsageError(where + ": expected a NumPy array");
  }
  return array;
}

template <typename T>
bool has_type(const py::array& array) {
  return py::isinstance<py::array_t<T>>(array);
}

/// In the order of C, copied where it is not.
template <typename T>
py::array_t<T, py::array::c_style | py::array::forcecast> in_order(const py::array& array) {
  return py::array_t<T, py::array::c_style | py::array::forcecast>(array);
}

struct Layout {
  int width = 0, height = 0, channels = 1;
  std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
};

Layout layout_of(const py::array& array, const std::string& where) {
  const bool flat = array.ndim() == 2;
  const py::ssize_t channels = flat ? 1 : array.ndim() == 3 ? array.shape(2) : 0;
  if ((channels != 1 && channels != 3 && channels != 4) || array.shape(0) == 0 ||
      array.shape(1) == 0)
    throw UsageError(concat(where, " has the shape ", shape_text(array),
                            ": expected (height, width), or (height, width, channels) with 1, 3 "
                            "or 4 channels"));
  return {int(array.shape(1)), int(array.shape(0)), int(channels)};
}

/// Calls put(pixel, r, g, b, a) with the values of each pixel; `opaque` is the alpha of none.
template <typename T, typename Put>
void for_pixels(const T* in, const Layout& layout, T opaque, const Put& put) {
  const int c = layout.channels;
  for (std::size_t i = 0; i < layout.pixels(); ++i, in += c) {
    const T alpha = c == 4 ? in[3] : opaque;
    put(i, in[0], in[c > 1 ? 1 : 0], in[c > 1 ? 2 : 0], alpha);
  }
}

void put_bytes(const py::array& array, const Layout& layout, ColourImage& image) {
  const auto values = in_order<std::uint8_t>(array);
  image.bytes.resize(layout.pixels() * 4);
  std::uint8_t* out = image.bytes.data();
  for_pixels<std::uint8_t>(values.data(), layout, 255,
                           [&](std::size_t i, auto r, auto g, auto b, auto a) {
                             const std::uint8_t pixel[4] = {r, g, b, a};
                             std::memcpy(out + 4 * i, pixel, 4);
                           });
}

/// `linear` gives linear light of a colour's value, `share` the alpha of one, both as floats.
template <typename T, typename Linear, typename Share>
void put_halves(const py::array& array, const Layout& layout, T opaque, const Linear& linear,
                const Share& share, ColourImage& image) {
  const auto values = in_order<T>(array);
  image.encoding = ColourImage::Encoding::kLinearHalf;
  image.bytes.resize(layout.pixels() * 8);
  std::uint8_t* out = image.bytes.data();
  for_pixels<T>(values.data(), layout, opaque, [&](std::size_t i, T r, T g, T b, T a) {
    const std::uint16_t pixel[4] = {glm::packHalf1x16(linear(r)), glm::packHalf1x16(linear(g)),
                                    glm::packHalf1x16(linear(b)), glm::packHalf1x16(share(a))};
    std::memcpy(out + 8 * i, pixel, 8);
  });
}

void check_finite(const py::array_t<double>& values, const std::string& where) {
  for (py::ssize_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values.data()[i]))
      throw UsageError(where + " holds a value that is not a finite number");
}

bool fits(const py::array& array, const std::vector<int>& shape) {
  if (array.ndim() != py::ssize_t(shape.size())) return false;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (shape[i] >= 0 && array.shape(py::ssize_t(i)) != shape[i]) return false;
  return true;
}

std::string shapes_text(const std::vector<std::vector<int>>& shapes) {
  std::string text;
  for (const std::vector<int>& shape : shapes) {
    text += text.empty() ? "(" : " or (";
    for (std::size_t i = 0; i < shape.size(); ++i)
      text += (i ? ", " : "") + (shape[i] < 0 ? std::string("N") : std::to_string(shape[i]));
    text += shape.size() == 1 ? ",)" : ")";
  }
  return text;
}

std::uint8_t coverage_of(double share, const std::string& where) {
  if (!(share >= 0 && share <= 1))
    throw UsageError(concat(where, " holds ", share,
                            ": a mask of floating-point numbers has values from 0 to 1"));
  return std::uint8_t(std::lround(255 * share));
}

/// A mask whose values are 0 and 1 is one of truth values, and 1 would be almost nothing.
void check_range(const py::array& array, const Mask& mask, const std::string& where) {
  if (!mask.coverage.empty() && std::ranges::max(mask.coverage) == 1)
    throw UsageError(concat(where, " has values of 0 and 1 only, of the type ", type_text(array),
                            ": give bool, or 0 to 255"));
}

}  // namespace

ColourImage image_of(const py::handle& value, const std::string& where) {
  const py::array array = array_of(value, where);
  const Layout layout = layout_of(array, where);
  ColourImage image;
  image.width = layout.width;
  image.height = layout.height;
  image.has_alpha = layout.channels == 4;
  if (has_type<std::uint8_t>(array)) {
    put_bytes(array, layout, image);
  } else if (has_type<std::uint16_t>(array)) {
    const auto share = [](std::uint16_t v) { return float(v / 65535.0); };
    const auto linear = [](std::uint16_t v) { return float(linear_from_srgb(v / 65535.0)); };
    put_halves<std::uint16_t>(array, layout, 65535, linear, share, image);
  } else if (has_type<float>(array) || has_type<double>(array)) {
    check_finite(py::array_t<double>(array), where);
    const auto share = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
    const auto linear = [](float v) { return std::clamp(v, -kLargestHalf, kLargestHalf); };
    put_halves<float>(array, layout, 1, linear, share, image);
  } else {
    throw UsageError(concat(where, " is of the type ", type_text(array),
                            ": expected uint8 or uint16 (sRGB), or float32 or float64 (linear)"));
  }
  return image;
}

Mask mask_of(const py::handle& value, const std::string& where) {
  if (value.is_none()) return {};
  const py::array array = array_of(value, where);
  if (array.ndim() != 2 || array.size() == 0)
    throw UsageError(
        concat(where, " has the shape ", shape_text(array), ": expected (height, width)"));
  Mask mask{int(array.shape(1)), int(array.shape(0)), {}};
  mask.coverage.resize(std::size_t(array.size()));
  if (has_type<bool>(array)) {
    const auto values = in_order<bool>(array);
    std::transform(values.data(), values.data() + values.size(), mask.coverage.begin(),
                   [](bool v) { return v ? 255 : 0; });
  } else if (has_type<std::uint8_t>(array)) {
    const auto values = in_order<std::uint8_t>(array);
    std::copy(values.data(), values.data() + values.size(), mask.coverage.begin());
    check_range(array, mask, where);
  } else if (has_type<float>(array) || has_type<double>(array)) {
    const auto values = in_order<double>(array);
    std::transform(values.data(), values.data() + values.size(), mask.coverage.begin(),
                   [&](double v) { return coverage_of(v, where); });
  } else {
    throw UsageError(concat(where, " is of the type ", type_text(array),
                            ": expected bool, uint8 (0 to 255), or float32 or float64 (0 to 1)"));
  }
  return mask;
}

py::array_t<double> numbers_of(const py::handle& value, const std::vector<std::vector<int>>& shapes,
                               const std::string& where) {
  const py::array array = array_of(value, where);
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u')
    throw UsageError(concat(where, " is of the type ", type_text(array), ": expected numbers"));
  if (std::ranges::none_of(shapes, [&](const auto& shape) { return fits(array, shape); }))
    throw UsageError(
        concat(where, " has the shape ", shape_text(array), ": expected ", shapes_text(shapes)));
  const py::array_t<double> numbers = in_order<double>(array);
  check_finite(numbers, where);
  return numbers;
}

Box box_of(const py::handle& value, const std::string& where) {
  const py::array_t<double> n = numbers_of(value, {{2, 3}, {6}}, where);
  const double* v = n.data();
  Box box{{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
  if (!glm::all(glm::lessThan(box.min, box.max)))
    throw UsageError(where + ": the first corner must be below the second along every axis");
  return box;
}

py::array_t<std::uint8_t> bytes_array(const std::vector<std::uint8_t>& bytes, int width, int height,
                                      int channels) {
  std::vector<py::ssize_t> shape = {height, width};
  if (channels > 1) shape.push_back(channels);
  return py::array_t<std::uint8_t>(shape, bytes.data());
}

py::array_t<double> matrix_array(const glm::dmat3& matrix) {
  py::array_t<double> out({3, 3});
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.mutable_at(row, column) = matrix[column][row];
  return out;
}

py::array_t<double> vector_array(const glm::dvec3& v) { return py::array_t<double>(3, &v.x); }

py::array_t<double> box_array(const Box& box) {
  py::array_t<double> out({2, 3});
  for (int axis = 0; axis < 3; ++axis) {
    out.mutable_at(0, axis) = box.min[axis];
    out.mutable_at(1, axis) = box.max[axis];
  }
  return out;
}

}  // namespace photohull::python
