#include "io/usable_views.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/option_word.h"
#include "core/scaled_size.h"
#include "io/camera_checks.h"
#include "io/find_files.h"

namespace photohull::io {
namespace fs = std::filesystem;
namespace {

using Reason = LeftOutView::Reason;

/// Throws Error when two views share an image.
void reject_duplicates(const RawScene& raw, const std::vector<fs::path>& images) {
  std::map<fs::path, std::size_t> seen;
  for (std::size_t i = 0; i < raw.views.size(); ++i) {
    const fs::path& key =
        images[i].empty() ? fs::path(raw.views[i].listed).lexically_normal() : images[i];
    const auto [earlier, fresh] = seen.emplace(key, i);
    if (!fresh)
      throw Error(concat(raw.views[i].where, ": the image ", raw.views[i].listed,
                         " is listed twice (first in ", raw.views[earlier->second].where,
                         "); remove one"));
  }
}

std::vector<std::string> view_names(const RawScene& raw, const std::vector<fs::path>& images) {
  std::vector<std::string> names, paths;
  for (std::size_t i = 0; i < raw.views.size(); ++i) {
    const fs::path listed = fs::path(raw.views[i].listed).lexically_normal();
    const fs::path& named = images[i].empty() ? listed : images[i];
    names.push_back(named.filename().string());
    paths.push_back((listed.parent_path() / named.filename()).generic_string());
  }
  std::vector<std::string> sorted = names;
  std::sort(sorted.begin(), sorted.end());
  return std::adjacent_find(sorted.begin(), sorted.end()) == sorted.end() ? names : paths;
}

/// Where a photograph was looked for, or what kept from looking there.
std::string looked_in(const RawScene& raw, const std::string& listed) {
  std::string folders;
  for (const fs::path& folder : raw.image_folders) {
    std::error_code failure;
    const fs::path image = folder / listed;
    if (!fs::exists(image, failure) && failure == std::errc::permission_denied)
      return concat(folder_of(image).lexically_normal().string(),
                    " cannot be entered: ", failure.message(), "; check its permissions");
  }
  for (const fs::path& folder : raw.image_folders)
    folders += (folders.empty() ? "" : ", ") + (folder / "").lexically_normal().string();
  return concat("looked in ", folders, "; ", option_word("images"), " says where else they are");
}

/// What the decoder said, without the path that it opens with.
std::string without_path(const std::string& message, const fs::path& image) {
  const std::string prefix = image.string() + ": ";
  return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

/// Focal lengths from fields of view, where the file states those; needs the image's size.
void complete_focal_lengths(const RawView& raw, Intrinsics& k) {
  if (k.fx == 0 && raw.angle_x > 0) k.fx = 0.5 * k.width / std::tan(0.5 * raw.angle_x);
  if (k.fy == 0 && raw.angle_y > 0) k.fy = 0.5 * k.height / std::tan(0.5 * raw.angle_y);
  if (k.fx == 0) k.fx = k.fy;
  if (k.fy == 0) k.fy = k.fx;
}

std::string wrong_shape(const ImageSize& size, const Intrinsics& k) {
  const bool turned = (size.width == k.height && size.height == k.width) ||
                      is_scaled_copy(size.height, size.width, k.width, k.height);
  return concat("it is ", size.width, " x ", size.height, ", but its camera is for ", k.width,
                " x ", k.height,
                turned ? ", the sides are swapped: a program has probably turned it by its EXIF "
                         "orientation"
                       : "",
                size.orientation != 1
                    ? concat(", and its EXIF orientation tag is ", size.orientation,
                             size.orientation > 4
                                 ? ", which asks for swapped sides; pixels are read as they are "
                                   "stored: turn the pixels as the tag says and remove it"
                                 : "")
                    : "");
}

}  // namespace

Camera complete_camera(const RawView& raw, double pixel_center) {
  Camera camera = raw.camera;
  Intrinsics& k = camera.intrinsics;
  complete_focal_lengths(raw, k);
  // An unstated principal point is the image's centre, whatever the file's pixel convention.
  k.cx = std::isnan(k.cx) ? 0.5 * (k.width - 1) : k.cx - pixel_center;
  k.cy = std::isnan(k.cy) ? 0.5 * (k.height - 1) : k.cy - pixel_center;
  check_camera(camera, raw.distortion, raw.where);
  return camera;
}

Photographs find_photographs(const RawScene& raw) {
  Photographs found;
  std::set<fs::path> taken;
  for (const RawView& view : raw.views) {
    found.images.push_back(find_listed_image(view.listed, raw.image_folders));
    if (!found.images.back().empty()) taken.insert(found.images.back());
  }
  for (std::size_t i = 0; i < raw.views.size(); ++i) {
    if (!found.images[i].empty()) continue;
    fs::path elsewhere = find_image(raw.views[i].listed, raw.image_folders);
    if (!taken.contains(elsewhere)) found.images[i] = std::move(elsewhere);
  }
  reject_duplicates(raw, found.images);
  found.names = view_names(raw, found.images);
  return found;
}

CheckedView check_view(const RawScene& raw, std::size_t index, const Photographs& photographs,
                       double pixel_center) {
  RawView stated = raw.views[index];
  const fs::path& image = photographs.images[index];
  const auto refused = [&](Reason reason, std::string detail) {
    const std::string& name = reason == Reason::kMissing ? stated.listed : photographs.names[index];
    return CheckedView{{}, {name, stated.where, reason, std::move(detail)}};
  };
  if (image.empty()) return refused(Reason::kMissing, looked_in(raw, stated.listed));
  ImageSize size;
  try {
    size = read_image_size(image);
  } catch (const Error& failure) {
    return refused(Reason::kUnreadable, without_path(failure.what(), image));
  }
  Intrinsics& k = stated.camera.intrinsics;
  if (k.width == 0) k.width = size.width;
  if (k.height == 0) k.height = size.height;
  const bool same = k.width == size.width && k.height == size.height;
  if (!same && !is_scaled_copy(size.width, size.height, k.width, k.height))
    return refused(Reason::kSize, wrong_shape(size, k));
  Camera camera = complete_camera(stated, pixel_center);
  if (!same) camera.intrinsics = scaled_to(camera.intrinsics, size.width, size.height);
  return {
      SourceView{photographs.names[index], image, {}, camera, stated.distortion, stated.silhouette},
      {},
      !same};
}

ImageSize image_size_or_none(const fs::path& image) {
  try {
    return read_image_size(image);
  } catch (const Error&) {
    return {};  // why, check_view says
  }
}

}  // namespace photohull::io
