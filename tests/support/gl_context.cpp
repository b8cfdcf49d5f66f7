#include "support/gl_context.h"

namespace photohull::test {

gpu::Context& gl_context() {
  static const std::unique_ptr<gpu::Context> context = gpu::Context::create("auto");
  return *context;
}

}  // namespace photohull::test
