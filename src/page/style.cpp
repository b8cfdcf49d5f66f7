#include "page/style.h"

__asm__(
    ".section .rodata\n.global photohull_base_style_begin\n.hidden photohull_base_style_begin\n"
    "photohull_base_style_begin:\n.incbin \"" PHOTOHULL_WEB
    "/base.css\"\n"
    ".global photohull_base_style_end\n.hidden photohull_base_style_end\n"
    "photohull_base_style_end:\n.byte 0\n.previous\n");
extern "C" [[gnu::visibility("hidden")]] const char photohull_base_style_begin[],
    photohull_base_style_end[];

namespace photohull::page {

std::string_view base_style() { return {photohull_base_style_begin, photohull_base_style_end}; }

}  // namespace photohull::page
