// JSON read with a path in every message. Internal to synth.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "synth/spec.h"

namespace photohull::synth {

/// Reads the fields of one JSON object at a time; fields that are absent keep their values. The
/// visitor of spec_visit.h.
class SpecReader {
 public:
  SpecReader(const nlohmann::json& root, std::string source);

  void number(const char* name, double& value, double low, double high);
  void integer(const char* name, int& value, int low, int high);
  void seed(const char* name, std::uint64_t& value);
  void flag(const char* name, bool& value);
  void text(const char* name, std::string& value);
  void choice(const char* name, std::string& value, std::vector<std::string> choices);
  template <typename Vector>
  void vector(const char* name, Vector& value, double low, double high) {
    if (const auto* j = take(name)) {
      const std::string place = path(name);
      const std::vector<double> all = number_list(*j, place, low, high);
      if (int(all.size()) != int(Vector::length()))
        fail(place, "expected " + std::to_string(Vector::length()) + " numbers, found " +
                        std::to_string(all.size()));
      for (int i = 0; i < int(Vector::length()); ++i) value[i] = all[std::size_t(i)];
    }
  }
  void numbers(const char* name, std::vector<double>& value, double low, double high);
  void integers(const char* name, std::vector<int>& value, int low, int high);
  template <typename Visit>
  void object(const char* name, const Visit& visit) {
    if (const auto* j = take(name)) inside(*j, path(name), visit);
  }
  template <typename T, typename Visit>
  void objects(const char* name, std::vector<T>& value, const Visit& visit) {
    const auto* j = take(name);
    if (!j) return;
    const std::string place = path(name);
    check_list(*j, place);
    value.assign(j->size(), T{});
    for (std::size_t i = 0; i < j->size(); ++i)
      inside((*j)[i], place + "[" + std::to_string(i) + "]", [&] { visit(value[i]); });
  }
  void shape(GeometrySpec& geometry);
  void motion(const GeometrySpec& geometry, MotionSpec& motion);
  /// A field to pass over.
  void ignore(const char* name) { take(name); }
  /// Throws for fields that nobody asked for.
  void finish() const;

 private:
  const nlohmann::json* take(const char* name);
  std::string path(const std::string& name) const;
  [[noreturn]] void fail(const std::string& place, const std::string& what) const;
  double checked(const nlohmann::json& j, const std::string& place, double low, double high) const;
  int checked_integer(const nlohmann::json& j, const std::string& place, int low, int high) const;
  std::vector<double> number_list(const nlohmann::json& j, const std::string& place, double low,
                                  double high) const;
  /// Throws unless a motion has two ends.
  void check_ends(const nlohmann::json& j, const std::string& place) const;
  void ends(const char* name, std::vector<glm::dvec3>& value, double low, double high);
  void check_list(const nlohmann::json& j, const std::string& place) const;
  void enter(const nlohmann::json& j, const std::string& place);
  template <typename Visit>
  void inside(const nlohmann::json& j, const std::string& place, const Visit& visit) {
    SpecReader outer = *this;
    enter(j, place);
    visit();
    finish();
    *this = outer;
  }

  const nlohmann::json* object_;
  std::string source_, path_;
  std::set<std::string> known_;
};

}  // namespace photohull::synth
