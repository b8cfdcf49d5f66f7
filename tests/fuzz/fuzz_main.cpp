// libFuzzer's entry points, for the target that --target=NAME names (libFuzzer leaves alone what
// begins with two dashes); --list prints the names. scripts/fuzz.sh runs them all.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "targets.h"

namespace {

const photohull::fuzz::Target* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr const char* kOption = "--target=";
  for (int i = 1; i < *argc; ++i) {
    const char* argument = (*argv)[i];
    if (std::strcmp(argument, "--list") == 0) {
      for (const auto& target : photohull::fuzz::targets()) std::puts(target.name.c_str());
      std::fflush(stdout);
      std::_Exit(0);
    }
    if (std::strncmp(argument, kOption, std::strlen(kOption)) == 0)
      chosen = photohull::fuzz::find_target(argument + std::strlen(kOption));
  }
  if (!chosen) {
    std::fprintf(stderr, "give --target=NAME; --list prints the names\n");
    std::_Exit(2);
  }
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  chosen->run({reinterpret_cast<const char*>(data), size});
  return 0;
}
