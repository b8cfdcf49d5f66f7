#include "batch/pieces.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/atomic_file.h"
#include "core/error.h"
#include "support/scratch_folder.h"

namespace photohull::batch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string message_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const Error& e) {
    return e.what();
  }
  return "nothing thrown";
}

std::vector<Piece> read(const std::string& text) {
  const ScratchFolder folder;
  write_atomically(folder / "list.txt", text);
  return read_piece_list(folder / "list.txt");
}

TEST(Pieces, AreCalledAsTheirScenesFolders) {
  std::vector<std::string> names;
  for (const Piece& piece :
       pieces_of_scenes({"scans/plant_7", "scans/plant_8/", "rig/transforms.json", "a.json",
                         "../x/sparse/0", "./one/../two"}))
    names.push_back(piece.name);
  EXPECT_THAT(names, ElementsAre("plant_7", "plant_8", "rig", "a", "0", "two"));
}

TEST(Pieces, OfAListHaveWordsAndNames) {
  const std::vector<Piece> pieces = read(
      "# night of the 3rd\n"
      "\n"
      "scans/a\n"
      "  \"scans/with space\" --box \"0 0 0 1 1 1\" --name b\r\n"
      "scans/c --name=d --resolution 64\n"
      "e ''");
  ASSERT_EQ(pieces.size(), 4u);
  EXPECT_EQ(pieces[0].name, "a");
  EXPECT_THAT(pieces[0].words, ElementsAre("scans/a"));
  EXPECT_EQ(pieces[1].name, "b");
  EXPECT_THAT(pieces[1].words, ElementsAre("scans/with space", "--box", "0 0 0 1 1 1"));
  EXPECT_THAT(pieces[1].from, HasSubstr("list.txt line 4"));
  EXPECT_EQ(pieces[2].name, "d");
  EXPECT_THAT(pieces[2].words, ElementsAre("scans/c", "--resolution", "64"));
  EXPECT_THAT(pieces[3].words, ElementsAre("e", ""));
}

TEST(Pieces, FaultsOfAListNameTheLine) {
  EXPECT_THAT(message_of([] { read("a\n\"b"); }), HasSubstr("line 2: a quotation mark"));
  EXPECT_THAT(message_of([] { read("a --name"); }), HasSubstr("line 1: --name has no name"));
  EXPECT_THAT(message_of([] { read("\n--box 1"); }), HasSubstr("line 2: a line begins with"));
  EXPECT_THAT(message_of([] { read("--name x"); }), HasSubstr("a line begins with a scene"));
  EXPECT_THAT(message_of([] { read_piece_list("/nowhere/list.txt"); }),
              HasSubstr("/nowhere/list.txt"));
}

TEST(Pieces, NamesAreUniqueAndNamesOfFolders) {
  EXPECT_THAT(message_of([] { check_pieces({}); }), HasSubstr("no scene"));
  EXPECT_THAT(message_of([] {
                check_pieces(pieces_of_scenes({"x/a", "y/a"}));
              }),
              testing::AllOf(HasSubstr("scene x/a and scene y/a"), HasSubstr("called 'a'")));
  for (const std::string name : {"", "..", ".hidden", "a/b"})
    EXPECT_THAT(message_of([&] {
                  check_pieces({{name, {"s"}, {}, "line 1"}});
                }),
                HasSubstr("cannot be the name of a folder"))
        << name;
  EXPECT_EQ(message_of([] { check_pieces(pieces_of_scenes({"a", "b"})); }), "nothing thrown");
}

TEST(Frames, AreReadWithTheirDigits) {
  const auto frames = parse_frames("0008-0010");
  ASSERT_TRUE(frames);
  EXPECT_EQ(frames->first, 8);
  EXPECT_EQ(frames->last, 10);
  EXPECT_EQ(frames->text(9), "0009");
  EXPECT_EQ(parse_frames("7")->last, 7);
  EXPECT_EQ(parse_frames("98-101")->text(100), "100");
  for (const std::string text : {"", "-3", "3-", "5-4", "1-2-3", "a-b", "1-2 ", "0x1-2",
                                 "0-99999999999", "0-2000000", "1.5-2"})
    EXPECT_FALSE(parse_frames(text)) << text;
}

TEST(Frames, MakePiecesOfTheirOwn) {
  const auto frames = *parse_frames("09-11");
  const std::vector<Piece> one =
      pieces_of_frames({{"rig", {"rig.json", "--images", "f/{frame}/{frame}"}, {}, "x"}}, frames);
  ASSERT_EQ(one.size(), 3u);
  EXPECT_EQ(one[0].name, "09");
  EXPECT_EQ(one[2].frame, "11");
  EXPECT_THAT(one[1].words, ElementsAre("rig.json", "--images", "f/10/10"));
  const std::vector<Piece> two =
      pieces_of_frames({{"a", {"a"}, {}, "x"}, {"b", {"b"}, {}, "x"}}, frames);
  ASSERT_EQ(two.size(), 6u);
  EXPECT_EQ(two[4].name, "b.10");
}

TEST(Precedents, FramesFollowEachOtherInChains) {
  const std::vector<Piece> frames =
      pieces_of_frames(pieces_of_scenes({"x/a", "x/b"}), {.first = 3, .last = 7, .digits = 1});
  ASSERT_EQ(frames.size(), 10u);
  for (const Precedent& one : precedents(frames, 1)) EXPECT_FALSE(one.follow || one.rig);
  const std::vector<Precedent> all = precedents(frames, 2);
  for (const std::size_t first : {0u, 5u}) {
    EXPECT_FALSE(all[first].follow || all[first].rig) << "the first of a sequence";
    for (std::size_t i = 1; i < 5; ++i) {
      EXPECT_EQ(all[first + i].rig, frames[first].name);
      EXPECT_EQ(all[first + i].follow.has_value(), i % 2 == 1) << i;
    }
    EXPECT_EQ(all[first + 3].follow, frames[first + 2].name);
  }
  for (const Precedent& one : precedents(pieces_of_scenes({"a", "b"}), 9))
    EXPECT_FALSE(one.follow || one.rig) << "they are no frames";
}

}  // namespace
}  // namespace photohull::batch
