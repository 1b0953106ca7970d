#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <liblzf/lzf.h>

#include "files/mesh_file.h"
#include "tests/files/bad_input.h"
#include "tests/files/mesh_samples.h"

namespace edgepose {
namespace {

using ::testing::ElementsAre;
using Triangle = std::array<uint32_t, 3>;

std::string text_stl(const Mesh& mesh) {
  std::string text = "solid a name, facet or not\n";
  for (const auto& triangle : mesh.triangles) {
    text += "facet normal 0 0 nan\nouter loop\n";
    for (const uint32_t i : triangle) {
      const Eigen::Vector3f& v = mesh.vertices[i];
      text += "vertex " + std::to_string(v.x()) + " " + std::to_string(v.y()) + " " + std::to_string(v.z()) +
              "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid a name\n";
}

std::string binary_stl(const Mesh& mesh, std::string header) {
  header.resize(80, ' ');
  std::string text = header + bytes_of(static_cast<uint32_t>(mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    text += bytes_of(0.0f, 0.0f, 0.0f);
    for (const uint32_t i : triangle)
      text += bytes_of(mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z());
    text += bytes_of(uint16_t{0xffff});
  }
  return text;
}

/// The tetrahedron again, its vertices in any order.
void expect_tetrahedron(const Mesh& mesh) {
  EXPECT_EQ(mesh.vertices.size(), 4u);  // welded: each stands three times in an STL
  EXPECT_EQ(mesh.triangles.size(), 4u);
  EXPECT_NEAR(signed_volume(mesh), 1.0 / 6, 1e-6);
}

TEST(StlReader, TextAndBinary) {
  expect_tetrahedron(parse_text(text_stl(tetrahedron(1)), "a.stl"));
  expect_tetrahedron(parse_text(binary_stl(tetrahedron(1), "made by a test"), "a.STL"));
  expect_tetrahedron(parse_text(binary_stl(tetrahedron(1), "solid as many programs write it"), "a"));
}

TEST(StlReader, CapitalsAndSeveralSolids) {
  std::string text = text_stl(tetrahedron(1));
  for (char& c : text) c = static_cast<char>(std::toupper(c));
  Mesh moved = tetrahedron(1);
  for (Eigen::Vector3f& vertex : moved.vertices) vertex.x() += 5;
  const Mesh mesh = parse_text(text + text_stl(moved), "a.stl");
  EXPECT_EQ(mesh.vertices.size(), 8u);
  EXPECT_EQ(mesh.triangles.size(), 8u);
}

TEST(StlReader, WeldsManyCornersAndBothZeros) {
  const Mesh sphere = ball(0.1f, 40, 0, 60);
  Mesh mesh = parse_text(binary_stl(sphere, ""), "a.stl");
  EXPECT_EQ(mesh.triangles.size(), sphere.triangles.size());
  EXPECT_EQ(mesh.vertices.size(), 39u * 60 + 2);  // the poles are one vertex each
  EXPECT_NEAR(signed_volume(mesh), signed_volume(sphere), 1e-9);
  Mesh zeros = tetrahedron(1);
  zeros.vertices.push_back({-0.0f, 1, -0.0f});
  zeros.triangles[0][1] = 4;
  EXPECT_EQ(parse_text(binary_stl(zeros, ""), "a.stl").vertices.size(), 4u);
}

TEST(ObjReader, AllFormsOfFaces) {
  const std::string vertices =
      "# test\nmtllib x.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 0\n";
  const auto triangles = [&](const std::string& faces) {
    return parse_text(vertices + faces, "a.obj").triangles;
  };
  const auto quad = ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3});
  EXPECT_THAT(triangles("f 1 2 3 4"), quad);
  EXPECT_THAT(triangles("s off\nusemtl m\nf 1/1 2/1 3/1 4/1 # comment\n"), quad);
  EXPECT_THAT(triangles("vn 0 0 1\nf 1//1 2//1 3//1 4//1\n"), quad);
  EXPECT_THAT(triangles("vn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\r\n"), quad);
  EXPECT_THAT(triangles("f -4 -3 -2 -1\n"), quad);
  EXPECT_THAT(triangles("f 1 \\\n 2 3 \\\r\n 4\n"), quad);
}

TEST(ObjReader, NormalsOnlyIfEachVertexHasOne) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nvn 0 1 0\nvn 0 0 1\n";
  const auto normals = [&](const std::string& faces) {
    return parse_text(vertices + faces, "a.obj").normals;
  };
  const Eigen::Vector3f z(0, 0, 1), y(0, 1, 0);
  EXPECT_THAT(normals("f 1//1 2//2 3//1\nf 1//3 3//-1 4//1\n"), ElementsAre(z, y, z, z));
  EXPECT_TRUE(normals("f 1//1 2//2 3//1\nf 1//2 3//1 4//1\n").empty());  // a sharp edge
  EXPECT_TRUE(normals("f 1//1 2//2 3//1\nf 1 3 4\n").empty());
}

std::string pcd_header(const std::string& fields, const std::string& data, int points = 3) {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "WIDTH " +
         std::to_string(points) + "\nHEIGHT 1\nVIEWPOINT 0.1 0.2 0.3 1 0 0 0\nPOINTS " +
         std::to_string(points) + "\nDATA " + data + "\n";
}

TEST(PcdReader, Ascii) {
  const std::string text =
      pcd_header("FIELDS rgb x y z\nSIZE 4 4 4 4\nTYPE U F F F\nCOUNT 2 1 1 1\n", "ascii") +
      "1 2 10 20 30\n1 2 nan nan nan\n1 2 -1e1 +2.5 0\n";
  EXPECT_EQ(parse_text(text, "a.pcd").vertices.size(), 3u) << "a model's points are judged by mend_mesh()";
  const Cloud mesh = parse_cloud(std::as_bytes(std::span(text)), "a.pcd", LengthUnit::kMillimetre);
  ASSERT_EQ(mesh.vertices.size(), 2u);
  EXPECT_EQ(mesh.vertices[0], Eigen::Vector3f(0.01f, 0.02f, 0.03f));
  EXPECT_EQ(mesh.vertices[1], Eigen::Vector3f(-0.01f, 0.0025f, 0));
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(PcdReader, BinaryOfMixedTypesWithNormals) {
  const std::string fields =
      "FIELDS tag x y z _ normal_x normal_y normal_z\nSIZE 1 8 2 4 1 4 4 4\nTYPE U F I F U F F F\nCOUNT 1 1 "
      "1 1 3 1 1 1\n";
  std::string text = pcd_header(fields, "binary");
  for (int i = 0; i < 3; ++i) {
    text += bytes_of(uint8_t{9}, 0.5 * i, static_cast<int16_t>(-i), i == 1 ? NAN : 4.0f) + "___" +
            bytes_of(0.0f, 1.0f, 0.0f);
  }
  const Cloud cloud = parse_cloud(std::as_bytes(std::span(text)), "a.pcd", LengthUnit::kMetre);
  ASSERT_EQ(cloud.vertices.size(), 2u);
  EXPECT_EQ(cloud.vertices[1], Eigen::Vector3f(1, -2, 4));
  EXPECT_EQ(cloud.normals[1], Eigen::Vector3f(0, 1, 0));
  EXPECT_EQ(cloud.viewpoint, Eigen::Vector3f(0.1f, 0.2f, 0.3f));
}

TEST(PcdReader, CompressedIsStoredFieldByField) {
  constexpr int kPoints = 500;
  std::string columns;
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < kPoints; ++i) columns += bytes_of(static_cast<float>(axis == 0 ? i : axis));
  }
  std::string packed(columns.size(), '\0');
  const unsigned size = lzf_compress(columns.data(), static_cast<unsigned>(columns.size()), packed.data(),
                                     static_cast<unsigned>(packed.size()));
  ASSERT_GT(size, 0u);
  const std::string text =
      pcd_header("FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n", "binary_compressed", kPoints) +
      bytes_of(uint32_t{size}, static_cast<uint32_t>(columns.size())) + packed.substr(0, size);
  const Mesh mesh = parse_text(text, "a.pcd");
  ASSERT_EQ(mesh.vertices.size(), 500u);
  EXPECT_EQ(mesh.vertices[499], Eigen::Vector3f(499, 1, 2));
}

TEST(Clouds, AreReadFromMeshFilesToo) {
  const TemporaryFolder folder;
  write_ply(folder / "a.ply", tetrahedron(), LengthUnit::kMetre);
  const Cloud cloud = read_cloud(folder / "a.ply", LengthUnit::kMetre);
  EXPECT_EQ(cloud.vertices.size(), 4u);
  EXPECT_TRUE(cloud.triangles.empty());
  EXPECT_EQ(cloud.viewpoint, Eigen::Vector3f(0, 0, 0));
}

}  // namespace
}  // namespace edgepose
