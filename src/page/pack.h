// Bytes as text that a page unpacks. Private to page.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace photohull::page {

std::string base64(std::span<const std::uint8_t> bytes);

/// Base64 of the bytes, deflated with zlib's head, which browsers call "deflate". The same bytes
/// give the same text with one version of zlib.
std::string packed(std::span<const std::uint8_t> bytes);

}  // namespace photohull::page
