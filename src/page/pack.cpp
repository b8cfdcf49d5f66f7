#include "page/pack.h"

#include <zlib.h>

#include <vector>

#include "core/error.h"

namespace photohull::page {
namespace {

constexpr int kEffort = 6;  // 9 takes three times as long for one percent
constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

}  // namespace

std::string base64(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const std::uint32_t three = std::uint32_t(bytes[i]) << 16 |
                                std::uint32_t(left > 1 ? bytes[i + 1] : 0) << 8 |
                                std::uint32_t(left > 2 ? bytes[i + 2] : 0);
    text += kDigits[three >> 18];
    text += kDigits[three >> 12 & 63];
    text += left > 1 ? kDigits[three >> 6 & 63] : '=';
    text += left > 2 ? kDigits[three & 63] : '=';
  }
  return text;
}

std::string packed(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(uLong(bytes.size()));
  std::vector<std::uint8_t> deflated(size);
  const int status = compress2(deflated.data(), &size, bytes.data(), uLong(bytes.size()), kEffort);
  PHOTOHULL_CHECK_OP(status, ==, Z_OK);
  return base64({deflated.data(), size});
}

}  // namespace photohull::page
