#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "matcher/types.h"

namespace edgepose {

/// The unit of the coordinates in a file. No mesh format says it, so the user must.
enum class LengthUnit { kMillimetre, kMetre };

/// Metres in one `unit`.
constexpr double metres_per(LengthUnit unit) { return unit == LengthUnit::kMillimetre ? 1e-3 : 1.0; }

/// Points without triangles, and where they were seen from (PCD says it; zero in other formats). Metres.
struct Cloud : Mesh {
  Eigen::Vector3f viewpoint = Eigen::Vector3f::Zero();
};

/// Reads a mesh (PLY, STL or OBJ, ascii or binary) or a cloud (PLY without faces, PCD), told apart by
/// content. Result in metres, as the file has it: polygons are cut into fans, equal STL corners are one
/// vertex; everything else, coordinates that are not finite too, is left to check_mesh() and mend_mesh().
/// Normals are kept if every vertex has one (OBJ: and only one), not normalised. Throws
/// InputError: missing, empty, cut short, not of the format that the name says, unsound counts or indices, no
/// vertices; STL and OBJ: no faces.
Mesh read_mesh(const std::filesystem::path& path, LengthUnit unit = LengthUnit::kMillimetre);

/// The same from memory. `name` stands for the file in errors; its extension, if known, must fit the content.
Mesh parse_mesh(std::span<const std::byte> bytes, const std::string& name,
                LengthUnit unit = LengthUnit::kMillimetre);

/// Reads the vertices of any of these formats as a cloud; only finite points. Throws InputError as
/// read_mesh(), and if no finite point is left.
Cloud read_cloud(const std::filesystem::path& path, LengthUnit unit);
Cloud parse_cloud(std::span<const std::byte> bytes, const std::string& name, LengthUnit unit);

/// Writes a binary little-endian PLY (float coordinates in `unit`, normals and triangles if there are any),
/// aside and renamed. Throws InputError if the file cannot be written, std::invalid_argument if the normals
/// are not one per vertex or a triangle names a vertex that is not there.
void write_ply(const std::filesystem::path& path, const Mesh& mesh,
               LengthUnit unit = LengthUnit::kMillimetre);

}  // namespace edgepose
