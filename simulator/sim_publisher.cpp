#include "simulator/sim_publisher.h"

#include <sys/resource.h>
#include <unistd.h>

#include "bus/steady_clock.h"
#include "common/error.h"
#include "daemon/clock.h"

namespace edgepose {
namespace {

constexpr double kDepthScale = 1e-3;  // [m]
constexpr std::chrono::milliseconds kTruthPeriod{50};
constexpr int kLowPriority = 5;

int64_t utime_of(int64_t time_ns) { return (time_ns + wall_minus_steady_ns()) / 1000; }

std::chrono::nanoseconds period_of(const SimulationOptions& options) {
  const double usual = options.publish == SimPublish::kDepth ? 10 : 30;
  return std::chrono::nanoseconds(static_cast<int64_t>(1e9 / (options.rate > 0 ? options.rate : usual)));
}

}  // namespace

SimPublisher::SimPublisher(const WorkCell& cell, const DrillTarget& target, const ToldEquipment& told,
                           const SimulationOptions& options, const DriveThread& drives)
    : cell_(cell),
      target_(target),
      drives_(drives),
      lcm_(parse_udpm_url(options.lcm_url.empty() ? kDefaultLcmUrl : options.lcm_url)) {
  std::optional<SecretKey> key;
  if (!options.key.empty()) key = SecretKey::read(options.key);
  if (options.publish == SimPublish::kDepth) {
    CellCameraOptions camera;
    camera.name = options.camera;
    camera.seed = options.seed;
    if (options.sensor != "kinect_narrow") camera.sensor = SensorModel::named(options.sensor);
    camera_.emplace(cell, told.camera, camera);
    frames_ = std::make_unique<PeriodicThread>(period_of(options), [this] { publish_depth(); });
  } else if (options.publish == SimPublish::kPoses) {
    PoseSourceOptions source;
    source.camera = options.camera;
    source.seed = options.seed;
    source.session = utime_now();
    poses_.emplace(cell.plan, key, source);
    frames_ = std::make_unique<PeriodicThread>(period_of(options), [this] { publish_poses(); });
  }
  truth_ = std::make_unique<PeriodicThread>(kTruthPeriod, [this] { publish_truth(); });
}

void SimPublisher::publish_depth() {
  // Linux knows priorities of threads: the drives go first. Once each thread is enough, and cheap.
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), kLowPriority);
  const TruthSample now = drives_.truth();
  const int64_t begin = steady_ns();
  const DepthFrame frame = camera_->capture(now.position, utime_of(now.time_ns));
  {
    const std::scoped_lock lock(mutex_);
    counts_.capture_seconds = 1e-9 * static_cast<double>(steady_ns() - begin);
  }
  send("EDGEPOSE_DEPTH", encode(pack(frame, kDepthScale, DepthEncoding::kRvl)));
}

void SimPublisher::publish_poses() {
  const TruthSample now = drives_.truth();
  std::vector<OutgoingMessage> messages;
  {
    const std::scoped_lock lock(mutex_);
    messages = poses_->messages(camera_T_model(cell_, now.position), utime_of(now.time_ns), utime_now());
  }
  for (const OutgoingMessage& message : messages) send(message.channel, message.bytes);
}

void SimPublisher::publish_truth() {
  const TruthSample now = drives_.truth();
  send(kTruthChannel, encode(truth_message(cell_, target_, now, utime_of(now.time_ns))));
}

void SimPublisher::send(const std::string& channel, std::span<const std::byte> bytes) {
  const bool sent = lcm_.publish(channel, bytes);
  const std::scoped_lock lock(mutex_);
  ++(sent ? counts_.messages : counts_.failed);
}

void SimPublisher::set_wrong(PoseWrong wrong, int count) {
  const std::scoped_lock lock(mutex_);
  if (!poses_) throw InputError::at("poses", "--publish poses", "another", "start edgepose-sim with it");
  poses_->set_wrong(wrong, count);
}

std::string SimPublisher::wrong() const {
  const std::scoped_lock lock(mutex_);
  return poses_ ? name_of(poses_->wrong()) : name_of(PoseWrong::kNone);
}

PublisherCounts SimPublisher::counts() const {
  const std::scoped_lock lock(mutex_);
  return counts_;
}

}  // namespace edgepose
