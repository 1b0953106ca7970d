#include "client/service/answer_log.h"

#include "client/service/frame_restamp.h"
#include "common/error.h"
#include "messaging/channels.h"
#include "messaging/checked_decode.h"
#include "messaging/lcm_log.h"
#include "messaging/transform_message.h"

namespace edgepose {
namespace {

using namespace edgepose_lcm;

std::optional<LoggedPose> read_pose(const detection_t& detection) {
  const auto pose = from_message(detection.camera_T_model);
  if (!pose) return std::nullopt;
  LoggedPose logged{detection.camera_T_model, *pose, {}};
  logged.equivalent.reserve(detection.camera_T_equivalent.size());
  for (const rigid_transform_t& other : detection.camera_T_equivalent) {
    const auto equivalent = from_message(other);
    if (!equivalent) return std::nullopt;
    logged.equivalent.push_back(*equivalent);
  }
  return logged;
}

std::optional<LoggedAnswer> read_answer(const pose_estimates_t& message) {
  LoggedAnswer answer{message.sequence, {}, message.deadline_reached != 0};
  for (const model_answer_t& model : message.answers) {
    std::vector<LoggedPose>& found = answer.models[model.model];
    for (const detection_t& detection : model.detections) {
      if (!detection.accepted) continue;
      const auto pose = read_pose(detection);
      if (!pose) return std::nullopt;
      found.push_back(*pose);
    }
  }
  return answer;
}

void add_answer(const LoggedMessage& message, AnswerLog& log) {
  pose_estimates_t decoded;
  std::optional<LoggedAnswer> answer;
  if (decode_checked(std::span<const std::byte>(message.data), decoded).empty())
    answer = read_answer(decoded);
  if (answer)
    log.cameras[decoded.camera].answers.push_back(std::move(*answer));
  else
    ++log.malformed;
}

void add_frame(const LoggedMessage& message, AnswerLog& log) {
  std::string camera;
  int64_t sequence = 0;
  if (!frame_identity(message.channel, message.data, camera, sequence)) return;
  auto& first = log.cameras[camera].first_frame;
  if (!first) first = sequence;
}

}  // namespace

AnswerLog read_answer_log(const std::filesystem::path& path) {
  LcmLogReader reader(path);
  AnswerLog log;
  for (LoggedMessage message; reader.next(message);) {
    if (message.channel == channels::kPoses)
      add_answer(message, log);
    else
      add_frame(message, log);
  }
  log.skipped_bytes = reader.skipped_bytes();
  log.cut_off = reader.is_cut_off();
  std::erase_if(log.cameras, [](const auto& camera) { return camera.second.answers.empty(); });
  if (log.cameras.empty())
    throw InputError::at(path.string(), std::string("answers on ") + channels::kPoses,
                         log.malformed > 0 ? std::to_string(log.malformed) + " malformed ones" : "none",
                         "edgepose record or replay --record writes them");
  return log;
}

}  // namespace edgepose
