// Contract of the drawing of textured meshes.
#ifndef PHOTOHULL_SHADERS_MESH_PAGES_H
#define PHOTOHULL_SHADERS_MESH_PAGES_H

#ifdef __cplusplus
namespace photohull::shaders {
#elif !defined(constexpr)
#define constexpr const
#endif

constexpr int kMeshPagesUnit = 8;  // behind those of visibility maps

#ifdef __cplusplus
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_MESH_PAGES_H
