#include "simulator/truth_log.h"

#include <cerrno>
#include <chrono>
#include <cstring>

#include "arm/kinematics.h"
#include "common/error.h"
#include "messaging/transform_message.h"

namespace edgepose {
namespace {

constexpr size_t kMaxWaitingSamples = 60'000;

double tip_speed(const WorkCell& cell, const TruthSample& sample) {
  return point_velocity(cell.arm, sample.position, sample.velocity, cell.flange_T_tool.translation()).norm();
}

}  // namespace

TruthSample truth_of(const SimulatedArm& arm, int64_t time_ns) {
  TruthSample sample{time_ns, arm.position(), arm.velocity(), {}};
  for (int axis = 0; axis < kJoints; ++axis)
    sample.states[static_cast<size_t>(axis)] = arm.drive(axis).state();
  return sample;
}

edgepose_lcm::arm_truth_t truth_message(const WorkCell& cell, const DrillTarget& target,
                                        const TruthSample& sample, int64_t utime) {
  edgepose_lcm::arm_truth_t m{};
  m.utime = utime;
  m.steady_ns = sample.time_ns;
  for (int axis = 0; axis < kJoints; ++axis) {
    m.position[axis] = sample.position[axis];
    m.velocity[axis] = sample.velocity[axis];
    m.drive_state[axis] = static_cast<int8_t>(sample.states[static_cast<size_t>(axis)]);
  }
  const PositioningError error = positioning_error(cell, sample.position, target);
  m.target = target.name;
  m.tip_along = error.along;
  m.tip_across = error.across;
  m.axis_angle = error.angle;
  m.tip_speed = tip_speed(cell, sample);
  m.camera_T_model = to_message(camera_T_model(cell, sample.position));
  return m;
}

TruthLog::TruthLog(const std::filesystem::path& path, const WorkCell& cell, const DrillTarget& target)
    : cell_(cell), target_(target), file_(std::fopen(path.c_str(), "we")) {
  if (file_ == nullptr)
    throw InputError::at(path.string(), "a file that can be written", std::strerror(errno));
  std::fputs(
      "time_ns,q1,q2,q3,q4,q5,q6,v1,v2,v3,v4,v5,v6,s1,s2,s3,s4,s5,s6,along_m,across_m,angle_rad,tip_speed\n",
      file_);
  thread_ = std::thread([this] { run(); });
}

TruthLog::~TruthLog() {
  {
    const std::scoped_lock lock(mutex_);
    ending_ = true;
  }
  changed_.notify_one();
  thread_.join();
  std::fclose(file_);
}

void TruthLog::add(const TruthSample& sample) {
  const std::scoped_lock lock(mutex_);
  if (waiting_.size() >= kMaxWaitingSamples)
    ++lost_;
  else
    waiting_.push_back(sample);
}

uint64_t TruthLog::lost() const {
  const std::scoped_lock lock(mutex_);
  return lost_;
}

void TruthLog::run() {
  std::vector<TruthSample> taken;
  for (bool last = false; !last;) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, std::chrono::milliseconds(100), [this] { return ending_; });
      last = ending_;
      taken.clear();
      taken.swap(waiting_);
    }
    for (const TruthSample& sample : taken) write(sample);
    std::fflush(file_);
    if (std::ferror(file_) == 0) continue;
    std::clearerr(file_);
    const std::scoped_lock lock(mutex_);
    lost_ += taken.size();
  }
}

void TruthLog::write(const TruthSample& sample) {
  std::fprintf(file_, "%lld", static_cast<long long>(sample.time_ns));
  for (const JointVector& values : {sample.position, sample.velocity})
    for (const double value : values) std::fprintf(file_, ",%.9g", value);
  for (const DriveState state : sample.states) std::fprintf(file_, ",%d", static_cast<int>(state));
  const PositioningError error = positioning_error(cell_, sample.position, target_);
  std::fprintf(file_, ",%.9g,%.9g,%.9g,%.6g\n", error.along, error.across, error.angle,
               tip_speed(cell_, sample));
}

}  // namespace edgepose
