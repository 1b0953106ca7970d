#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/mesh_file.h"
#include "tests/files/bad_input.h"
#include "tests/files/mesh_samples.h"

namespace edgepose {
namespace {

using ::testing::ElementsAre;
using Triangle = std::array<uint32_t, 3>;

const std::string kVertexXyz = "property float x\nproperty float y\nproperty float z\n";

void expect_equal(const Mesh& mesh, const Mesh& expected, float tolerance) {
  ASSERT_EQ(mesh.vertices.size(), expected.vertices.size());
  ASSERT_EQ(mesh.normals.size(), expected.normals.size());
  EXPECT_EQ(mesh.triangles, expected.triangles);
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    EXPECT_LE((mesh.vertices[i] - expected.vertices[i]).norm(), tolerance) << i;
  }
  for (size_t i = 0; i < mesh.normals.size(); ++i) EXPECT_EQ(mesh.normals[i], expected.normals[i]) << i;
}

TEST(PlyWriter, ComesBackThroughTheReader) {
  const TemporaryFolder folder;
  const Mesh mesh = ball(0.05f);
  for (const LengthUnit unit : {LengthUnit::kMetre, LengthUnit::kMillimetre}) {
    write_ply(folder / "ball.ply", mesh, unit);
    expect_equal(read_mesh(folder / "ball.ply", unit), mesh, 1e-8f);
  }
  // In the wrong unit it is a thousand times as large.
  EXPECT_NEAR(read_mesh(folder / "ball.ply", LengthUnit::kMetre).vertices[0].norm(), 50, 1e-4);
}

TEST(PlyWriter, WritesCloudsAndLeavesNoOtherFile) {
  const TemporaryFolder folder;
  Mesh cloud = ball(0.05f);
  cloud.triangles.clear();
  write_ply(folder / "cloud.ply", cloud);
  expect_equal(read_mesh(folder / "cloud.ply"), cloud, 1e-8f);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(PlyWriter, RefusesMeshesThatContradictThemselves) {
  const TemporaryFolder folder;
  Mesh mesh = tetrahedron();
  mesh.normals.resize(1);
  EXPECT_THROW(write_ply(folder / "a.ply", mesh), std::invalid_argument);
  mesh = tetrahedron();
  mesh.triangles.push_back({0, 1, 4});
  EXPECT_THROW(write_ply(folder / "a.ply", mesh), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.ply"));
}

TEST(PlyReader, AsciiWithPolygonsBecomesFans) {
  const Mesh mesh =
      parse_text("ply\nformat ascii 1.0\ncomment of mine\nobj_info x\nelement vertex 5\n" + kVertexXyz +
                     "element face 4\nproperty list uchar int vertex_index\nend_header\n"
                     "0 0 0\n1 0 0\n1 1 0\n 0\t1 0\n+.5 1.5e0 -2E-1\n"
                     "5 0 1 2 4 3\n3 0 1 2\n2 0 1\n0\n",
                 "a.ply");
  EXPECT_THAT(mesh.triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 4}, Triangle{0, 4, 3}, Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.vertices[4], Eigen::Vector3f(0.5f, 1.5f, -0.2f));
  EXPECT_TRUE(mesh.normals.empty());
}

TEST(PlyReader, BothByteOrdersAndUnknownParts) {
  const auto file = [](const std::string& format, auto pack) {
    std::string text =
        "ply\nformat " + format +
        " 1.0\nelement camera 2\nproperty list uchar double parameters\nproperty short id\n"
        "element vertex 3\nproperty uchar red\nproperty double z\nproperty list ushort int seen_by\n"
        "property float y\nproperty int x\nproperty float nz\nproperty float ny\nproperty float nx\n"
        "element face 1\nproperty list uchar float texcoord\nproperty list uint ushort vertex_indices\n"
        "property float quality\nelement edge 1\nproperty int vertex1\nproperty int vertex2\nend_header\n";
    text += pack(uint8_t{2}, 1.0, 2.0, int16_t{7}) + pack(uint8_t{0}, int16_t{8});
    for (int i = 0; i < 3; ++i) {
      text += pack(uint8_t{255}, 0.25 * i, uint16_t{1}, int32_t{9}, 0.5f * static_cast<float>(i), int32_t{-i},
                   1.0f, 0.0f, 0.0f);
    }
    text += pack(uint8_t{1}, 0.5f, uint32_t{3}, uint16_t{2}, uint16_t{1}, uint16_t{0}, 0.75f);
    text += pack(int32_t{0}, int32_t{1});
    return text;
  };
  const auto little = [](auto... numbers) { return bytes_of(numbers...); };
  const auto big = [](auto... numbers) { return swapped_bytes_of(numbers...); };
  for (const std::string& content : {file("binary_little_endian", little), file("binary_big_endian", big)}) {
    const Mesh mesh = parse_text(content, "a.ply");
    ASSERT_EQ(mesh.vertices.size(), 3u);
    EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(-2, 1, 0.5f));
    EXPECT_EQ(mesh.normals[2], Eigen::Vector3f(0, 0, 1));
    EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{2, 1, 0}));
  }
}

TEST(PlyReader, FacesMayStandBeforeVertices) {
  const Mesh mesh = parse_text(
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\n"
      "element vertex 3\n" +
          kVertexXyz + "end_header\n3 0 1 2\n0 0 0 1 0 0 0 1 0\n",
      "a.ply");
  EXPECT_THAT(mesh.triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.vertices[2], Eigen::Vector3f(0, 1, 0));
}

TEST(PlyReader, LineEndsOfAllKinds) {
  for (const std::string& end : {std::string("\n"), std::string("\r\n"), std::string("\r")}) {
    std::string text;
    for (const char* line : {"ply", "format binary_little_endian 1.0", "element vertex 1", "property uchar x",
                             "property uchar y", "property uchar z", "end_header"}) {
      text += line + end;
    }
    const Mesh mesh = parse_text(text + "\n\r ", "a.ply");  // these three are data
    EXPECT_EQ(mesh.vertices.at(0), Eigen::Vector3f('\n', '\r', ' '));
  }
}

TEST(PlyReader, TriangleStripsTurnEveryOtherTriangle) {
  const Mesh mesh = parse_text("ply\nformat ascii 1.0\nelement vertex 5\n" + kVertexXyz +
                                   "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
                                   "0 0 0 1 0 0 0 1 0 1 1 0 0 2 0\n9 0 1 2 3 4 -1 2 3 4\n",
                               "a.ply");
  EXPECT_THAT(mesh.triangles,
              ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}, Triangle{2, 3, 4}, Triangle{2, 3, 4}));
}

TEST(PlyReader, SceneCloudLosesPointsThatAreNotFinite) {
  const std::string text = "ply\nformat ascii 1.0\nelement vertex 3\n" + kVertexXyz +
                           "property float nx\nproperty float ny\nproperty float nz\nend_header\n"
                           "1 2 3 0 0 1\nnan 0 0 0 1 0\n4 5 6 1 0 0\n";
  EXPECT_EQ(parse_text(text, "a.ply").vertices.size(), 3u);
  const Cloud mesh = parse_cloud(std::as_bytes(std::span(text)), "a.ply", LengthUnit::kMetre);
  ASSERT_EQ(mesh.vertices.size(), 2u);
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(mesh.normals[1], Eigen::Vector3f(1, 0, 0));
}

TEST(PlyReader, MeshKeepsVerticesThatAreNotFinite) {
  const Mesh mesh = parse_text("ply\nformat ascii 1.0\nelement vertex 3\n" + kVertexXyz +
                                   "element face 1\nproperty list uchar int vertex_index\nend_header\n"
                                   "0 0 0\n1 inf 0\n-nan 1 0\n3 0 1 2\n",
                               "a.ply");
  EXPECT_EQ(mesh.vertices.size(), 3u);  // check_mesh() counts them
  EXPECT_FALSE(mesh.vertices[2].allFinite());
}

}  // namespace
}  // namespace edgepose
