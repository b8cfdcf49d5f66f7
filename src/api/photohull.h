// photohull as a library: calibrated photographs in, volume and mesh out.
//
//   photohull::ReconstructOptions options;
//   options.resolution = 256;
//   photohull::Progress progress;
//   const photohull::Photographs photographs = photohull::load_photographs("scan/transforms.json");
//   const auto result = photohull::Reconstructor(options).run(photographs, progress);
//   photohull::write(result, "out/scan", progress);
//
// Frames and units are said in core/camera.h. Failures are thrown as Error, whose kind() programs
// may act on. Derive from Progress to be told what is done, and give it a CancellationToken to
// stop.
#pragma once

#include "core/error.h"
#include "core/image.h"
#include "core/option_word.h"
#include "core/progress.h"
#include "io/load_scene.h"
#include "io/mesh/write_mesh.h"
#include "pipeline/photographs.h"
#include "pipeline/reconstruct.h"
#include "pipeline/write_results.h"

namespace photohull {

using io::LoadSceneOptions;
using pipeline::load_photographs;
using pipeline::MemoryPhotograph;
using pipeline::Method;
using pipeline::Photographs;
using pipeline::photographs_in_memory;
using pipeline::Quality;
using pipeline::Reconstruction;
using pipeline::ReconstructOptions;
using pipeline::Reconstructor;
using pipeline::Report;
using pipeline::write;

}  // namespace photohull
