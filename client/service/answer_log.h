#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "edgepose_lcm/rigid_transform_t.hpp"
#include "matcher/types.h"

namespace edgepose {

/// A pose that was accepted.
struct LoggedPose {
  edgepose_lcm::rigid_transform_t sent{};  ///< bit for bit
  RigidTransform camera_T_model;
  std::vector<RigidTransform> equivalent;  ///< camera_T_model of poses that look the same
};

/// What was said of one frame: the accepted poses of each model that was looked for, best first.
struct LoggedAnswer {
  int64_t sequence = 0;
  std::map<std::string, std::vector<LoggedPose>> models;
  bool cut_short = false;  ///< by the service's deadline: what is said depends on how fast it was
};

struct CameraAnswers {
  std::vector<LoggedAnswer> answers;   ///< as they stand in the log
  std::optional<int64_t> first_frame;  ///< sequence of the first frame that is in the log
};

/// The answers of the service in an LCM log.
struct AnswerLog {
  std::map<std::string, CameraAnswers> cameras;
  uint64_t malformed = 0;      ///< messages on the answers' channel that are none
  uint64_t skipped_bytes = 0;  ///< of the log that belong to no record
  bool cut_off = false;        ///< the log ends within a record
};

/// Throws InputError if the log cannot be read or holds no answer.
AnswerLog read_answer_log(const std::filesystem::path& path);

}  // namespace edgepose
