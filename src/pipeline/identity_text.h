// Words that identities of jobs are made of (job_identity.h, camera_cache.h, mask_cache.h).
#pragma once

#include <filesystem>
#include <ostream>

#include "core/box.h"
#include "core/camera.h"
#include "core/scene.h"

namespace photohull::pipeline {

inline constexpr int kIdentityDigits = 17;  ///< that tell any two numbers apart

/// The version of the program, and its file, for versions change less often than programs.
void add_program(std::ostream& out);
/// Size and time of a file's last change; nothing of a file that is not there.
void add_file(const std::filesystem::path& path, std::ostream& out);
void add_box(const Box& box, std::ostream& out);
void add_camera(const Camera& camera, std::ostream& out);
void add_distortion(const Distortion& distortion, std::ostream& out);

}  // namespace photohull::pipeline
