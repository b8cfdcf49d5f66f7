// Which pictures a calibration is made from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace photohull::io {

/// The files given, and the pictures of the folders given in natural order (2 before 10) but for
/// hidden ones (._1.jpg). Throws Error naming a folder that cannot be listed, and when there is no
/// picture at all.
std::vector<std::filesystem::path> list_images(const std::vector<std::string>& given);

/// The photographs in the folders given that no reader here knows: HEIC, and cameras' raw files.
std::vector<std::filesystem::path> list_unreadable(const std::vector<std::string>& given);

/// Pictures of several cameras at the same moments.
struct RigImages {
  std::vector<std::string> cameras, moments;               ///< in natural order
  std::vector<std::vector<std::filesystem::path>> images;  ///< [camera][moment]; empty: none
};

/// The pictures in and below a folder (three levels) whose paths from there, without extension, are
/// as `pattern` says: it holds {camera} and {moment} once each, such as "{camera}/{moment}" or
/// "shot{moment}_{camera}", where what stands between them ends the first at its first occurrence.
/// Throws UsageError for other patterns, Error where nothing matches or two pictures have the same
/// camera and moment.
RigImages list_rig_images(const std::filesystem::path& folder, const std::string& pattern);

}  // namespace photohull::io
