#include "unpacked.h"

#include <zlib.h>

#include <stdexcept>

namespace photohull::test {

std::vector<std::uint8_t> from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<std::uint8_t> bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    const std::size_t digit = digits.find(c);
    if (digit == std::string::npos) throw std::runtime_error("no base64");
    bits = bits << 6 | std::uint32_t(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(std::uint8_t(bits >> count));
  }
  return bytes;
}

namespace {

std::vector<std::uint8_t> inflated(const std::vector<std::uint8_t>& bytes, std::size_t length) {
  std::vector<std::uint8_t> out(length);
  uLongf size = uLongf(out.size());
  if (uncompress(out.data(), &size, bytes.data(), uLong(bytes.size())) != Z_OK)
    throw std::runtime_error("no deflated bytes");
  if (size != length) throw std::runtime_error("fewer bytes than the streams have");
  return out;
}

}  // namespace

Unpacked unpack(const page::Model& model) {
  Unpacked out{nlohmann::json::parse(model.table), {}, {}};
  const std::size_t vertices = out.table["vertices"], triangles = out.table["triangles"];
  std::size_t length = 0;
  for (const auto& stream : out.table["streams"])
    length += (stream["name"] == "triangles" ? 3 * triangles : vertices) *
              stream["components"].get<std::size_t>() * stream["bytes"].get<std::size_t>();
  const std::vector<std::uint8_t> bytes = inflated(from_base64(model.packed), length);
  std::size_t at = 0;
  for (const auto& stream : out.table["streams"]) {
    const bool corners = stream["name"] == "triangles";
    const std::size_t count = corners ? 3 * triangles : vertices;
    const std::size_t components = stream["components"], width = stream["bytes"];
    std::vector<std::uint32_t> values(count * components);
    for (std::size_t c = 0; c < components; ++c)
      for (std::size_t b = 0; b < width; ++b)
        for (std::size_t i = 0; i < count; ++i)
          values[i * components + c] |= std::uint32_t(bytes.at(at++)) << (8 * b);
    if (!corners)
      for (std::size_t i = 0; i < values.size(); ++i) {
        const std::uint32_t difference = (values[i] >> 1) ^ (0u - (values[i] & 1));
        const std::uint32_t before = i < components ? 0 : values[i - components];
        values[i] = (before + difference) & (width == 4 ? ~0u : (1u << (8 * width)) - 1);
      }
    out.streams[stream["name"]] = values;
  }
  std::uint32_t next = 0;
  std::vector<std::uint32_t>& codes = out.streams["triangles"];
  for (std::uint32_t& code : codes) {
    const bool first = code == 0;
    code = next - code;
    next += first;
  }
  for (std::size_t t = 0; t < triangles; ++t)
    out.triangles.push_back({codes[3 * t], codes[3 * t + 1], codes[3 * t + 2]});
  return out;
}

}  // namespace photohull::test
