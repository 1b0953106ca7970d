// Every small seed file, damaged in every place: the readers may take it or refuse it, nothing else.
#include <gtest/gtest.h>

#include <random>

#include "files/mesh_file.h"
#include "files/mesh_health.h"
#include "tests/files/bad_input.h"
#include "tests/files/mesh_samples.h"

namespace edgepose {
namespace {

class DamagedMesh : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const std::filesystem::path folder = std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "fuzz" / "corpus";
    for (const auto& file : std::filesystem::directory_iterator(folder / (GetParam() + "_fuzz"))) {
      if (file.path().extension() == "." + GetParam()) seeds_.push_back(file_content(file.path()));
    }
    ASSERT_GE(seeds_.size(), 4u) << "seed files missing in " << folder;
  }

  /// True if a usable mesh came out.
  bool try_one(const std::string& content) const {
    const std::string name = "damaged." + GetParam();
    try {
      const Mesh mesh = parse_text(content, name, LengthUnit::kMillimetre);
      MeshHealth health = check_mesh(mesh);
      const Mesh mended = mend_mesh(mesh, health, name);
      for (const Eigen::Vector3f& vertex : mended.vertices) EXPECT_TRUE(vertex.allFinite());
      for (const Eigen::Vector3f& normal : mended.normals) EXPECT_NEAR(normal.norm(), 1, 1e-3);
      for (const auto& triangle : mended.triangles) {
        for (const uint32_t vertex : triangle) EXPECT_LT(vertex, mended.vertices.size());
      }
      return true;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      EXPECT_EQ(std::string(error.what()).find(name), 0u) << error.what();
      return false;
    }  // anything else fails the test
  }

  std::vector<std::string> seeds_;
};

TEST_P(DamagedMesh, SeedsAreSound) {
  for (const std::string& seed : seeds_) {
    if (seed.find("nan") == std::string::npos) {
      EXPECT_TRUE(try_one(seed));
      continue;
    }
    EXPECT_FALSE(try_one(seed)) << "no model has points that are not finite";
    const auto bytes = std::as_bytes(std::span(seed));
    EXPECT_NO_THROW(parse_cloud(bytes, "scene." + GetParam(), LengthUnit::kMillimetre));
  }
}

TEST_P(DamagedMesh, CutShortAnywhere) {
  int refused = 0, cuts = 0;
  for (const std::string& seed : seeds_) {
    for (size_t size = 0; size < seed.size(); ++size, ++cuts) refused += !try_one(seed.substr(0, size));
  }
  // OBJ has no end mark; the others notice nearly every cut.
  EXPECT_GT(refused, GetParam() == "obj" ? cuts / 2 : cuts * 9 / 10);
}

TEST_P(DamagedMesh, AnyByteChanged) {
  std::mt19937 random(1);
  for (const std::string& seed : seeds_) {
    for (size_t i = 0; i < seed.size(); ++i) {
      std::string content = seed;
      for (const int value : {0, 255, content[i] ^ (1 << (random() % 8)), static_cast<int>(random() % 256)}) {
        content[i] = static_cast<char>(value);
        try_one(content);
      }
    }
  }
}

TEST_P(DamagedMesh, SeveralKindsOfDamageAtOnce) {
  std::mt19937_64 random(2);
  int taken = 0;
  for (int round = 0; round < 2000; ++round) taken += try_one(damaged(seeds_[round % seeds_.size()], random));
  EXPECT_GT(taken, 0);  // else the damage would be so crude that nothing is tested
}

INSTANTIATE_TEST_SUITE_P(Formats, DamagedMesh, testing::Values("ply", "stl", "obj", "pcd"),
                         [](const auto& format) { return format.param; });

}  // namespace
}  // namespace edgepose
