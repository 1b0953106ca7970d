#include "client/cli/watch_command.h"

#include <unistd.h>

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "client/cli/lcm_options.h"
#include "client/cli/option_checks.h"
#include "client/cli/watch_board.h"
#include "client/cli/watch_report.h"
#include "client/service/answer_judge.h"
#include "client/service/message_queue.h"
#include "client/service/stop_signals.h"
#include "messaging/channels.h"
#include "messaging/udpm_receiver.h"

namespace edgepose {
namespace {

constexpr const char* kWatchExamples = R"(Examples:
  edgepose watch                                   # a live table on a terminal, else one line an answer
  edgepose watch --key /etc/edgepose/key           # shows only what the holder of the key has sent
  edgepose watch --json --count 100 > answers.jsonl

Ctrl-C ends it with its summary and exit code 0.)";

constexpr size_t kQueueBytes = size_t{64} << 20;
constexpr auto kRedraw = std::chrono::milliseconds(100);

struct WatchCommand {
  std::string url;
  std::filesystem::path key;
  double seconds = 0, max_age = 5;
  uint64_t count = 0;
  bool as_json = false;

  void run() const;
};

void print_line(const nlohmann::json& message) {
  std::cout << message.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) << std::endl;
}

/// Shows what is believed.
class Watcher {
 public:
  Watcher(const WatchCommand& command, const std::optional<SecretKey>& key)
      : as_json_(command.as_json),
        live_(!command.as_json && isatty(STDOUT_FILENO) != 0),
        judge_(key, command.max_age) {
    if (live_) std::cout << "\033[2J";
  }

  void take(const TimedMessage& timed);
  void redraw(uint64_t dropped);
  uint64_t answers() const { return answers_; }
  void print_summary(const ReceiveCounters& received, uint64_t dropped) const;

 private:
  std::vector<std::string> footer(uint64_t dropped) const;

  bool as_json_, live_;
  AnswerJudge judge_;
  WatchBoard board_;
  uint64_t answers_ = 0;
  SteadyTime drawn_;
};

void Watcher::take(const TimedMessage& timed) {
  const std::string& channel = timed.message.channel;
  const int64_t utime = timed.receive_utime;
  if (channel == channels::kPoses) {
    edgepose_lcm::pose_estimates_t answer;
    if (!judge_.take(timed.message, utime, answer)) return;
    ++answers_;
    board_.show(answer, utime);
    if (as_json_)
      print_line(to_json(answer, utime));
    else if (!live_)
      std::cout << line(answer, utime) << std::endl;
  } else if (channel == channels::kDrillTargets) {
    edgepose_lcm::drill_targets_t targets;
    if (!judge_.take(timed.message, utime, targets)) return;
    board_.show(targets);
    if (as_json_)
      print_line(to_json(targets, utime));
    else if (!live_)
      std::cout << line(targets) << std::endl;
  } else {
    edgepose_lcm::service_status_t status;
    if (!judge_.take(timed.message, status)) return;
    board_.show(status);
    if (as_json_) print_line(to_json(status, utime));
  }
}

std::vector<std::string> Watcher::footer(uint64_t dropped) const {
  std::string refused;
  for (const auto& [cause, count] : judge_.refused())
    refused += (refused.empty() ? "" : ", ") + cause + " " + std::to_string(count);
  std::string text = std::to_string(answers_) + " answers, " +
                     (judge_.verifies() ? "each verified with the key" : "none verified: no --key was given");
  text += "; refused: " + (refused.empty() ? "none" : refused);
  if (dropped > 0) text += "; dropped here: " + std::to_string(dropped);
  return {"", text};
}

void Watcher::redraw(uint64_t dropped) {
  const SteadyTime now = std::chrono::steady_clock::now();
  if (!live_ || now - drawn_ < kRedraw) return;
  drawn_ = now;
  std::cout << board_.drawing(footer(dropped)) << std::flush;
}

void Watcher::print_summary(const ReceiveCounters& received, uint64_t dropped) const {
  std::ostream& out = as_json_ ? std::cerr : std::cout;
  if (live_) out << board_.drawing({});
  out << footer(dropped).back() << std::endl;
  if (const std::string lost = losses(received); !lost.empty()) out << "lost: " << lost << std::endl;
}

void WatchCommand::run() const {
  const std::optional<SecretKey> secret = key.empty() ? std::nullopt : std::optional(SecretKey::read(key));
  const UdpmAddress address = parse_udpm_url(url);
  const StopSignals signals;
  const std::stop_token stop = signals.token();
  MessageQueue queue(kQueueBytes);
  std::optional<UdpmReceiver> receiver;
  receiver.emplace(address, [&](ReceivedMessage&& message) {
    if (message.channel == channels::kPoses || message.channel == channels::kDrillTargets ||
        message.channel == channels::kStatus)
      queue.push({utime_now(), std::move(message)});
  });
  warn_of_small_buffer(*receiver, address);
  if (!secret) std::cerr << "edgepose: no --key: nothing that is shown is verified" << std::endl;
  Watcher watcher(*this, secret);
  const SteadyTime end =
      std::chrono::steady_clock::now() + steady_seconds(seconds > 0 ? seconds : 100 * kMaxSeconds);
  while (!stop.stop_requested() && std::chrono::steady_clock::now() < end && std::cout) {
    const auto message = queue.pop(stop, std::min(end, std::chrono::steady_clock::now() + kRedraw));
    if (message) watcher.take(*message);
    watcher.redraw(queue.dropped());
    if (count > 0 && watcher.answers() >= count) break;
  }
  const ReceiveCounters received = receiver->counters();
  receiver.reset();
  watcher.print_summary(received, queue.dropped());
}

}  // namespace

void add_watch_command(CLI::App& app) {
  auto command = std::make_shared<WatchCommand>();
  CLI::App* watch = app.add_subcommand("watch", "Show the answers of the service as they come");
  watch->add_option("--key", command->key, "Key file: what it does not verify is refused and counted");
  watch
      ->add_option("--max-age", command->max_age,
                   "[s] With --key: messages sent longer ago are refused (default 5)")
      ->check(number_between(0.001, kMaxSeconds));
  watch->add_option("--count", command->count, "End after so many answers")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1'000'000'000'000}));
  watch->add_option("--seconds", command->seconds, "[s] End after this time")
      ->check(number_between(0.001, kMaxSeconds));
  watch->add_flag("--json", command->as_json, "One JSON object a line, SI units");
  add_url_option(*watch, command->url);
  watch->footer(kWatchExamples);
  watch->callback([command] { command->run(); });
}

}  // namespace edgepose
