// Surfaces that are known exactly.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "core/mesh.h"

namespace photohull::synth {

/// A number that shapes a shape.
struct ShapeParameter {
  const char* name;
  double value;      ///< default
  double low, high;  ///< legal range, both ends included
  const char* help;
};

using ShapeValues = std::map<std::string, double>;

/// A built-in solid, about two units large, standing upright along z.
struct Shape {
  const char* name;
  const char* summary;
  std::vector<ShapeParameter> parameters;
  TriMesh (*build)(const ShapeValues& values);
};

/// All of them, in alphabetical order.
const std::vector<Shape>& shapes();

/// Nothing where there is no shape of this name.
const Shape* find_shape(const std::string& name);

/// The shape with `values` in place of its defaults. The mesh is closed (every edge belongs to two
/// triangles, run through in opposite senses), its parts do not meet, its vertices lie on the
/// surface of the formula to single precision, and its facets deviate from that by less than 1e-4
/// of the shape's diagonal. Unknown names or values out of range are the programmer's error.
TriMesh make_shape(const Shape& shape, const ShapeValues& values = {});

/// Implicit function whose zero set is the gyroid shape's surface; negative inside. World units
/// near the surface, roughly.
double gyroid_field(const glm::dvec3& p, const ShapeValues& values);

/// The same of the figure shape's surface.
double figure_field(const glm::dvec3& p, const ShapeValues& values);

}  // namespace photohull::synth
