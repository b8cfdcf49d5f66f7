#include "options.h"

#include <vector>

#include "core/error.h"
#include "core/nearest_name.h"
#include "core/option_word.h"

namespace photohull::python {
namespace py = pybind11;
namespace {

bool is_flag(const Option& option) { return std::holds_alternative<bool*>(option.place); }

bool is_repeatable(const Option& option) {
  return !option.list && std::holds_alternative<std::vector<std::string>*>(option.place);
}

[[noreturn]] void refuse(const Option& option, py::handle value) {
  const std::string legal = is_flag(option) ? "True or False" : legal_values(option);
  throw UsageError(concat(option_word(option.name, std::string(py::repr(value))), ": expected ",
                          legal.empty() ? "text" : legal));
}

bool is_sequence(py::handle value) {
  return py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value) ||
         (py::hasattr(value, "ndim") && value.attr("ndim").cast<int>() > 0);
}

/// As read_option takes it. Numbers keep all of their digits.
std::string text_of_value(const Option& option, py::handle value) {
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (PyBool_Check(value.ptr())) refuse(option, value);
  if (PyIndex_Check(value.ptr()))
    return py::str(py::reinterpret_steal<py::object>(PyNumber_Index(value.ptr())));
  if (PyFloat_Check(value.ptr()) || py::hasattr(value, "__float__"))
    return py::repr(py::float_(py::reinterpret_borrow<py::object>(value)));
  if (py::hasattr(value, "__fspath__")) return path_of(py::reinterpret_borrow<py::object>(value));
  refuse(option, value);
}

/// Numbers of lists within lists, one after the other: a box may be given as two corners.
void append_texts(const Option& option, py::handle value, std::vector<std::string>& texts) {
  if (!is_sequence(value)) return texts.push_back(text_of_value(option, value));
  for (const py::handle item : value) append_texts(option, item, texts);
}

void set_option(const Option& option, py::handle value) {
  if (is_flag(option)) {
    if (!PyBool_Check(value.ptr())) refuse(option, value);
    return read_option(option, value.cast<bool>() ? "true" : "");
  }
  std::vector<std::string> texts;
  if (py::isinstance<py::dict>(value)) {
    if (!is_repeatable(option)) refuse(option, value);
    for (const auto& [name, of] : value.cast<py::dict>())
      texts.push_back(name.cast<std::string>() + "=" + text_of_value(option, of));
  } else {
    append_texts(option, value, texts);
  }
  if (is_repeatable(option)) {
    for (const std::string& text : texts) read_option(option, text);
    return;
  }
  std::string joined;
  for (const std::string& text : texts)
    joined += (joined.empty() ? "" : option.list ? "," : " ") + text;
  read_option(option, joined);
}

std::string type_of(const Option& option) {
  if (is_flag(option)) return "bool";
  if (!option.choices.empty()) {
    std::string words;
    for (const std::string& choice : option.choices)
      words += (words.empty() ? "\"" : ", \"") + choice + "\"";
    return "Literal[" + words + "]";
  }
  const bool whole = std::holds_alternative<int*>(option.place) ||
                     std::holds_alternative<std::uint64_t*>(option.place) ||
                     std::holds_alternative<std::optional<int>*>(option.place) ||
                     std::holds_alternative<std::optional<std::int64_t>*>(option.place);
  const std::string number = whole ? "int" : "float";
  if (option.list) return is_number(option) ? "str | Sequence[float]" : "str | Sequence[str]";
  if (is_repeatable(option)) return "str | Sequence[str] | Mapping[str, float]";
  if (is_number(option))
    return option.absent.empty() && !option.notation ? number : number + " | str";
  if (option.name == "box") return "str | Sequence[float] | Sequence[Sequence[float]] | np.ndarray";
  return "str | float | os.PathLike[str]";
}

}  // namespace

void set_options(const Described& described, const py::dict& given, const std::string& function) {
  for (const auto& [key, value] : given) {
    const std::string name = key.cast<std::string>();
    const Option* option = described.find(name);
    if (!option) {
      std::vector<std::string> names;
      for (const Option& o : described.options()) names.push_back(o.name);
      const auto meant = nearest_name(name, names);
      throw UsageError(
          concat(name, ": ", function, " has no such option",
                 meant ? "; did you mean " + *meant + "?" : "; photohull.options() lists them"));
    }
    if (!value.is_none()) set_option(*option, value);
  }
}

py::list option_list(const Described& described) {
  py::list list;
  for (const Option& option : described.options()) {
    py::dict entry;
    entry["name"] = option.name;
    entry["help"] = option.help;
    entry["values"] = is_flag(option) ? "True or False" : legal_values(option);
    entry["unit"] = option.unit;
    entry["default"] =
        is_flag(option) ? (text_of(option).empty() ? "False" : "True") : text_of(option);
    entry["type"] = type_of(option);
    list.append(entry);
  }
  return list;
}

std::string path_of(const py::object& path) {
  py::object text = py::module_::import("os").attr("fspath")(path);
  return py::bytes(py::module_::import("os").attr("fsencode")(text));
}

}  // namespace photohull::python
