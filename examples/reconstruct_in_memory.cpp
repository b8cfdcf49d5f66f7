// Photographs that a program has in memory become a volume that it looks into; nothing is written.
#include <photohull/photohull.h>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

int main(int argc, char** argv) try {
  if (argc != 2) return std::fprintf(stderr, "usage: reconstruct_in_memory SCENE\n"), 2;
  // Stands for a capture program: pixels and cameras, without files behind them.
  const photohull::Photographs scene = photohull::load_photographs(argv[1]);
  std::vector<photohull::MemoryPhotograph> photographs;
  for (const photohull::SourceView& view : scene.scene.views)
    photographs.push_back({view.name, view.camera, scene.reader.image(view.image, 1), {}});

  photohull::ReconstructOptions options;
  options.resolution = 96;
  photohull::Progress progress;
  const photohull::Reconstruction result = photohull::Reconstructor(options).run(
      photohull::photographs_in_memory(std::move(photographs), scene.scene.box), progress);

  const photohull::SparseVolume& volume = result.volume;
  const double voxel = std::pow(volume.grid.voxel_size, 3);
  std::printf("volume %g cubic units, %zu triangles, verdict %s\n",
              double(volume.inside_voxels()) * voxel, result.mesh.triangles.size(),
              photohull::assess::to_string(result.report.verdict.verdict.level));
  const glm::ivec3 middle = volume.grid.voxels() / 2;
  std::printf("signed distance in the box's middle: %g voxels\n", volume.at(middle));
  return 0;
} catch (const photohull::Error& failure) {
  return std::fprintf(stderr, "%s\n", failure.what()), 1;
}
