/// Model files that must be refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace edgepose::test {
namespace {

void expect_refused_everywhere(const std::string& model, const std::vector<std::string>& words) {
  expect_refused(edgepose({"info", model}), words);
  expect_refused(edgepose({"match", model, "--depth", phantom_file("scene/depth.png"), "--intrinsics",
                           phantom_file("scene/camera.json")}),
                 words);
}

TEST(BadModel, CutShortOfAnotherVersionOrDamaged) {
  const Folder folder;
  const std::string sound = read_file(phantom_model());
  ASSERT_GT(sound.size(), 1000u);
  expect_refused_everywhere(folder / "no.model", {"no.model"});
  expect_refused_everywhere(folder.write("empty.model", ""), {"empty.model", "empty"});
  expect_refused_everywhere(folder.write("text.model", "a shopping list"), {"text.model"});
  for (const size_t size : {size_t{7}, size_t{100}, sound.size() / 2, sound.size() - 1}) {
    expect_refused_everywhere(folder.write("cut.model", sound.substr(0, size)),
                              {"cut.model", "expected", "found"});
  }
  expect_refused_everywhere(folder.write("long.model", sound + "x"), {"long.model"});
  std::string version = sound;
  version[8] = static_cast<char>(version[8] + 1);
  expect_refused_everywhere(folder.write("version.model", version), {"version.model", "version"});
  for (const size_t at : {size_t{40}, size_t{200}, sound.size() / 3, sound.size() - 5}) {
    std::string flipped = sound;
    flipped[at] = static_cast<char>(flipped[at] ^ 16);
    expect_refused_everywhere(folder.write("flipped.model", flipped), {"flipped.model", "expected", "found"});
  }
}

TEST(BadModel, TrainingReplacesAModelAtOnceOrNotAtAll) {
  const Folder folder;
  const std::string model = folder.write("m.model", "the old one");
  expect_refused(edgepose({"train", folder.write("bad.ply", "ply\n"), "-o", model}), {"bad.ply"});
  EXPECT_EQ(read_file(model), "the old one");
  const Finished run = edgepose({"train", folder.write("good.ply", bracket_ply(100)), "-o", model});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(folder.files(), testing::ElementsAre("bad.ply", "good.ply", "m.model"));
  EXPECT_EQ(edgepose({"info", model}).code, 0);
}

}  // namespace
}  // namespace edgepose::test
