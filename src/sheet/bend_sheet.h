// A sheet that is bent a little.
#pragma once

namespace photohull {

/// A place of the flat sheet on the bent one: raised by a form of second order, and drawn in so
/// that lines through the origin keep their length (to second order). `bend`: heights at the
/// distance `reach` from the origin, by x^2, x y and y^2. Lengths in any unit; p: x, y, z.
template <typename T>
void bend_sheet(const T* bend, double reach, T* p) {
  const T x = p[0] / reach, y = p[1] / reach;
  const T rise = bend[0] * x * x + bend[1] * x * y + bend[2] * y * y;
  const double r2 = reach * reach;
  const T squared = (x * x + y * y) * r2 + 1e-12;
  const T drawn = 1.0 - (2.0 / 3.0) * rise * rise / squared;
  p[0] *= drawn, p[1] *= drawn, p[2] += rise;
}

}  // namespace photohull
