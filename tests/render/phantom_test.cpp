#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "files/mesh_file.h"
#include "models/phantom/drill_plan.h"
#include "models/phantom/phantom_mesh.h"
#include "models/phantom/phantom_shape.h"
#include "models/phantom/sample_files.h"

namespace edgepose::phantom {
namespace {

using Eigen::Vector3d;

const std::filesystem::path kFolder = std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models" / "phantom";

struct Corners {
  Vector3d a, b, c;
};
Corners corners(const Mesh& mesh, const std::array<uint32_t, 3>& t) {
  return {mesh.vertices[t[0]].cast<double>(), mesh.vertices[t[1]].cast<double>(),
          mesh.vertices[t[2]].cast<double>()};
}

const Mesh& shipped() {
  static const Mesh mesh = read_mesh(kFolder / "phantom.ply");
  return mesh;
}

TEST(Phantom, ShippedMeshIsWhatTheGeneratorMakes) {
  const Mesh made = phantom_mesh();
  ASSERT_EQ(made.vertices.size(), shipped().vertices.size());
  ASSERT_EQ(made.triangles, shipped().triangles);
  for (size_t i = 0; i < made.vertices.size(); ++i) {
    ASSERT_LT((made.vertices[i] - shipped().vertices[i]).norm(), 2e-8f) << "vertex " << i;  // float, in mm
    ASSERT_LT((made.normals[i] - shipped().normals[i]).norm(), 1e-6f) << "vertex " << i;
  }
}

TEST(Phantom, HasTheSizeThatIsPromised) {
  EXPECT_LT(std::filesystem::file_size(kFolder / "phantom.ply"), 600'000u);
  EXPECT_GE(shipped().triangles.size(), 10'000u);
  EXPECT_LE(shipped().triangles.size(), 20'000u);
  EXPECT_NEAR(diameter(shipped()), 0.09, 0.005);
}

// Closed and oriented: every edge is used once in each direction, so it has two triangles that agree.
TEST(Phantom, IsClosedAndManifold) {
  std::map<std::pair<uint32_t, uint32_t>, int> uses;
  for (const auto& t : shipped().triangles) {
    for (size_t i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
  }
  for (const auto& [edge, count] : uses) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(uses.contains({edge.second, edge.first}));
  }
  const auto vertices = static_cast<long>(shipped().vertices.size()),
             edges = static_cast<long>(uses.size() / 2),
             triangles = static_cast<long>(shipped().triangles.size());
  EXPECT_EQ(vertices - edges + triangles, 0) << "one piece with one hole through it, the vertebral canal";
}

TEST(Phantom, TrianglesAndNormalsPointOutwards) {
  double volume = 0;
  for (const auto& t : shipped().triangles) {
    const auto [a, b, c] = corners(shipped(), t);
    volume += a.dot(b.cross(c)) / 6;
    const Vector3d normal = (b - a).cross(c - a);
    for (const uint32_t i : t) ASSERT_GT(normal.dot(shipped().normals[i].cast<double>()), 0);
  }
  EXPECT_GT(volume, 30e-6);  // m^3; 48 cm^3
  for (size_t i = 0; i < shipped().vertices.size(); ++i) {
    const Vector3d point = 1000 * shipped().vertices[i].cast<double>();
    ASSERT_NEAR(signed_distance(point), 0, 0.1) << "mm";
    ASSERT_GT(signed_distance(point + 0.3 * shipped().normals[i].cast<double>()), 0);
  }
}

// Left and right differ: the mirrored phantom does not lie on the phantom.
TEST(Phantom, IsNotItsMirrorImage) {
  double worst = 0;
  for (const Eigen::Vector3f& vertex : shipped().vertices) {
    const Vector3d mirrored = (1000 * vertex.cast<double>()).cwiseProduct(Vector3d(-1, 1, 1));
    worst = std::max(worst, std::abs(signed_distance(mirrored)));
  }
  EXPECT_GT(worst, 3) << "mm";
}

/// Depth along the ray of the first hit with the mesh, metres; inf if none (Moeller and Trumbore).
double first_hit(const Mesh& mesh, const Vector3d& origin, const Vector3d& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles) {
    const auto [a, b, c] = corners(mesh, t);
    const Vector3d p = direction.cross(c - a);
    const double determinant = (b - a).dot(p);
    if (std::abs(determinant) < 1e-18) continue;
    const Vector3d from_a = origin - a, q = from_a.cross(b - a);
    const double u = from_a.dot(p) / determinant, v = direction.dot(q) / determinant;
    const double distance = (c - a).dot(q) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0) nearest = std::min(nearest, distance);
  }
  return nearest;
}

TEST(Phantom, DrillPlanEntersAtTheSurfaceAndStaysInTheBone) {
  std::ifstream file(kFolder / "drill_plan.json");
  const auto plan = nlohmann::json::parse(file);
  EXPECT_EQ(plan.at("model"), kName);
  EXPECT_NEAR(plan.at("model_diameter_mm").get<double>(), 1000 * diameter(shipped()), 1e-3);
  ASSERT_EQ(plan.at("targets").size(), drill_plan().size());
  const auto vector = [](const nlohmann::json& values) {
    return Vector3d(values.at(0).get<double>(), values.at(1).get<double>(), values.at(2).get<double>());
  };
  for (size_t i = 0; i < drill_plan().size(); ++i) {
    const auto& target = plan.at("targets").at(i);
    const std::string name = target.at("name");
    const Vector3d entry = vector(target.at("entry_mm")), axis = vector(target.at("axis"));
    EXPECT_EQ(name, drill_plan()[i].name);
    EXPECT_LT((entry - drill_plan()[i].entry).norm(), 1e-9);
    EXPECT_NEAR(axis.norm(), 1, 1e-9);
    // From 30 mm outside, the drill first meets the mesh at the entry point.
    EXPECT_NEAR(first_hit(shipped(), (entry - 30 * axis) / 1000, axis), 0.030, 0.0002) << name;
    EXPECT_LT(outward_normal(entry).dot(axis), -0.3) << name << ": goes in, not along";
    const double depth = target.at("depth_mm"), radius = target.at("diameter_mm").get<double>() / 2;
    for (double reached = 3 * radius; reached <= depth; reached += 0.5) {
      EXPECT_LE(signed_distance(entry + reached * axis), -radius) << name << " at " << reached << " mm";
    }
    EXPECT_GT(target.at("tolerance_mm").get<double>(), 0);
    EXPECT_GT(target.at("tolerance_deg").get<double>(), 0);
  }
}

}  // namespace
}  // namespace edgepose::phantom
