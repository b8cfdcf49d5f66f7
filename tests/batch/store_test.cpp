#include "batch/store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "core/read_file.h"
#include "support/scratch_folder.h"

namespace photohull::batch {
namespace {

namespace fs = std::filesystem;

TEST(Store, OneHoldsAPieceAtATime) {
  const ScratchFolder folder;
  const Store one(folder / "out"), other(folder / "out");
  auto held = one.hold("a");
  ASSERT_TRUE(held);
  EXPECT_FALSE(other.hold("a"));
  EXPECT_TRUE(other.hold("b"));
  held.reset();
  EXPECT_TRUE(other.hold("a"));
}

TEST(Store, KeepsWhatBecameOfPieces) {
  const ScratchFolder folder;
  const Store store(folder / "out");
  EXPECT_FALSE(store.outcome("a"));
  const auto held = store.hold("a");
  store.set_outcome("a", {.identity = "7", .verdict = "good"});
  EXPECT_EQ(Store(folder / "out").outcome("a")->identity, "7");
  write_atomically(folder / "out/.photohull-batch/a/outcome.json", "{\"identity\":");
  EXPECT_FALSE(store.outcome("a"));
}

TEST(Store, KnowsItsPiecesByTheirFolders) {
  const ScratchFolder folder;
  const Store store(folder / "out");
  EXPECT_EQ(store.piece_of(folder / "out/0007"), "0007");
  EXPECT_EQ(store.piece_of(folder / "x/../out/./0007"), "0007");
  EXPECT_FALSE(store.piece_of(folder / "elsewhere/0007"));
  EXPECT_FALSE(store.piece_of({}));
}

TEST(Store, PublishesVolumesOfASequence) {
  const ScratchFolder folder;
  const Store store(folder / "out");
  fs::create_directories(store.results("0007"));
  for (const std::string bytes : {"first", "second"}) {
    write_atomically(store.results("0007") / "volume.vdb", bytes);
    store.publish("0007", "volume.vdb", "volume.0007.vdb");
    store.publish("0007", "volume.vdb", "volume.0007.vdb");
    EXPECT_EQ(read_whole_file(folder / "out/volume.0007.vdb"), bytes);
  }
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder / "out"))
    names.push_back(entry.path().filename());
  EXPECT_THAT(names, testing::UnorderedElementsAre(".photohull-batch", "0007", "volume.0007.vdb"));
  EXPECT_THROW(store.publish("0008", "volume.vdb", "volume.0008.vdb"), Error);
}

TEST(Store, SaysWhichFolderCannotBeMade) {
  const ScratchFolder folder;
  write_atomically(folder / "file", "x");
  EXPECT_THAT([&] { Store(folder / "file"); },
              testing::ThrowsMessage<Error>(testing::HasSubstr((folder / "file").string())));
}

}  // namespace
}  // namespace photohull::batch
