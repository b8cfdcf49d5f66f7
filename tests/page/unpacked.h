// A page's model unpacked again, as src/page/encode_model.h says that it is packed.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "page/encode_model.h"

namespace photohull::test {

std::vector<std::uint8_t> from_base64(const std::string& text);

struct Unpacked {
  nlohmann::json table;
  std::map<std::string, std::vector<std::uint32_t>> streams;  ///< element by element, by name
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Throws std::runtime_error where the bytes are not those of the table.
Unpacked unpack(const page::Model& model);

}  // namespace photohull::test
