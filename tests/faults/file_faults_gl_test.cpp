// Files that cannot be read or written, at any moment of a job.
#include <cerrno>

#include "fault_runs.h"
#include "support/effort.h"

namespace photohull::test {
namespace {

constexpr long kShortReads = -1, kEarlyEnd = -2;  // fault_shim.cpp

class FileFaults : public FaultScene {
 protected:
  /// Without --strict a photograph that cannot be read is left out: another right result.
  Arguments hull() const { return reconstruct({"--method", "hull", "--strict"}); }
  Arguments synthesize() const {
    write_bytes(path("spec.json"),
                R"({"image": {"width": 48, "height": 40, "samples": 1},
                    "cameras": {"layout": "hemisphere", "count": 3}, "truth_samples": 500})");
    return {"synthesize", path("spec.json"), "--out", out()};
  }
  Arguments convert() const { return {"convert", scene(), "--to", "colmap-text", "--out", out()}; }
  Fault reading(const std::string& call, long what, bool lasting = false) const {
    return {call, what, scene(), lasting};
  }
  Fault writing(const std::string& call, long what, bool lasting = false) const {
    return {call, what, out(), lasting};
  }
};

TEST_F(FileFaults, ShortReadsChangeNothing) {
  const Fault fault = reading("read", kShortReads, true);
  const Reference right = run_without(hull(), fault);
  const Finished run = run_with(hull(), fault, 1);
  EXPECT_EQ(run.code, 0) << run.err;
  expect_all_files(right.files);
}

TEST_F(FileFaults, ReadErrors) { expect_no_harm(hull(), reading("read", EIO), 3 * effort()); }

TEST_F(FileFaults, FilesThatEndEarly) {
  expect_no_harm(hull(), reading("read", kEarlyEnd), 3 * effort());
}

TEST_F(FileFaults, FilesThatCannotBeOpened) {
  expect_no_harm(hull(), reading("open", EACCES), 2 * effort());
}

TEST_F(FileFaults, FullDisk) {
  expect_no_harm(hull(), writing("write", ENOSPC, true), 3 * effort());
  expect_no_harm(synthesize(), writing("write", ENOSPC, true), 3 * effort());
  expect_no_harm(convert(), writing("write", ENOSPC, true), 2 * effort());
}

TEST_F(FileFaults, WritesThatFailOnce) {
  expect_no_harm(convert(), writing("write", EIO), 2 * effort());
}

TEST_F(FileFaults, FilesThatCannotBeMadeOrRenamed) {
  expect_no_harm(hull(), writing("open", EROFS), effort());
  expect_no_harm(hull(), writing("rename", EIO), effort());
  expect_no_harm(hull(), writing("sync", EIO), effort());
  expect_no_harm(synthesize(), writing("mkdir", ENOSPC), effort());
}

TEST_F(FileFaults, ARerunGivesTheRightFiles) {
  for (const Arguments& job : {hull(), synthesize()}) {
    const Fault fault = writing("write", ENOSPC, true);
    const Reference right = run_without(job, fault);
    // Of the synthesis this is in parallel tasks that cast rays, which once crashed after a
    // failure.
    EXPECT_EQ(run_with(job, fault, right.calls / 4).code, 1);
    succeed(job);
    expect_all_files(right.files);
    std::filesystem::remove_all(out());
  }
}

}  // namespace
}  // namespace photohull::test
