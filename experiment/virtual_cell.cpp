#include "experiment/virtual_cell.h"

#include <algorithm>
#include <utility>

#include "common/error.h"

namespace edgepose {
namespace {

constexpr int64_t kMillisecond = 1'000'000;

ReceivedMessage received(const OutgoingMessage& message) {
  ReceivedMessage made;
  made.channel = message.channel;
  made.size = message.bytes.size();
  made.bytes = std::make_unique<std::byte[]>(made.size);
  std::copy(message.bytes.begin(), message.bytes.end(), made.bytes.get());
  return made;
}

}  // namespace

VirtualCell::VirtualCell(const WorkCell& work_cell, const std::string& model, const ToldCalibration& told,
                         const RigidTransform& camera_T_tool, PoseFeed pose_feed,
                         const VirtualCellOptions& options)
    : cell(work_cell),
      controller_port(wire.port()),
      arm_port(wire.port()),
      arm(arm_port, options.arm, now_ns),
      controller(controller_port, work_cell.arm, told, camera_T_tool, options.servo, options.master),
      poses(model, "", options.key),
      feed(std::move(pose_feed)),
      options_(options),
      next_look_ns_(now_ns) {}

void VirtualCell::cycle() {
  look();
  deliver();
  if (controller_lives) sample = controller.cycle(now_ns, poses.take_reading());
  const auto steps = static_cast<int>(std::lround(options_.servo.motion.cycle * 1e3));
  for (int i = 0; i < steps; ++i) {
    arm.step(now_ns);
    now_ns += kMillisecond;
    each_ms();
  }
}

void VirtualCell::run(double seconds) {
  for (const int64_t end = now_ns + static_cast<int64_t>(seconds * 1e9); now_ns < end;) cycle();
}

bool VirtualCell::run_until(const std::function<bool()>& holds, double seconds) {
  for (const int64_t end = now_ns + static_cast<int64_t>(seconds * 1e9); now_ns < end;) {
    cycle();
    if (holds()) return true;
  }
  return false;
}

std::string VirtualCell::request(const ArmRequest& request) {
  if (!controller.request(request)) return "another command is worked on";
  std::optional<std::string> answer;
  run_until([&] { return (answer = controller.take_answer()).has_value(); }, 5);
  return answer.value_or("no answer");
}

std::string VirtualCell::go(const std::string& target) {
  try {
    const SeenTarget seen = poses.find(target, 1e-9 * static_cast<double>(now_ns));
    std::string refusal = request({ArmCommand::kGo, seen.hole});
    if (refusal.empty()) poses.follow(target, seen.hole);
    return refusal;
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string VirtualCell::set_out(const std::string& target, double seconds) {
  if (std::string refusal = request({ArmCommand::kArm, {}}); !refusal.empty()) return refusal;
  run(options_.pose_latency + 2 * options_.pose_period);
  if (std::string refusal = go(target); !refusal.empty()) return refusal;
  run(seconds);
  return controller.fault_text();
}

PositioningError VirtualCell::error(const DrillTarget& target) const {
  return positioning_error(cell, arm.position(), target);
}

void VirtualCell::look() {
  if (now_ns < next_look_ns_) return;
  next_look_ns_ += static_cast<int64_t>(options_.pose_period * 1e9);
  const int64_t due = now_ns + static_cast<int64_t>(options_.pose_latency * 1e9);
  for (OutgoingMessage& message : feed(arm.position(), (now_ns + wall_minus_steady_ns) / 1000))
    deliveries_.push_back({due, std::move(message)});
}

void VirtualCell::deliver() {
  for (; !deliveries_.empty() && deliveries_.front().due_ns <= now_ns; deliveries_.pop_front())
    poses.take(received(deliveries_.front().message), now_ns, wall_minus_steady_ns);
}

}  // namespace edgepose
