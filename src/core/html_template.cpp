#include "core/html_template.h"

namespace photohull {

std::string fill_template(std::string_view page,
                          const std::function<std::string(std::string_view)>& part) {
  std::string html;
  std::size_t from = 0;
  for (;;) {
    const std::size_t start = page.find("@@", from);
    const std::size_t end = start == page.npos ? start : page.find("@@", start + 2);
    html.append(page.substr(from, end == page.npos ? page.npos : start - from));
    if (end == page.npos) return html;
    html += part(page.substr(start + 2, end - start - 2));
    from = end + 2;
  }
}

std::string inside_script(std::string_view json) {
  std::string text;
  for (const char c : json) text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

}  // namespace photohull
