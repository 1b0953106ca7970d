#pragma once
#include <string>

#include "files/mesh_health.h"
#include "files/mesh_survey.h"

namespace edgepose {

/// What cannot be mended: throws InputError, led by `name`, if a vertex is not finite, no normal has a
/// direction, no surface is left, or the size or the place is implausible.
void require_usable(const MeshSurvey& survey, const MeshHealth& health, const std::string& name);

/// "1 triangle", "3 triangles", "2 vertices".
std::string counted(size_t count, const std::string& thing, const std::string& things = "");

}  // namespace edgepose
