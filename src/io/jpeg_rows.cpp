#include "io/jpeg_rows.h"

#include <csetjmp>
#include <cstdio>

#include <jerror.h>
#include <jpeglib.h>

#include "core/error.h"

namespace photohull::io {

/// libjpeg leaves by longjmp: every call of it stands in a function without objects to destroy.
struct JpegRows::State {
  jpeg_error_mgr manager{};
  std::jmp_buf on_error;
  jpeg_decompress_struct jpeg{};
  std::FILE* file = nullptr;
  bool created = false, opened = false;
  char message[JMSG_LENGTH_MAX] = "";
  std::string error;

  static void leave(j_common_ptr jpeg) {
    auto* state = static_cast<State*>(jpeg->client_data);
    jpeg->err->format_message(jpeg, state->message);
    std::longjmp(state->on_error, 1);
  }

  /// Warnings are of damaged data; the first one is kept.
  static void note(j_common_ptr jpeg, int level) {
    auto* state = static_cast<State*>(jpeg->client_data);
    if (level >= 0) return;
    if (jpeg->err->num_warnings++ == 0) jpeg->err->format_message(jpeg, state->message);
  }

  bool open(int reduction) {
    if (setjmp(on_error)) return false;
    jpeg_create_decompress(&jpeg);
    created = true;
    jpeg_stdio_src(&jpeg, file);
    jpeg_read_header(&jpeg, TRUE);
    jpeg.scale_num = 1;
    jpeg.scale_denom = unsigned(reduction);
    jpeg.out_color_space = JCS_EXT_RGBA;
    jpeg_start_decompress(&jpeg);
    return true;
  }

  bool read(std::uint8_t* row) {
    if (setjmp(on_error)) return false;
    JSAMPROW rows[1] = {row};
    return jpeg_read_scanlines(&jpeg, rows, 1) == 1;
  }

  bool end() {
    if (setjmp(on_error)) return false;
    jpeg_finish_decompress(&jpeg);
    return jpeg.err->num_warnings == 0;
  }

  ~State() {
    if (created) jpeg_destroy_decompress(&jpeg);
    if (file) std::fclose(file);
  }
};

JpegRows::JpegRows(const std::filesystem::path& path, int reduction)
    : state_(std::make_unique<State>()) {
  PHOTOHULL_CHECK(reduction == 1 || reduction == 2 || reduction == 4 || reduction == 8);
  State& s = *state_;
  s.jpeg.err = jpeg_std_error(&s.manager);
  s.jpeg.client_data = &s;
  s.manager.error_exit = State::leave;
  s.manager.emit_message = State::note;
  s.file = std::fopen(path.c_str(), "rb");
  if (!s.file)
    s.error = "it cannot be opened";
  else if (!(s.opened = s.open(reduction)))
    s.error = s.message;
}

JpegRows::~JpegRows() = default;

int JpegRows::width() const { return state_->opened ? int(state_->jpeg.output_width) : 0; }
int JpegRows::height() const { return state_->opened ? int(state_->jpeg.output_height) : 0; }
bool JpegRows::out_of_memory() const { return state_->manager.msg_code == JERR_OUT_OF_MEMORY; }
const std::string& JpegRows::error() const { return state_->error; }

bool JpegRows::read_row(std::uint8_t* rgba) {
  if (state_->opened && state_->read(rgba)) return true;
  state_->error = state_->message;
  return false;
}

bool JpegRows::finish() {
  if (state_->opened && state_->end()) return true;
  state_->error = state_->message;
  return false;
}

}  // namespace photohull::io
