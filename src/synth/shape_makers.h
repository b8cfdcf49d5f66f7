// The shapes' builders. Internal to synth.
#pragma once

#include "synth/shapes.h"

namespace photohull::synth {

// shapes_turned.cpp
TriMesh make_sphere(const ShapeValues& v);
TriMesh make_torus(const ShapeValues& v);
TriMesh make_pawn(const ShapeValues& v);
TriMesh make_bowl(const ShapeValues& v);
TriMesh make_folds(const ShapeValues& v);

// shapes_flat.cpp
TriMesh make_block(const ShapeValues& v);
TriMesh make_steps(const ShapeValues& v);
TriMesh make_arch(const ShapeValues& v);
TriMesh make_rods(const ShapeValues& v);
TriMesh make_room(const ShapeValues& v);

// shapes_grown.cpp
TriMesh make_leaves(const ShapeValues& v);
TriMesh make_plant(const ShapeValues& v);

// shapes_wire.cpp
TriMesh make_seedling(const ShapeValues& v);
TriMesh make_cage(const ShapeValues& v);
TriMesh make_wheel(const ShapeValues& v);

// shapes_figure.cpp
TriMesh make_figure(const ShapeValues& v);

// shapes_implicit.cpp
TriMesh make_gyroid(const ShapeValues& v);

}  // namespace photohull::synth
