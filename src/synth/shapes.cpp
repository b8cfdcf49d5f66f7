#include "synth/shapes.h"

#include <algorithm>
#include <string_view>

#include "core/error.h"
#include "synth/shape_makers.h"

namespace photohull::synth {

namespace {

std::vector<Shape> flat_shapes() {
  return {
      {"arch",
       "a wall with a round-headed passage",
       {{"width", 2.0, 0.1, 100, "of the wall"},
        {"height", 1.5, 0.1, 100, "of the wall"},
        {"depth", 0.7, 0.01, 100, "of the wall"},
        {"passage", 0.55, 0.05, 0.9, "width of the passage as a share of the wall's"}},
       make_arch},
      {"block",
       "a machined block: sharp edges, a step, a round hole through it",
       {{"width", 2.0, 0.1, 100, "along x"},
        {"depth", 1.2, 0.1, 100, "along y"},
        {"height", 1.3, 0.1, 100, "along z, of the high half"},
        {"step", 0.5, 0.05, 0.95, "height of the low half as a share of the high one's"},
        {"hole", 0.55, 0.05, 0.95, "diameter of the hole as a share of the high half's top"}},
       make_block},
      {"rods",
       "thin rods, plates and a ring standing before a slab",
       {{"width", 2.0, 0.1, 100, "of the slab"},
        {"height", 1.5, 0.1, 100, "of the slab"},
        {"gap", 0.3, 0.02, 2, "from the slab to the rods as a share of the width"},
        {"count", 6, 1, 40, "of rods"},
        {"rod", 0.006, 0.0005, 0.012, "radius of the thickest rod as a share of the width"},
        {"plate", 0.012, 0.001, 0.04, "thickness of the plates as a share of the width"}},
       make_rods},
      {"room",
       "a room to be photographed from within: walls, floor, ceiling, a table, a cupboard, a "
       "column",
       {{"width", 2.0, 0.1, 100, "along x, inside"},
        {"depth", 1.6, 0.1, 100, "along y, inside"},
        {"height", 1.0, 0.1, 100, "along z, inside"},
        {"wall", 0.05, 0.005, 0.5, "thickness as a share of the width"}},
       make_room},
      {"steps",
       "a flight of stairs",
       {{"count", 5, 1, 40, "of steps"},
        {"width", 1.2, 0.1, 100, "of a step"},
        {"run", 0.4, 0.01, 100, "depth of a step"},
        {"rise", 0.3, 0.01, 100, "height of a step"}},
       make_steps},
  };
}

std::vector<Shape> turned_shapes() {
  return {
      {"bowl",
       "a deep bowl, open to the top",
       {{"radius", 1.0, 0.01, 100, "at the rim, outside"},
        {"height", 1.3, 0.01, 100, "of the rim above the ground"},
        {"thickness", 0.12, 0.005, 0.5, "of the wall as a share of the radius"}},
       make_bowl},
      {"folds",
       "a twisted body with deep folds that lean over and hide their own ground",
       {{"radius", 1.0, 0.01, 100, "mean, at the waist"},
        {"height", 2.4, 0.01, 100, "along z"},
        {"count", 7, 2, 24, "of folds around the body"},
        {"depth", 0.4, 0, 0.6, "of the folds as a share of the radius"},
        {"lean", 0.7, -2, 2, "how far the folds turn with their height, radians a radius"},
        {"twist", 0.8, -4, 4, "turn from waist to top, radians"}},
       make_folds},
      {"pawn",
       "a turned chess piece: collar, neck, grooves",
       {{"radius", 0.5, 0.01, 100, "of the foot"}, {"height", 1.8, 0.01, 100, "along z"}},
       make_pawn},
      {"sphere", "a ball", {{"radius", 1.0, 0.001, 1000, "of the ball"}}, make_sphere},
      {"torus",
       "a ring",
       {{"radius", 1.0, 0.01, 1000, "of the ring's middle line"},
        {"tube", 0.4, 0.01, 0.95, "radius of the tube as a share of the ring's"}},
       make_torus},
  };
}

std::vector<Shape> grown_shapes() {
  return {
      {"leaves",
       "a stack of thin leaves that overlap without touching, around a stalk",
       {{"count", 14, 1, 60, "of leaves"},
        {"length", 1.0, 0.1, 100, "of a leaf"},
        {"width", 0.45, 0.05, 0.8, "of a leaf as a share of its length"},
        {"spacing", 0.1, 0.02, 1, "from leaf to leaf as a share of the length"},
        {"thickness", 0.012, 0.004, 0.02, "as a share of the length"},
        {"droop", 0.35, 0, 1, "of a leaf's tip as a share of the length"}},
       make_leaves},
      {"plant",
       "stem, leaves and branches as thin as a pixel or two at the usual camera",
       {{"height", 2.0, 0.1, 100, "of the stem"},
        {"branches", 16, 1, 60, "along the stem"},
        {"stem", 0.016, 0.004, 0.03, "radius at the ground as a share of the height"},
        {"branch", 0.0025, 0.0005, 0.008, "radius as a share of the height"},
        {"leaf", 0.16, 0.02, 0.3, "length of a leaf as a share of the height"}},
       make_plant},
  };
}

std::vector<Shape> wire_shapes() {
  return {
      {"cage",
       "a wire bird cage on a round plate",
       {{"height", 2.0, 0.1, 100, "of the dome above the ground"},
        {"radius", 0.28, 0.1, 0.45, "of the cage as a share of the height"},
        {"wires", 16, 3, 48, "from the plate to the dome's top"},
        {"rings", 4, 0, 12, "across the wires"},
        {"wire", 0.001, 0.00005, 0.002, "radius as a share of the height"}},
       make_cage},
      {"seedling",
       "a tall stem with side shoots and small leaves, all thinner than a pixel or two",
       {{"height", 2.0, 0.1, 100, "of the stem"},
        {"stem", 0.00157, 0.00005, 0.01, "radius at the ground as a share of the height"},
        {"tip", 0.25, 0.05, 1, "radius at the top as a share of that at the ground"},
        {"shoots", 10, 0, 40, "along the upper four fifths of the stem"},
        {"shoot", 0.00039, 0.00005, 0.003,
         "radius at the stem as a share of the height; three fifths of it at the end"},
        {"reach", 0.12, 0.02, 0.25, "length of a shoot as a share of the height"},
        {"leaf", 0.05, 0.01, 0.1,
         "length of the leaves, on two shoots of three, as a share of it"}},
       make_seedling},
      {"wheel",
       "a bicycle wheel standing upright: tyre, rim, hub and spokes",
       {{"diameter", 2.0, 0.1, 100, "of the tyre, outside"},
        {"tyre", 0.02, 0.005, 0.05, "radius of the tyre's tube as a share of the diameter"},
        {"spokes", 28, 2, 60, "in all, an even number, to either end of the hub in turn"},
        {"spoke", 0.0005, 0.00005, 0.0015, "radius as a share of the diameter"}},
       make_wheel},
  };
}

std::vector<Shape> implicit_shapes() {
  return {
      {"figure",
       "a person who dances on one leg, on a round plinth; the pose is that of a phase",
       {{"phase", 0.1, 0, 1, "of the dance; 1 is the pose of 0 again"},
        {"swing", 35, 0, 60, "degrees that arms and the free leg swing to either side"}},
       make_figure},
      {"gyroid",
       "a ball cut from the sheet of a gyroid: curved walls, tunnels through and through",
       {{"radius", 1.0, 0.01, 100, "of the ball"},
        {"cells", 1.5, 0.5, 3, "periods of the gyroid along the ball's diameter"},
        {"thickness", 0.35, 0.1, 0.8, "of the wall: |sin x cos y + ...| below it is solid"}},
       make_gyroid},
  };
}

}  // namespace

const std::vector<Shape>& shapes() {
  static const std::vector<Shape> all = [] {
    std::vector<Shape> list;
    for (const auto group :
         {flat_shapes, turned_shapes, grown_shapes, wire_shapes, implicit_shapes}) {
      const std::vector<Shape> some = group();
      list.insert(list.end(), some.begin(), some.end());
    }
    std::sort(list.begin(), list.end(), [](const Shape& a, const Shape& b) {
      return std::string_view(a.name) < std::string_view(b.name);
    });
    return list;
  }();
  return all;
}

const Shape* find_shape(const std::string& name) {
  const auto found = std::find_if(shapes().begin(), shapes().end(),
                                  [&](const Shape& s) { return s.name == name; });
  return found == shapes().end() ? nullptr : &*found;
}

TriMesh make_shape(const Shape& shape, const ShapeValues& values) {
  ShapeValues complete;
  for (const ShapeParameter& p : shape.parameters) complete[p.name] = p.value;
  for (const auto& [name, value] : values) {
    PHOTOHULL_CHECK(complete.count(name) == 1);
    complete[name] = value;
  }
  return shape.build(complete);
}

}  // namespace photohull::synth
