#include "synth/spec.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/json_levels.h"
#include "core/option_word.h"
#include "core/read_file.h"
#include "synth/spec_reader.h"
#include "synth/spec_visit.h"
#include "visibility/technique.h"

namespace photohull::synth {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;
constexpr std::uintmax_t kLargestFile = std::uintmax_t(16) << 20;

/// The visitor that writes.
class SpecWriter {
 public:
  void number(const char* name, const double& value, double, double) { (*at_)[name] = value; }
  void integer(const char* name, const int& value, int, int) { (*at_)[name] = value; }
  void seed(const char* name, const std::uint64_t& value) { (*at_)[name] = value; }
  void flag(const char* name, const bool& value) { (*at_)[name] = value; }
  void text(const char* name, const std::string& value) { (*at_)[name] = value; }
  void choice(const char* name, const std::string& value, const std::vector<std::string>&) {
    (*at_)[name] = value;
  }
  template <typename Vector>
  void vector(const char* name, const Vector& value, double, double) {
    (*at_)[name] = Json::array();
    for (int i = 0; i < int(Vector::length()); ++i) (*at_)[name].push_back(value[i]);
  }
  void numbers(const char* name, const std::vector<double>& value, double, double) {
    (*at_)[name] = value;
  }
  void integers(const char* name, const std::vector<int>& value, int, int) { (*at_)[name] = value; }
  template <typename Visit>
  void object(const char* name, const Visit& visit) {
    Json* outer = at_;
    (*outer)[name] = Json::object();
    at_ = &(*outer)[name];
    visit();
    at_ = outer;
  }
  template <typename T, typename Visit>
  void objects(const char* name, std::vector<T>& value, const Visit& visit) {
    Json* outer = at_;
    Json list = Json::array();
    for (T& one : value) {
      Json entry = Json::object();
      at_ = &entry;
      visit(one);
      list.push_back(entry);
    }
    at_ = outer;
    (*at_)[name] = list;
  }
  void shape(GeometrySpec& geometry) {
    if (!geometry.mesh.empty()) {
      (*at_)["mesh"] = geometry.mesh;
      return;
    }
    (*at_)["shape"] = geometry.shape;
    (*at_)["parameters"] = Json::object();
    for (const auto& [name, value] : geometry.parameters) (*at_)["parameters"][name] = value;
  }
  void motion(const GeometrySpec&, const MotionSpec& motion) {
    Json& entry = (*at_)["motion"] = Json::object();
    for (const auto& [name, ends] : motion.parameters) entry[name] = {ends[0], ends[1]};
    write_ends(entry, "rotate", motion.rotate);
    write_ends(entry, "translate", motion.translate);
  }

  Json root = Json::object();

 private:
  static void write_ends(Json& entry, const char* name, const std::vector<glm::dvec3>& ends) {
    for (const glm::dvec3& p : ends) entry[name].push_back({p.x, p.y, p.z});
  }

  Json* at_ = &root;
};

/// What no single field tells.
void check_together(const Spec& s, const std::string& source) {
  const auto fail = [&](const std::string& what) { throw Error(source + ": " + what); };
  if (s.name.empty() || s.name.size() > 100 ||
      s.name.find_first_of("/\\\n\r\t\"") != std::string::npos)
    fail("name: expected 1 to 100 characters without slashes, quotes or line breaks");
  if (s.cameras.layout == "rings" && s.cameras.rings.empty())
    fail("cameras.rings: expected one ring at least, found none");
  if (s.cameras.layout == "within" && s.cameras.turns.empty())
    fail("cameras.turns: expected one angle at least, found none");
  if (s.cameras.lowest > s.cameras.highest)
    fail("cameras.lowest: must not be above cameras.highest");
  if (s.cameras.turntable && (s.cameras.layout == "within" || s.cameras.layout == "hemisphere"))
    fail("cameras.turntable: the camera stands still; choose the layout rings or arc");
  if (s.cameras.turntable && s.cameras.roll != 0)
    fail("cameras.turntable: the camera stands still; set cameras.roll to 0");
  if (s.cameras.turntable && s.light.shadow_test != kShadowRays)
    fail("cameras.turntable: lights go around the object; set light.shadow_test to rays");
  if (s.cameras.distance <= 0) fail("cameras.distance: must be more than 0");
  for (std::size_t i = 0; i < s.light.directional.size(); ++i)
    if (length(s.light.directional[i].direction) < 1e-9)
      fail(concat("light.directional[", i, "].direction: must not be zero"));
  if (s.image.bits != 8 && s.image.bits != 16)
    fail(concat("image.bits: expected 8 or 16, found ", s.image.bits));
  if (s.image.bits == 16 && s.degradations.jpeg > 0)
    fail("image.bits: JPEG has 8 bits; set degradations.jpeg to 0 or image.bits to 8");
  if (!s.sheet.board.empty() && s.background.plates)
    fail("background.plates: a sheet stays where the object goes; leave out sheet or plates");
  if (s.degradations.mask_style == kAliased && s.degradations.mask_grow != 0)
    fail(
        "degradations.mask_style: aliased masks cannot grow or shrink; set degradations.mask_grow "
        "to 0 or choose cut");
  if (s.moment.frame >= s.moment.frames)
    fail(concat("moment.frame: the sequence has ", s.moment.frames,
                " frames, the last of which is ", s.moment.frames - 1));
  if (!s.motion.empty() && s.sheet.turn != glm::dvec3(0.0))
    fail("sheet.turn: what lies on another side does not move; leave out sheet.turn or motion");
  const int views = view_count(s.cameras);
  if (views > kMostViews)
    fail(concat("cameras: ", views, " views are more than ", kMostViews, "; ask for fewer"));
  const double rays =
      double(views) * s.image.width * s.image.height * s.image.samples * s.image.samples;
  if (rays > kMostRays)
    fail(concat("image: ", views, " views of ", s.image.width, " x ", s.image.height, " with ",
                s.image.samples, " x ", s.image.samples, " samples need ", rays,
                " rays, more than ", kMostRays, "; lower width, height or samples"));
  for (const std::vector<int>* list : {&s.degradations.mask_wrong, &s.degradations.missing_views})
    for (const int view : *list)
      if (view >= views)
        fail(concat("degradations: view ", view, " does not exist; the last one is ", views - 1));
}

}  // namespace

std::vector<std::string> shadow_tests() {
  std::vector<std::string> names{kShadowRays};
  for (const auto& technique : visibility::named_techniques()) names.push_back(technique.name);
  return names;
}

Spec parse_spec(const std::string& text, const std::string& source, const fs::path& folder) {
  nlohmann::json root;
  try {
    root = nlohmann::json::parse(text, json_level_guard(source), true, true);
  } catch (const nlohmann::json::exception& e) {
    throw Error(concat(source, ": not valid JSON: ", e.what()));
  }
  Spec spec;
  SpecReader reader(root, source);
  reader.ignore("result");
  // The geometry's defaults hang on the shape's name, so they are there when it is not.
  for (const ShapeParameter& p : find_shape(spec.geometry.shape)->parameters)
    spec.geometry.parameters[p.name] = p.value;
  visit_spec(reader, spec);
  reader.finish();
  check_together(spec, source);
  for (std::string* path : {&spec.geometry.mesh, &spec.sheet.board})
    if (!path->empty() && fs::path(*path).is_relative())
      *path = fs::absolute(folder / *path).lexically_normal().string();
  return spec;
}

Spec read_spec(const fs::path& file) {
  std::error_code failure;
  const auto size = fs::file_size(file, failure);
  if (failure || !fs::is_regular_file(file))
    throw Error(concat(file.string(), ": there is no such file; give a JSON spec, such as one of ",
                       "datasets/synthetic"));
  if (size > kLargestFile)
    throw Error(concat(file.string(), ": larger than any spec; give a JSON spec"));
  return parse_spec(read_whole_file(file), file.string(), file.parent_path());
}

std::string spec_text(const Spec& spec, const std::string& extra) {
  SpecWriter writer;
  Spec copy = spec;
  visit_spec(writer, copy);
  writer.root["result"] = Json::parse(extra);
  return writer.root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

int view_count(const CameraSpec& cameras) {
  if (cameras.layout != "rings") return cameras.count;
  long sum = 0;
  for (const Ring& ring : cameras.rings) sum += ring.count;
  return int(std::min<long>(sum, kMostViews + 1));
}

void set_view_count(CameraSpec& cameras, int count) {
  const int rings = cameras.layout == "rings" ? int(cameras.rings.size()) : 1;
  if (count < rings || count > kMostViews)
    throw UsageError(concat(option_word("views", count), ": expected a number from ", rings,
                            rings > 1 ? " (one for every ring)" : "", " to ", kMostViews));
  if (cameras.layout != "rings") {
    cameras.count = count;
    return;
  }
  const double before = view_count(cameras);
  int left = count;
  for (std::size_t i = 0; i < cameras.rings.size(); ++i) {
    Ring& ring = cameras.rings[i];
    const int rest = int(cameras.rings.size() - i) - 1;
    const int share = int(std::lround(count * ring.count / before));
    ring.count = rest == 0 ? left : std::clamp(share, 1, left - rest);
    left -= ring.count;
  }
}

}  // namespace photohull::synth
