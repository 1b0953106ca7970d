#include "client/cli/watch_board.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>

#include "client/cli/text.h"
#include "client/cli/watch_report.h"
#include "common/error.h"

namespace edgepose {
namespace {

constexpr size_t kMaxCameras = 16, kMaxCauses = 32;

winsize terminal_size() {
  winsize size{};
  if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0)
    size.ws_col = 120, size.ws_row = 40;
  return size;
}

}  // namespace

WatchBoard::Camera* WatchBoard::camera(const std::string& name) {
  if (!cameras_.contains(name) && cameras_.size() >= kMaxCameras) return nullptr;
  return &cameras_[name];
}

void WatchBoard::show(const edgepose_lcm::pose_estimates_t& answer, int64_t receive_utime) {
  Camera* shown = camera(answer.camera);
  if (shown == nullptr) return;
  shown->answer = answer;
  shown->receive_utime = receive_utime;
  ++shown->answers;
  for (const auto& counter : answer.dropped)
    if (shown->dropped.contains(counter.name) || shown->dropped.size() < kMaxCauses)
      shown->dropped[counter.name] += counter.value;
}

void WatchBoard::show(const edgepose_lcm::drill_targets_t& targets) {
  if (Camera* shown = camera(targets.camera)) shown->targets = targets;
}

void WatchBoard::show(const edgepose_lcm::service_status_t& status) { status_ = status; }

std::vector<std::string> WatchBoard::lines() const {
  std::vector<std::string> list;
  if (status_.send_utime != 0)
    list.push_back(formatted("edgeposed %s, up %.0f s, latency p50 %.1f ms p99 %.1f ms, %zu active models",
                             one_line(status_.version).c_str(), status_.uptime, 1e3 * status_.latency_p50,
                             1e3 * status_.latency_p99, status_.models.size()));
  for (const auto& [name, shown] : cameras_) {
    list.emplace_back("");
    list.push_back(formatted("%s: answer %llu, sequence %lld, latency %.1f ms%s", one_line(name).c_str(),
                             static_cast<unsigned long long>(shown.answers),
                             static_cast<long long>(shown.answer.sequence),
                             1e3 * latency(shown.answer.capture_utime, shown.receive_utime),
                             shown.answer.deadline_reached ? ", deadline reached" : ""));
    std::string dropped;
    for (const auto& [cause, count] : shown.dropped)
      dropped += (dropped.empty() ? "" : ", ") + one_line(cause) + " " + std::to_string(count);
    list.push_back("dropped: " + (dropped.empty() ? "none" : dropped));
    list.push_back(heading_of_poses());
    for (const auto& answer : shown.answer.answers)
      for (std::string& text : rows(answer)) list.push_back(std::move(text));
    if (shown.targets.targets.empty()) continue;
    list.push_back(heading_of_targets() +
                   (shown.targets.sequence == shown.answer.sequence
                        ? ""
                        : "  (of frame " + std::to_string(shown.targets.sequence) + ")"));
    for (const auto& target : shown.targets.targets) list.push_back(row(target));
  }
  return list;
}

std::string WatchBoard::drawing(const std::vector<std::string>& footer) const {
  const winsize size = terminal_size();
  std::vector<std::string> list = lines();
  const size_t room = size.ws_row > footer.size() + 2 ? size.ws_row - footer.size() - 1u : 1u;
  if (list.size() > room) {
    list.resize(room - 1);
    list.emplace_back("...");
  }
  list.insert(list.end(), footer.begin(), footer.end());
  std::string text = "\033[H";  // home: what stood there is drawn over, so that nothing flickers
  for (const std::string& each : list) text += each.substr(0, size.ws_col) + "\033[K\r\n";
  return text + "\033[J";
}

}  // namespace edgepose
