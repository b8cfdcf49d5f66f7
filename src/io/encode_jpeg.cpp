#include "io/encode_jpeg.h"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>

#include <jpeglib.h>

#include "core/error.h"

namespace photohull::io {
namespace {

/// libjpeg leaves by longjmp: its calls stand in a function without objects to destroy.
struct Encoder {
  jpeg_error_mgr manager{};
  std::jmp_buf on_error;
  jpeg_compress_struct jpeg{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  char message[JMSG_LENGTH_MAX] = "";

  static void leave(j_common_ptr jpeg) {
    auto* encoder = static_cast<Encoder*>(jpeg->client_data);
    jpeg->err->format_message(jpeg, encoder->message);
    std::longjmp(encoder->on_error, 1);
  }

  bool run(int width, int height, const std::uint8_t* rgb, int quality) {
    jpeg.err = jpeg_std_error(&manager);
    manager.error_exit = leave;
    jpeg.client_data = this;
    if (setjmp(on_error)) return false;
    jpeg_create_compress(&jpeg);
    jpeg_mem_dest(&jpeg, &bytes, &size);
    jpeg.image_width = JDIMENSION(width);
    jpeg.image_height = JDIMENSION(height);
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_set_quality(&jpeg, quality, TRUE);
    jpeg.optimize_coding = TRUE;
    jpeg_start_compress(&jpeg, TRUE);
    while (jpeg.next_scanline < jpeg.image_height) {
      JSAMPROW row = const_cast<JSAMPROW>(rgb + std::size_t(jpeg.next_scanline) * width * 3);
      jpeg_write_scanlines(&jpeg, &row, 1);
    }
    jpeg_finish_compress(&jpeg);
    return true;
  }

  ~Encoder() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }
};

}  // namespace

std::vector<std::uint8_t> encode_jpeg(int width, int height, std::span<const std::uint8_t> rgb,
                                      int quality) {
  PHOTOHULL_CHECK_OP(rgb.size(), ==, std::size_t(width) * std::size_t(height) * 3);
  Encoder encoder;
  if (!encoder.run(width, height, rgb.data(), quality))
    throw Error(concat("a picture of ", width, " x ", height,
                       " pixels cannot be encoded as JPEG: ", encoder.message));
  return {encoder.bytes, encoder.bytes + encoder.size};
}

}  // namespace photohull::io
