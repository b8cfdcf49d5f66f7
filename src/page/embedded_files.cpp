#include "page/embedded_files.h"

#define PHOTOHULL_BEGIN(symbol) \
  ".section .rodata\n.global " #symbol "_begin\n.hidden " #symbol "_begin\n" #symbol "_begin:\n"
#define PHOTOHULL_END(symbol) \
  ".global " #symbol "_end\n.hidden " #symbol "_end\n" #symbol "_end:\n.byte 0\n.previous\n"
#define PHOTOHULL_FILE(path) ".incbin \"" path "\"\n"
#define PHOTOHULL_DECLARE(symbol) \
  extern "C" [[gnu::visibility("hidden")]] const char symbol##_begin[], symbol##_end[]

__asm__(PHOTOHULL_BEGIN(photohull_three_js) PHOTOHULL_FILE(PHOTOHULL_THREE)
            PHOTOHULL_END(photohull_three_js));
__asm__(PHOTOHULL_BEGIN(photohull_report_template) PHOTOHULL_FILE(PHOTOHULL_WEB "/page.html")
            PHOTOHULL_END(photohull_report_template));
__asm__(PHOTOHULL_BEGIN(photohull_report_style) PHOTOHULL_FILE(PHOTOHULL_WEB "/page.css")
            PHOTOHULL_END(photohull_report_style));
__asm__(PHOTOHULL_BEGIN(photohull_report_script)         //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/elements.js")     //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/unpack.js")       //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/layers.js")       //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/orbit.js")        //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/photographs.js")  //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/viewer.js")       //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/views_table.js")  //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/report.js")       //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/main.js")         //
        PHOTOHULL_END(photohull_report_script));

__asm__(PHOTOHULL_BEGIN(photohull_batch_template) PHOTOHULL_FILE(PHOTOHULL_WEB "/batch.html")
            PHOTOHULL_END(photohull_batch_template));
__asm__(PHOTOHULL_BEGIN(photohull_batch_style) PHOTOHULL_FILE(PHOTOHULL_WEB "/batch.css")
            PHOTOHULL_END(photohull_batch_style));
__asm__(PHOTOHULL_BEGIN(photohull_batch_script)       //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/elements.js")  //
        PHOTOHULL_FILE(PHOTOHULL_WEB "/batch.js")     //
        PHOTOHULL_END(photohull_batch_script));

PHOTOHULL_DECLARE(photohull_three_js);
PHOTOHULL_DECLARE(photohull_report_template);
PHOTOHULL_DECLARE(photohull_report_style);
PHOTOHULL_DECLARE(photohull_report_script);
PHOTOHULL_DECLARE(photohull_batch_template);
PHOTOHULL_DECLARE(photohull_batch_style);
PHOTOHULL_DECLARE(photohull_batch_script);

namespace photohull::page {

std::string_view three_js() { return {photohull_three_js_begin, photohull_three_js_end}; }
std::string_view page_template() {
  return {photohull_report_template_begin, photohull_report_template_end};
}
std::string_view page_style() { return {photohull_report_style_begin, photohull_report_style_end}; }
std::string_view page_script() {
  return {photohull_report_script_begin, photohull_report_script_end};
}
std::string_view batch_template() {
  return {photohull_batch_template_begin, photohull_batch_template_end};
}
std::string_view batch_style() { return {photohull_batch_style_begin, photohull_batch_style_end}; }
std::string_view batch_script() {
  return {photohull_batch_script_begin, photohull_batch_script_end};
}

}  // namespace photohull::page
