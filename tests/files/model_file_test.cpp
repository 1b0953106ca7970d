#include "files/model_file.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/files/bad_input.h"

namespace edgepose {
namespace {

/// A small closed solid: a box with a step, so that it has no symmetry.
Mesh stepped_box() {
  Mesh mesh;
  const auto box = [&](const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
    const auto first = static_cast<uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 8; ++corner)
      mesh.vertices.emplace_back(corner & 1 ? high.x() : low.x(), corner & 2 ? high.y() : low.y(),
                                 corner & 4 ? high.z() : low.z());
    const std::array<uint32_t, 3> faces[] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6},
                                             {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                                             {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    for (const auto& face : faces)
      mesh.triangles.push_back({first + face[0], first + face[1], first + face[2]});
  };
  box({0, 0, 0}, {0.06f, 0.04f, 0.03f});
  box({0, 0, 0.03f}, {0.02f, 0.025f, 0.05f});
  return mesh;
}

const Model& small_model() {
  static const Model model = [] {
    TrainOptions options;
    options.views = 40;
    options.sampling_step = 0.1f;
    return train_model(stepped_box(), "stepped box", options);
  }();
  return model;
}

TEST(ModelFile, SavesAndLoads) {
  const TemporaryFolder folder;
  save_model(folder / "box.model", small_model());
  const Model loaded = load_model(folder / "box.model");
  EXPECT_EQ(loaded.name(), "stepped box");
  EXPECT_EQ(loaded.diameter(), small_model().diameter());
  EXPECT_EQ(loaded.point_count(), small_model().point_count());
  EXPECT_TRUE(std::ranges::equal(loaded.block(), small_model().block()));
}

TEST(ModelFile, StaysReadableWhenTheFileIsReplaced) {
  const TemporaryFolder folder;
  save_model(folder / "box.model", small_model());
  const Model loaded = load_model(folder / "box.model");
  TrainOptions options;
  options.views = 40;
  options.sampling_step = 0.2f;
  save_model(folder / "box.model", train_model(stepped_box(), "coarser", options));
  EXPECT_EQ(loaded.name(), "stepped box");
  EXPECT_TRUE(std::ranges::equal(loaded.block(), small_model().block()));
  EXPECT_EQ(load_model(folder / "box.model").name(), "coarser");
}

TEST(ModelFile, RefusesWhatIsNoFile) {
  const TemporaryFolder folder;
  expect_input_error([&] { load_model(folder / "none.model"); },
                     {"none.model", "model file", "no such file"});
  expect_input_error([&] { load_model(folder.path()); }, {"a folder"});
  expect_input_error([&] { load_model(folder.write("e.model", "")); }, {"e.model", "empty file"});
  ASSERT_EQ(mkfifo((folder / "pipe.model").c_str(), 0600), 0);
  expect_input_error([&] { load_model(folder / "pipe.model"); }, {"not a regular file"});
  expect_input_error([&] { load_model(folder.write("t.model", "solid ascii stl\n")); }, {"t.model"});
}

std::string block_text() {
  const auto block = small_model().block();
  return std::string(reinterpret_cast<const char*>(block.data()), block.size());
}

TEST(ModelFile, RefusesTruncation) {
  const TemporaryFolder folder;
  const std::string good = block_text();
  for (const size_t size :
       {size_t{1}, size_t{7}, size_t{8}, size_t{64}, size_t{300}, good.size() / 2, good.size() - 1})
    expect_input_error([&] { load_model(folder.write("cut.model", good.substr(0, size))); },
                       {"cut.model", "expected"});
  expect_input_error([&] { load_model(folder.write("long.model", good + "x")); }, {"long.model", "expected"});
}

TEST(ModelFile, RefusesAFlippedBit) {
  const TemporaryFolder folder;
  const std::string good = block_text();
  std::mt19937_64 random(11);
  for (int round = 0; round < 300; ++round) {
    std::string bad = good;
    // Every byte of the header, then anywhere.
    const size_t at = round < 200 ? static_cast<size_t>(round) : static_cast<size_t>(random() % good.size());
    bad[at] = static_cast<char>(bad[at] ^ (1 << random() % 8));
    expect_input_error([&] { load_model(folder.write("bit.model", bad)); },
                       {"bit.model", "expected", "found"});
  }
}

TEST(ModelFile, RefusesAnotherVersion) {
  const TemporaryFolder folder;
  std::string other = block_text();
  other[8] = static_cast<char>(other[8] + 1);  // docs/model_file.md: the version follows the 8 bytes of magic
  expect_input_error([&] { load_model(folder.write("v.model", other)); }, {"v.model", "version"});
}

}  // namespace
}  // namespace edgepose
