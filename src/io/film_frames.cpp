#include "io/film_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/child_process.h"
#include "core/error.h"
#include "io/open_image.h"
#include "io/text_file.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char *kProgram = "ffmpeg", *kProbe = "ffprobe";
constexpr int kOfStretch = 6;  // pictures that the sharpest is chosen of
constexpr int kFewest = 3, kMost = 1000;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// What a film's header says.
struct FilmLength {
  double seconds = 0;
  double rate = 0;  ///< pictures a second
};

/// ffmpeg takes names for addresses of the network where they look so.
std::string as_file(const fs::path& film) { return "file:" + fs::absolute(film).string(); }

/// ffmpeg's pattern for pictures in a folder, in which a percent sign stands for a number.
std::string pictures_in(const fs::path& folder) {
  std::string pattern;
  for (const char c : folder.string()) pattern += c == '%' ? "%%" : std::string(1, c);
  return pattern + "/picture_%06d.jpg";
}

/// The last line that says something, without the program's own place in it.
std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of("\r\n \t");
  if (end == std::string::npos) return "nothing was said why";
  const std::size_t begin = text.find_last_of('\n', end);
  return one_line(text.substr(begin == std::string::npos ? 0 : begin + 1,
                              end - (begin == std::string::npos ? 0 : begin + 1) + 1));
}

[[noreturn]] void refuse(const fs::path& film, const std::string& reason) {
  throw Error(concat(film.string(), ": the film cannot be read (", reason,
                     "); give a film that a player shows, such as an MP4 file with H.264"));
}

/// "30000/1001" or "30"; 0 where it is no number.
double ratio(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::optional<double> above = parse_double(std::string_view(text).substr(0, slash)),
                              below = slash == std::string::npos
                                          ? std::optional<double>(1)
                                          : parse_double(std::string_view(text).substr(slash + 1));
  const double value = above && below ? *above / *below : 0;
  return std::isfinite(value) && value > 0 ? value : 0;
}

FilmLength length_of(const fs::path& film, const Progress& progress) {
  const Finished told =
      run_child(kProbe,
                {"-v", "error", "-select_streams", "v:0", "-show_entries",
                 "stream=duration,avg_frame_rate:format=duration", "-of", "json", as_file(film)},
                kNoLimit, progress);
  if (!told.ok()) refuse(film, last_line(told.err));
  const json all = json::parse(told.out, nullptr, false);
  if (!all.is_object() || !all.contains("streams") || all["streams"].empty())
    refuse(film, "it has no pictures");
  const json& stream = all["streams"][0];
  const auto text = [](const json& object, const char* field) {
    return object.contains(field) && object[field].is_string() ? object[field].get<std::string>()
                                                               : std::string();
  };
  FilmLength length;
  length.seconds = ratio(text(stream, "duration"));
  if (length.seconds == 0 && all.contains("format"))
    length.seconds = ratio(text(all["format"], "duration"));
  length.rate = ratio(text(stream, "avg_frame_rate"));
  if (length.seconds == 0 || length.rate == 0) refuse(film, "how long it is does not show");
  return length;
}

}  // namespace

void describe(Described& to, FrameOptions& o) {
  to.number("frames", &o.frames, from_to(kFewest, kMost), "",
            "pictures that are taken from a film: the sharpest of each of so many stretches");
}

std::vector<std::vector<fs::path>> extract_stretches(const fs::path& film, const fs::path& folder,
                                                     const FrameOptions& options,
                                                     const Progress& progress) {
  check_options(options);
  if (!is_file(film)) throw Error(concat(film.string(), ": there is no such film"));
  for (const char* program : {kProgram, kProbe})
    if (!is_on_path(program))
      throw Error(concat(film.string(), ": films are read by the program ", program,
                         ", which is not installed; install the package ", kProgram,
                         ", or give photographs"));
  const FilmLength length = length_of(film, progress);
  const double wanted = double(options.frames) * kOfStretch / length.seconds;
  std::vector<std::string> words = {"-hide_banner",
                                    "-loglevel",
                                    "error",
                                    "-nostdin",
                                    "-y",
                                    "-i",
                                    as_file(film),
                                    "-map",
                                    "0:v:0",
                                    "-vf",
                                    concat("fps=", std::min(wanted, length.rate)),
                                    "-qmin",
                                    "1",
                                    "-q:v",
                                    "1",
                                    pictures_in(folder)};
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) throw Error(concat(folder.string(), ": cannot be made (", failure.message(), ")"));
  const Finished taken = run_child(kProgram, words, kNoLimit, progress);
  if (!taken.ok()) refuse(film, last_line(taken.err));
  std::vector<fs::path> pictures;
  for (fs::directory_iterator i(folder, failure), end; !failure && i != end; i.increment(failure))
    if (i->path().filename().string().starts_with("picture_")) pictures.push_back(i->path());
  std::sort(pictures.begin(), pictures.end());
  if (pictures.empty()) refuse(film, "no picture came out of it");
  const std::size_t count = std::min(std::size_t(options.frames), pictures.size());
  std::vector<std::vector<fs::path>> stretches(count);
  for (std::size_t i = 0; i < pictures.size(); ++i)
    stretches[i * count / pictures.size()].push_back(pictures[i]);
  return stretches;
}

}  // namespace photohull::io
