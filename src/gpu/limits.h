// What a device takes at once. OpenGL 4.5 promises no more than 65535 groups along each axis of a
// dispatch, 128 MiB in a storage block and 2048 layers of 16384 x 16384 texels.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

namespace photohull::gpu {

struct Limits {
  std::int64_t ssbo_bytes = 0;           ///< largest shader storage block
  int texture_size = 0;                  ///< largest edge of a 2D texture
  int texture_layers = 0;                ///< largest 2D array
  std::array<std::int64_t, 3> groups{};  ///< largest dispatch along x, y and z
};

/// The environment variable that lowers a context's limits, for tests: a list such as
/// "groups=64,block=1048576,size=512,layers=32" (groups along each axis, bytes of a storage block,
/// texels of a texture's edge, layers of an array).
inline constexpr const char* kLimitsVariable = "PHOTOHULL_DEVICE_LIMITS";

/// `limits`, each lowered to what `text` (as of kLimitsVariable) says, and never raised. Throws
/// UsageError when it cannot be read.
Limits lowered(const Limits& limits, const std::string& text);

/// Of the context that is current on this thread; CHECKs that there is one.
const Limits& current_limits();
/// For Context: the limits of what becomes current on this thread; null: of nothing.
void set_current_limits(const Limits* limits);

/// How many items of `item_bytes` one dispatch may take: as many as a storage block holds beside
/// `fixed_bytes`, at most `most`, a multiple of `multiple` where that many fit, and at least 1.
std::size_t batch_size(std::size_t item_bytes, std::size_t most, std::size_t multiple = 1,
                       std::size_t fixed_bytes = 16);

}  // namespace photohull::gpu
