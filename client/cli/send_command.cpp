#include "client/cli/send_command.h"

#include <unistd.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>

#include "client/cli/exit_codes.h"
#include "client/cli/lcm_options.h"
#include "client/cli/option_checks.h"
#include "client/cli/text.h"
#include "client/service/answer_inbox.h"
#include "client/service/depth_files.h"
#include "client/service/latency_figures.h"
#include "client/service/stop_signals.h"
#include "common/command_line.h"
#include "common/error.h"
#include "files/depth_file.h"
#include "messaging/channels.h"
#include "messaging/depth_message.h"
#include "messaging/lcm_publisher.h"
#include "messaging/udpm_receiver.h"

namespace edgepose {
namespace {

constexpr const char* kSendExamples = R"(Examples:
  edgepose send frame.png --intrinsics 600,600,319.5,239.5
  edgepose send recorded/ --intrinsics camera_info.yaml --rate 15 --repeat 0
  edgepose send spine/test/000001                       # a BOP scene brings its cameras
  edgepose send spine/test/000001 --wait                # each image when the one before is answered

Ctrl-C ends it with its summary. Exit code: 0 if all was sent, and with --wait answered; 1 if an answer is missing.)";

struct SendCommand {
  std::vector<std::filesystem::path> paths;
  DepthFileOptions files;
  double rate = 30, timeout = 5;
  uint64_t repeat = 1;
  std::string camera = "camera", url;
  DepthEncoding encoding = DepthEncoding::kRvl;
  bool wait = false;

  void run() const;
};

/// Sends frames and knows what became of them.
class Sender {
 public:
  Sender(const SendCommand& command, const std::stop_token& stop)
      : command_(command), stop_(stop), publisher_(parse_udpm_url(command.url)) {
    if (command.rate > 0) pacer_.emplace(command.rate);
    if (!command.wait) return;
    const UdpmAddress address = parse_udpm_url(command.url);
    receiver_.emplace(address, [this](ReceivedMessage&& message) { inbox_.see(message); });
    warn_of_small_buffer(*receiver_, address);
  }

  /// False if a stop was asked for.
  bool send(const DepthFile& file);
  bool print_summary() const;

 private:
  void show_progress();

  const SendCommand& command_;
  const std::stop_token stop_;
  LcmPublisher publisher_;
  AnswerInbox inbox_;
  std::optional<UdpmReceiver> receiver_;  // after the inbox that it fills
  std::optional<Pacer> pacer_;
  int64_t sequence_ = first_sequence();
  uint64_t sent_ = 0, refused_ = 0;
  std::vector<double> latencies_;
  SteadyTime start_ = std::chrono::steady_clock::now(), shown_ = start_;
};

bool Sender::send(const DepthFile& file) {
  // All that takes time comes before the deadline, so that capture_utime is the time of sending.
  DepthFrame frame{0, sequence_, command_.camera, file.camera, read_depth_file(file)};
  edgepose_lcm::depth_frame_t message = pack(frame, file.depth_scale, command_.encoding);
  if (pacer_ ? !pacer_->wait(stop_) : stop_.stop_requested()) return false;
  message.capture_utime = utime_now();
  const std::vector<std::byte> bytes = encode(message);
  inbox_.expect(command_.camera, sequence_);
  if (publisher_.publish(channels::kDepth, bytes))
    ++sent_;
  else
    ++refused_;
  ++sequence_;
  if (command_.wait) {
    const auto latency =
        inbox_.wait(stop_, std::chrono::steady_clock::now() + steady_seconds(command_.timeout));
    if (latency) latencies_.push_back(*latency);
  }
  show_progress();
  return !stop_.stop_requested();
}

void Sender::show_progress() {
  const SteadyTime now = std::chrono::steady_clock::now();
  if (isatty(STDERR_FILENO) == 0 || now - shown_ < std::chrono::milliseconds(200)) return;
  shown_ = now;
  const double seconds = std::chrono::duration<double>(now - start_).count();
  std::cerr << formatted("\r\033[Ksent %llu frames, %.1f a second", static_cast<unsigned long long>(sent_),
                         static_cast<double>(sent_) / seconds)
            << std::flush;
}

bool Sender::print_summary() const {
  if (shown_ != start_) std::cerr << "\r\033[K" << std::flush;
  std::cout << "sent " << sent_ << " frames of '" << command_.camera << "'";
  if (sent_ > 0)
    std::cout << ", sequence " << sequence_ - static_cast<int64_t>(sent_ + refused_) << " to "
              << sequence_ - 1;
  std::cout << '\n';
  if (refused_ > 0) std::cout << "refused by the system: " << refused_ << " frames\n";
  if (!command_.wait && pacer_ && pacer_->missed() > 0)
    std::cout << "deadlines missed: " << pacer_->missed() << " (reading or sending was slower than --rate)\n";
  if (!command_.wait) return refused_ == 0;
  const LatencyFigures figures = latency_figures(latencies_);
  std::cout << formatted("answered %zu, latency (publication to receipt) p50 %.1f ms, p99 %.1f ms\n",
                         figures.count, 1e3 * figures.p50, 1e3 * figures.p99);
  if (const std::string lost = losses(receiver_->counters()); !lost.empty())
    std::cout << "lost: " << lost << '\n';
  if (inbox_.malformed() > 0) std::cout << "malformed answers: " << inbox_.malformed() << '\n';
  return refused_ == 0 && figures.count == sent_;
}

void SendCommand::run() const {
  if (rate == 0 && !wait) throw InputError("--rate 0: expected --wait with it, found none");
  const std::vector<DepthFile> list = find_depth_files(paths, files);
  const StopSignals signals;
  Sender sender(*this, signals.token());
  bool goes_on = true;
  for (uint64_t round = 0; goes_on && (repeat == 0 || round < repeat); ++round)
    for (size_t i = 0; goes_on && i < list.size(); ++i) goes_on = sender.send(list[i]);
  if (!sender.print_summary()) exit_not_found();
}

std::string check_camera_name(const std::string& name) {
  const bool sound = !name.empty() && name.size() <= 63 &&
                     std::all_of(name.begin(), name.end(), [](char c) { return c > ' ' && c <= '~'; });
  return sound ? "" : "expected 1 to 63 printable characters without blanks, found others";
}

}  // namespace

void add_send_command(CLI::App& app) {
  auto command = std::make_shared<SendCommand>();
  CLI::App* send = app.add_subcommand("send", "Play a depth camera: send depth images over LCM");
  send->add_option("PATH", command->paths, "Depth PNG, folder of them, BOP scene folder or BOP set")
      ->required();
  send->add_option("--intrinsics", command->files.intrinsics,
                   "Camera: fx,fy,cx,cy in pixels, BOP scene_camera.json, or ROS camera_info YAML");
  send->add_option("--depth-scale", command->files.depth_scale,
                   "Millimetres per unit of the depth images (default: as the camera's file says, else 1)")
      ->check(number_between(1e3 * kMinDepthScale, 1e3 * kMaxDepthScale));
  send->add_option("--rate", command->rate,
                   "Frames a second (default 30); 0 with --wait: as fast as they are answered")
      ->check(number_between(0, 1000));
  send->add_option("--repeat", command->repeat, "How many times (default 1); 0 = for ever");
  send->add_option("--camera", command->camera, "The camera's name (default camera)")
      ->check(check_camera_name, "");
  choose<DepthEncoding>(
      send->add_option("--encoding", command->encoding, "rvl (lossless compression, the default) or raw"),
      {{"rvl", DepthEncoding::kRvl}, {"raw", DepthEncoding::kRaw16}});
  add_url_option(*send, command->url);
  send->add_flag("--wait", command->wait, "Send the next when the answer has come, so that none is dropped");
  send->add_option("--timeout", command->timeout, "[s] With --wait: how long for each answer (default 5)")
      ->check(number_between(0.001, kMaxSeconds));
  send->footer(kSendExamples);
  send->callback([command] { command->run(); });
}

}  // namespace edgepose
