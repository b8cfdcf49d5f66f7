// What the system lets this process have, beside what any job needs.
#pragma once

namespace photohull {

/// Throws Error where the system's limits (RLIMIT_DATA, RLIMIT_AS) leave too little for a software
/// graphics device, whose threads end the whole process when they get no memory. `threads` that
/// will be started, 0: one for each core.
void check_process_limits(int threads);

}  // namespace photohull
