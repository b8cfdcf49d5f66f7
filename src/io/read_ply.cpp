// Reads PLY files, trusting nothing in them: counts are checked against the bytes that are there
// before memory is asked for.
#include "io/read_ply.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/image.h"
#include "core/read_file.h"

namespace photohull {
namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

constexpr std::size_t kTypeSize[] = {1, 1, 2, 2, 4, 4, 4, 8};

struct Property {
  std::string name;
  Type type = Type::kFloat;
  std::optional<Type> count;  ///< type of the count, for a list
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;

  /// Index of a property; -1 where there is none.
  int find(std::string_view wanted) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
      if (properties[i].name == wanted) return int(i);
    return -1;
  }
};

struct Header {
  bool ascii = false;
  std::vector<Element> elements;
};

std::optional<Type> parse_type(std::string_view word) {
  static constexpr std::string_view kNames[][2] = {
      {"char", "int8"}, {"uchar", "uint8"}, {"short", "int16"},   {"ushort", "uint16"},
      {"int", "int32"}, {"uint", "uint32"}, {"float", "float32"}, {"double", "float64"}};
  for (std::size_t i = 0; i < std::size(kNames); ++i)
    if (word == kNames[i][0] || word == kNames[i][1]) return Type(i);
  return std::nullopt;
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// Walks over a file's bytes.
class Reader {
 public:
  Reader(std::string_view bytes, std::string name) : rest_(bytes), name_(std::move(name)) {}

  std::size_t left() const { return rest_.size(); }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(concat("cannot read ", name_, ": ", what, "; give a complete PLY file."));
  }
  /// A line of the header as words.
  std::vector<std::string_view> line();
  double number(Type type, bool ascii) { return ascii ? ascii_number() : binary_number(type); }

 private:
  template <typename T>
  double take() {
    if (rest_.size() < sizeof(T)) fail("it ends early");
    T value;
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return double(value);
  }
  double binary_number(Type type);
  double ascii_number();

  std::string_view rest_;
  std::string name_;
};

std::vector<std::string_view> Reader::line() {
  const std::size_t end = rest_.find('\n');
  if (end == std::string_view::npos) fail("its header has no end");
  std::string_view text = rest_.substr(0, end);
  rest_.remove_prefix(end + 1);
  std::vector<std::string_view> words;
  while (true) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    if (text.empty()) return words;
    const std::size_t length = std::min(text.find_first_of(" \t\r"), text.size());
    words.push_back(text.substr(0, length));
    text.remove_prefix(length);
  }
}

double Reader::binary_number(Type type) {
  switch (type) {
    case Type::kInt8:
      return take<std::int8_t>();
    case Type::kUint8:
      return take<std::uint8_t>();
    case Type::kInt16:
      return take<std::int16_t>();
    case Type::kUint16:
      return take<std::uint16_t>();
    case Type::kInt32:
      return take<std::int32_t>();
    case Type::kUint32:
      return take<std::uint32_t>();
    case Type::kFloat:
      return take<float>();
    case Type::kDouble:
      return take<double>();
  }
  return 0;
}

double Reader::ascii_number() {
  while (!rest_.empty() && is_space(rest_.front())) rest_.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
  if (rest_.empty()) fail("it ends early");
  if (error != std::errc()) fail("a value is not a number");
  rest_.remove_prefix(std::size_t(end - rest_.data()));
  return value;
}

Property parse_property(const std::vector<std::string_view>& words, const Reader& reader) {
  const bool list = words.size() == 5 && words[1] == "list";
  if (!list && words.size() != 3) reader.fail("a property line of its header is malformed");
  const auto type = parse_type(words[list ? 3 : 1]);
  const auto count = list ? parse_type(words[2]) : std::nullopt;
  if (!type || (list && !count)) reader.fail("its header names an unknown type");
  return {std::string(words.back()), *type, count};
}

Header parse_header(Reader& reader) {
  constexpr std::size_t kMostProperties = 1000;
  Header header;
  bool format = false;
  std::size_t properties = 0;
  if (reader.line() != std::vector<std::string_view>{"ply"}) reader.fail("it is not a PLY file");
  while (true) {
    const auto words = reader.line();
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") break;
    if (words[0] == "format" && words.size() == 3) {
      header.ascii = words[1] == "ascii";
      if (!header.ascii && words[1] != "binary_little_endian")
        reader.fail(concat("its format ", words[1], " is not supported"));
      format = true;
    } else if (words[0] == "element" && words.size() == 3) {
      Element element{std::string(words[1]), 0, {}};
      const auto [end, error] =
          std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count);
      if (error != std::errc() || end != words[2].data() + words[2].size())
        reader.fail(concat("its number of ", words[1], " elements is malformed"));
      header.elements.push_back(std::move(element));
    } else if (words[0] == "property" && !header.elements.empty()) {
      if (++properties > kMostProperties) reader.fail("its header has too many properties");
      header.elements.back().properties.push_back(parse_property(words, reader));
    } else {
      reader.fail("a line of its header is malformed");
    }
  }
  if (!format) reader.fail("its header names no format");
  return header;
}

/// Every element needs so many bytes at least; more elements than bytes for them is a lie.
void check_count(const Element& element, bool ascii, const Reader& reader) {
  std::size_t least = 0;
  for (const Property& property : element.properties)
    least += ascii ? 2 : kTypeSize[int(property.count.value_or(property.type))];
  // The last number of an ascii file may end with the file instead of a space.
  const std::size_t left = reader.left() + (ascii ? 1 : 0);
  if (element.count > 0 && (least == 0 || element.count > left / least))
    reader.fail(concat("it is too short for its ", element.count, " ", element.name, " elements"));
}

/// Values of one element: a scalar has one, a list any number.
using Values = std::vector<std::vector<double>>;

void read_values(const Element& element, bool ascii, Reader& reader, Values& values) {
  values.resize(element.properties.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Property& property = element.properties[i];
    const double count = property.count ? reader.number(*property.count, ascii) : 1.0;
    if (!(count >= 0 && count <= double(reader.left()))) reader.fail("a list's length is wrong");
    values[i].resize(std::size_t(count));
    for (double& value : values[i]) value = reader.number(property.type, ascii);
  }
}

/// Properties of a vertex by meaning; -1 where the file has none.
struct VertexLayout {
  explicit VertexLayout(const Element& e)
      : position{e.find("x"), e.find("y"), e.find("z")},
        normal{e.find("nx"), e.find("ny"), e.find("nz")},
        colour{e.find("red"), e.find("green"), e.find("blue")},
        confidence(e.find("confidence")) {
    for (const int i : colour)
      if (i >= 0 && e.properties[i].type != Type::kUint8) colour = {-1, -1, -1};
  }
  static bool complete(const std::array<int, 3>& triple) {
    return std::all_of(triple.begin(), triple.end(), [](int i) { return i >= 0; });
  }
  /// Indices of the properties that have no meaning here.
  std::vector<int> others(const Element& e) const {
    std::vector<int> result;
    for (int i = 0; i < int(e.properties.size()); ++i) {
      const auto has = [i](const std::array<int, 3>& t) {
        return std::find(t.begin(), t.end(), i) != t.end();
      };
      if (!has(position) && !has(normal) && !has(colour) && i != confidence) result.push_back(i);
    }
    return result;
  }
  std::array<int, 3> position, normal, colour;
  int confidence;
};

glm::dvec3 pick(const Values& values, const std::array<int, 3>& triple) {
  return {values[triple[0]][0], values[triple[1]][0], values[triple[2]][0]};
}

void read_vertices(const Element& element, bool ascii, Reader& reader, TriMesh& mesh,
                   VertexScalars* scalars) {
  constexpr double kFarthest = 1e30;  // fits a float
  if (!mesh.positions.empty()) reader.fail("it has more than one list of vertices");
  const VertexLayout layout(element);
  if (!VertexLayout::complete(layout.position)) reader.fail("its vertices have no x, y, z");
  for (const Property& property : element.properties)
    if (property.count) reader.fail("its vertices have list properties, which is not supported");
  std::vector<std::pair<int, std::vector<double>*>> others;
  if (scalars)
    for (const int i : layout.others(element))
      others.emplace_back(i, &(*scalars)[element.properties[i].name]);
  std::vector<glm::dvec3> world;
  world.reserve(element.count);
  glm::dvec3 low(INFINITY), high(-INFINITY);
  Values values;
  for (std::size_t v = 0; v < element.count; ++v) {
    read_values(element, ascii, reader, values);
    world.push_back(pick(values, layout.position));
    low = glm::min(low, world.back());
    high = glm::max(high, world.back());
    if (!glm::all(glm::lessThan(glm::abs(world.back()), glm::dvec3(kFarthest))))
      reader.fail("a vertex's position is no usable number");
    if (VertexLayout::complete(layout.normal))
      mesh.normals.emplace_back(pick(values, layout.normal));
    if (VertexLayout::complete(layout.colour)) {
      const glm::dvec3 code = pick(values, layout.colour) / 255.0;
      mesh.colours.emplace_back(linear_from_srgb(code.r), linear_from_srgb(code.g),
                                linear_from_srgb(code.b));
    }
    if (layout.confidence >= 0) mesh.confidence.push_back(float(values[layout.confidence][0]));
    for (const auto& [property, list] : others) list->push_back(values[property][0]);
  }
  if (world.empty()) return;
  mesh.origin = 0.5 * low + 0.5 * high;
  for (const glm::dvec3& p : world) mesh.positions.emplace_back(p - mesh.origin);
}

void read_faces(const Element& element, bool ascii, Reader& reader, TriMesh& mesh) {
  int list = element.find("vertex_indices");
  if (list < 0) list = element.find("vertex_index");
  if (list < 0 || !element.properties[list].count) reader.fail("its faces have no vertex_indices");
  Values values;
  for (std::size_t f = 0; f < element.count; ++f) {
    read_values(element, ascii, reader, values);
    const std::vector<double>& corners = values[list];
    for (const double corner : corners)
      if (!(corner >= 0 && corner < double(mesh.positions.size())))
        reader.fail(concat("face ", f, " has a vertex index out of range"));
    for (std::size_t i = 2; i < corners.size(); ++i)
      mesh.triangles.push_back(
          {std::uint32_t(corners[0]), std::uint32_t(corners[i - 1]), std::uint32_t(corners[i])});
  }
}

TriMesh read(const std::filesystem::path& path, VertexScalars* scalars) {
  const std::string bytes = read_whole_file(path);
  Reader reader(bytes, path.string());
  const Header header = parse_header(reader);
  TriMesh mesh;
  Values skipped;
  for (const Element& element : header.elements) {
    check_count(element, header.ascii, reader);
    if (element.name == "vertex")
      read_vertices(element, header.ascii, reader, mesh, scalars);
    else if (element.name == "face")
      read_faces(element, header.ascii, reader, mesh);
    else
      for (std::size_t i = 0; i < element.count; ++i)
        read_values(element, header.ascii, reader, skipped);
  }
  return mesh;
}

}  // namespace

TriMesh read_ply(const std::filesystem::path& path) { return read(path, nullptr); }

TriMesh read_ply(const std::filesystem::path& path, VertexScalars& scalars) {
  scalars.clear();
  return read(path, &scalars);
}

}  // namespace photohull
