// From where a preview shows the mesh.
#pragma once

#include <span>
#include <vector>

#include "core/mesh.h"
#include "core/prepared_view.h"

namespace photohull::render {

/// The view that shows the mesh largest and whole: its covered share of the image, times the share
/// of the mesh's vertices that lie on the image, squared, times its sharpness where it is less
/// sharp than others.
int choose_main_view(const TriMesh& mesh, std::span<const PreparedView> views);

/// Up to `count` further views, each as far in direction (seen from the mesh's centre) from those
/// before it as there is; views closer than 15 degrees to one of them add nothing and are left out.
std::vector<int> choose_other_views(const TriMesh& mesh, std::span<const PreparedView> views,
                                    int main, int count);

/// What of a camera's image plane a picture shows, and the depths in it.
struct Window {
  double x = 0, y = 0;           ///< top-left corner, pixels; pixel (0, 0) covers [-0.5, 0.5]
  double width = 0, height = 0;  ///< pixels
  double near = 0, far = 0;      ///< depths of the mesh, world units
};

/// Window around the mesh's projection, grown on each side by `margin` of its longer side. The
/// whole image when the mesh reaches behind the camera.
Window frame_mesh(const TriMesh& mesh, const Camera& camera, double margin);

}  // namespace photohull::render
