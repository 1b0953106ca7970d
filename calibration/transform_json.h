#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "arm/types.h"
#include "files/json_node.h"

namespace edgepose {

/// A rigid transform in a calibration file: {"rotation": [[..], [..], [..]], "translation_m": [..]}, the
/// matrix row by row; or "rotation_vector_rad" instead of the matrix. Throws InputError that names the
/// member: a matrix that is no rotation (to 10^-3: rounding is mended), a rotation vector longer than a full
/// turn (degrees?), a translation longer than `reach` [m] (millimetres?).
RigidTransform transform_from(const JsonNode& node, double reach);
nlohmann::ordered_json transform_json(const RigidTransform& transform);

/// [rad] six joint positions, each within two turns (else: degrees?).
JointVector joints_from(const JsonNode& node);

/// Root object of a calibration file: `kind` must be the expected one.
void check_kind(const JsonNode& root, const std::string& kind);

/// When something was made: "2026-11-23T09:30:00Z", as read and written in the files. Throws InputError if it
/// is none.
std::string time_from(const JsonNode& node);

/// A name of 1 to 200 bytes.
std::string name_from(const JsonNode& node);

/// A length or angle >= 0.
double residual_from(const JsonNode& node);

}  // namespace edgepose
