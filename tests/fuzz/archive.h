// Several files in one: what a fuzzer mutates.
#pragma once

#include <filesystem>
#include <string_view>

namespace photohull::fuzz {

/// Writes the files of an archive into a folder:
///
///   === cameras.txt
///   ... bytes up to the next such line ...
///   === images/a.png
///
/// The line end before a heading is the heading's. A picture's name (.png) over no bytes stands for
/// a grey picture of 8 x 6 pixels. Headings are relative paths of letters, digits and "._-/",
/// without
/// "..", at most 64 long; other lines that begin so are contents. At most 32 files are written.
void unpack(std::string_view archive, const std::filesystem::path& folder);

/// An empty folder in memory where the system has one, of this process alone; emptied by each call.
const std::filesystem::path& empty_folder();

}  // namespace photohull::fuzz
