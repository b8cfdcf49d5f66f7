#include "pose_arrays.h"

#include <cstdio>
#include <filesystem>
#include <vector>

#include "arrays.h"
#include "core/error.h"
#include "io/image_file.h"

namespace photohull::python {
namespace py = pybind11;
namespace {

namespace fs = std::filesystem;

/// A list of its own, which nobody changes.
py::list list_of(const py::object& items) {
  return py::module_::import("builtins").attr("list")(items);
}

std::string photograph_word(std::size_t index) { return concat("photographs[", index, "]"); }

/// Its file holds what the array does, which eight bits allow.
ColourImage photograph_of(const py::handle& value, std::size_t index) {
  if (is_path(value))
    throw UsageError(photograph_word(index) +
                     " is a path, and others are arrays: give either files or arrays");
  ColourImage image = image_of(value, photograph_word(index));
  if (image.encoding != ColourImage::Encoding::kSrgb8)
    throw UsageError(photograph_word(index) +
                     " is not of the type uint8: give it as uint8 (sRGB), or as a file");
  return image;
}

void write_photograph(const fs::path& file, const ColourImage& image) {
  if (image.has_alpha) return io::write_png(file, image.width, image.height, 4, image.bytes);
  std::vector<std::uint8_t> rgb;
  rgb.reserve(image.bytes.size() / 4 * 3);
  for (std::size_t i = 0; i < image.bytes.size(); i += 4)
    rgb.insert(rgb.end(), &image.bytes[i], &image.bytes[i] + 3);
  io::write_png(file, image.width, image.height, 3, rgb);
}

}  // namespace

bool is_path(const py::handle& value) {
  return py::isinstance<py::str>(value) || py::isinstance<py::bytes>(value) ||
         py::hasattr(value, "__fspath__");
}

bool are_arrays(const py::object& photographs) {
  if (py::hasattr(photographs, "ndim")) return true;
  if (!py::isinstance<py::list>(photographs) && !py::isinstance<py::tuple>(photographs))
    return false;
  for (const py::handle one : photographs)
    if (!is_path(one)) return true;
  return false;
}

PosedArrays::PosedArrays(const py::object& photographs, const py::object& masks)
    : photographs_(list_of(photographs)) {
  if (py::hasattr(photographs, "ndim") && photographs.attr("ndim").cast<int>() != 4)
    throw UsageError(
        "photographs is one array: give a list of photographs, or an array (photographs, height, "
        "width, channels)");
  if (photographs_.empty()) throw UsageError("photographs: give at least one, or a folder of them");
  if (!masks.is_none()) {
    if (is_path(masks))
      throw UsageError("masks: expected a list of arrays, as the photographs are arrays");
    masks_ = list_of(masks);
    if (masks_.size() != photographs_.size())
      throw UsageError(concat("masks has ", masks_.size(), " entries for ", photographs_.size(),
                              " photographs: give one for each"));
  }
  for (std::size_t i = 0; i < photographs_.size(); ++i) {
    const ColourImage image = photograph_of(photographs_[i], i);
    if (masks_.empty()) continue;
    const Mask mask = mask_of(masks_[i], concat("masks[", i, "]"));
    if (!mask.empty() && (mask.width != image.width || mask.height != image.height))
      throw UsageError(concat("masks[", i, "] is ", mask.width, " x ", mask.height,
                              " pixels, but its photograph is ", image.width, " x ", image.height));
  }
}

void PosedArrays::write(pose::PoseJob& job, Progress& progress) const {
  progress.stage("arrays", kArraysWeight);
  const fs::path folder = job.out / "arrays";
  pose::make_scene_folder(folder);
  if (!masks_.empty()) pose::make_scene_folder(job.masks = job.out / "masks");
  for (std::size_t i = 0; i < photographs_.size(); ++i) {
    progress.check_cancelled();
    progress.update(double(i) / double(photographs_.size()));
    ColourImage image;
    Mask mask;
    {
      const py::gil_scoped_acquire hold;
      image = photograph_of(photographs_[i], i);
      if (!masks_.empty()) mask = mask_of(masks_[i], concat("masks[", i, "]"));
    }
    char name[32];
    std::snprintf(name, sizeof name, "%04zu.png", i);
    job.images.push_back(folder / name);
    write_photograph(folder / name, image);
    if (!mask.empty()) io::write_png(job.masks / name, mask.width, mask.height, 1, mask.coverage);
  }
}

}  // namespace photohull::python
