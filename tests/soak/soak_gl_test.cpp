// Scene after scene in one process: what each takes it must give back.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <fstream>
#include <numeric>

#include "core/error.h"
#include "eval/evaluate.h"
#include "io/mesh/read_mesh.h"
#include "pipeline/write_results.h"
#include "random_scene.h"
#include "support/effort.h"
#include "support/scratch_folder.h"
#include "synth/synthesize.h"

namespace photohull::test {
namespace {

constexpr int kScenes = 10;
constexpr double kMostGrowth = 16;     // MiB resident
constexpr double kMostHeapGrowth = 2;  // MiB allocated and not freed

/// Of the process, without what the allocator keeps for the next scene.
double resident_mib() {
  ::malloc_trim(0);
  long total = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> total >> resident;
  return double(resident) * double(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// What is allocated on the heap and not freed.
double heap_mib() {
  const auto info = ::mallinfo2();
  return double(info.uordblks + info.hblkhd) / (1 << 20);
}

/// A scene from spec to judgement; false where the program says that it cannot be reconstructed.
bool run_scene(std::uint64_t number) {
  const ScratchFolder folder;
  Progress silent;
  synth::synthesize(random_spec(number), folder / "scene", silent);
  try {
    pipeline::reconstruct_to_folder(
        random_job(number), pipeline::load_photographs(folder / "scene"), folder / "out", silent);
  } catch (const Error& e) {
    std::printf("scene %llu: %s\n", static_cast<unsigned long long>(number), e.what());
    return false;
  }
  const TriMesh mesh = read_mesh(folder / "out/mesh.ply", Faces::kNeeded);
  eval::EvaluateOptions options;
  options.samples = 2000;
  options.columns = 32;
  eval::evaluate(mesh, eval::read_truth(folder / "scene"), options, &silent);
  return true;
}

double mean(const std::vector<double>& values, std::size_t first, std::size_t last) {
  return std::accumulate(values.begin() + long(first), values.begin() + long(last), 0.0) /
         double(last - first);
}

TEST(Soak, MemoryDoesNotGrow) {
  std::vector<double> resident, heap;
  int done = 0;
  const int scenes = kScenes * effort();
  for (int i = 1; i <= scenes; ++i) {
    done += run_scene(std::uint64_t(i));
    resident.push_back(resident_mib());
    heap.push_back(heap_mib());
    if (i % std::max(1, scenes / 10) != 0) continue;
    std::printf("%d scenes: %.0f MiB resident, %.1f MiB of heap\n", i, resident.back(),
                heap.back());
    std::fflush(stdout);
  }
  // The first third loads libraries and fills caches, so it does not count.
  const auto growth = [](const std::vector<double>& values) {
    const std::size_t third = values.size() / 3, last = values.size();
    return mean(values, last - third, last) - mean(values, third, 2 * third);
  };
  std::printf(
      "%d of %d scenes reconstructed; from the middle third to the last %+.1f MiB resident, "
      "%+.2f MiB of heap\n",
      done, scenes, growth(resident), growth(heap));
  EXPECT_LT(growth(resident), kMostGrowth);
  EXPECT_LT(growth(heap), kMostHeapGrowth);
  EXPECT_GT(done, scenes * 3 / 4);
}

}  // namespace
}  // namespace photohull::test
