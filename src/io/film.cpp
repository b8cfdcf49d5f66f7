#include "io/film.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <optional>
#include <regex>
#include <vector>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/option_word.h"
#include "io/ffmpeg.h"
#include "io/image_file.h"

namespace photohull::io {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOption = "turntable";
constexpr const char* kNames =
    "NAME.mp4 (or .mov, .mkv, .webm, .gif, .webp), NAME_%04d.png or a folder";

std::string extension_of(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// A PNG file for each picture.
class PictureFiles : public Film {
 public:
  /// `first` and `last` stand around the number, of `digits` digits at least.
  PictureFiles(std::string first, int digits, std::string last, const Progress& progress)
      : first_(std::move(first)), last_(std::move(last)), digits_(digits), progress_(progress) {
    AtomicFile probe(name(0));  // better now than after the work
  }

  ~PictureFiles() override {
    std::error_code ignored;
    if (!finished_)
      for (int i = 0; i < count_; ++i) fs::remove(name(i), ignored);
  }
  PictureFiles(const PictureFiles&) = delete;
  PictureFiles& operator=(const PictureFiles&) = delete;

  void add(const RgbImage& picture) override {
    progress_.check_cancelled();
    AtomicFile file(name(count_));
    write_png(file, picture);
    file.commit();
    ++count_;
  }
  void finish() override { finished_ = true; }

 private:
  fs::path name(int number) const {
    std::string text = std::to_string(number);
    if (int(text.size()) < digits_) text.insert(0, std::size_t(digits_) - text.size(), '0');
    return first_ + text + last_;
  }

  std::string first_, last_;
  int digits_;
  const Progress& progress_;
  int count_ = 0;
  bool finished_ = false;
};

/// In a folder, which goes again where nothing came into it.
class PictureFolder : public Film {
 public:
  PictureFolder(const fs::path& folder, const Progress& progress) : folder_(folder) {
    std::error_code error;
    made_ = fs::create_directories(folder, error);
    if (error)
      throw Error(concat(folder.string(), ": the folder cannot be made (", error.message(),
                         "); choose another with ", option_word(kOption)));
    try {
      files_.emplace((folder / "frame_").string(), 4, ".png", progress);
    } catch (...) {
      leave();
      throw;
    }
  }
  ~PictureFolder() override {
    files_.reset();
    leave();
  }
  void add(const RgbImage& picture) override { files_->add(picture); }
  void finish() override { files_->finish(); }

 private:
  void leave() const {
    std::error_code ignored;  // it is not empty: pictures are in it
    if (made_) fs::remove(folder_, ignored);
  }
  fs::path folder_;
  bool made_ = false;
  std::optional<PictureFiles> files_;
};

/// A file that ffmpeg writes.
class FilmFile : public Film {
 public:
  FilmFile(const fs::path& path, const std::vector<std::string>& words, const Progress& progress)
      : file_(path), ffmpeg_(path, with(words, file_.temporary()), progress) {}

  void add(const RgbImage& picture) override { ffmpeg_.write(picture.rgb); }
  void finish() override {
    ffmpeg_.finish();
    file_.commit();
  }

 private:
  static std::vector<std::string> with(std::vector<std::string> words, const fs::path& file) {
    words.push_back("file:" + file.string());
    return words;
  }
  AtomicFile file_;
  Ffmpeg ffmpeg_;  // ends before its file goes
};

/// What ffmpeg is to make of raw pictures. One thread and no notes of versions: equal bytes.
std::vector<std::string> coding_of(const std::string& extension, const FilmFormat& format) {
  std::vector<std::string> words = {"-f",          "rawvideo",
                                    "-pix_fmt",    "rgb24",
                                    "-video_size", concat(format.width, "x", format.height),
                                    "-framerate",  concat(format.rate),
                                    "-i",          "pipe:0",
                                    "-an",         "-threads",
                                    "1",           "-map_metadata",
                                    "-1",          "-fflags",
                                    "+bitexact",   "-flags:v",
                                    "+bitexact"};
  const auto add = [&](std::initializer_list<const char*> more) {
    words.insert(words.end(), more.begin(), more.end());
  };
  if (extension == ".gif") {
    add({"-filter_complex",
         "[0:v]split[a][b];[a]palettegen=stats_mode=diff[p];[b][p]paletteuse=dither=bayer:"
         "bayer_scale=4:diff_mode=rectangle",
         "-loop", "0", "-f", "gif"});
    return words;
  }
  if (extension == ".webp") {
    add({"-c:v", "libwebp_anim", "-quality", "72", "-compression_level", "6", "-loop", "0", "-f",
         "webp"});
    return words;
  }
  // Films are in the colours of Rec. 709, whose range players expect to be limited.
  add({"-vf", "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p", "-colorspace", "bt709",
       "-color_primaries", "bt709", "-color_trc", "iec61966-2-1", "-color_range", "tv"});
  if (extension == ".webm")
    add({"-c:v", "libvpx-vp9", "-crf", "28", "-b:v", "0", "-row-mt", "0", "-f", "webm"});
  else
    add({"-c:v", "libx264", "-preset", "medium", "-crf", "18"});
  if (extension == ".mp4") add({"-movflags", "+faststart", "-f", "mp4"});
  if (extension == ".mov") add({"-movflags", "+faststart", "-f", "mov"});
  if (extension == ".mkv") add({"-f", "matroska"});
  return words;
}

}  // namespace

std::unique_ptr<Film> open_film(const std::string& name, const FilmFormat& format,
                                const Progress& progress) {
  if (name.empty()) throw UsageError(concat(option_word(kOption), " is empty: give ", kNames));
  const fs::path path = name;
  const std::string extension = extension_of(path);
  static const std::regex numbered("(.*)%(0?([1-9]))?d([^%]*)");
  if (std::smatch parts; extension == ".png" && std::regex_match(name, parts, numbered) &&
                         parts[1].str().find('%') == std::string::npos)
    return std::make_unique<PictureFiles>(parts[1], parts[3].length() ? parts[3].str()[0] - '0' : 1,
                                          parts[4], progress);
  std::error_code ignored;
  if (fs::is_directory(path, ignored) || (extension.empty() && name.find('%') == name.npos))
    return std::make_unique<PictureFolder>(path, progress);
  const auto known = {".mp4", ".mov", ".mkv", ".webm", ".gif", ".webp"};
  if (std::ranges::find(known, extension) == known.end())
    throw UsageError(concat(option_word(kOption, name), ": expected ", kNames));
  if (extension != ".gif" && extension != ".webp" &&
      (format.width % 2 != 0 || format.height % 2 != 0))
    throw UsageError(concat(option_word("size", concat(format.width, "x", format.height)),
                            ": films have even sides; give an even width and height"));
  return std::make_unique<FilmFile>(path, coding_of(extension, format), progress);
}

}  // namespace photohull::io
