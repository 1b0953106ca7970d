#include "client/cli/replay_command.h"

#include <iostream>
#include <memory>
#include <optional>

#include "client/cli/exit_codes.h"
#include "client/cli/lcm_options.h"
#include "client/cli/option_checks.h"
#include "client/cli/record_report.h"
#include "client/cli/text.h"
#include "client/service/latency_figures.h"
#include "client/service/log_replay.h"
#include "client/service/recorder.h"
#include "client/service/stop_signals.h"
#include "common/output_target.h"
#include "messaging/channels.h"
#include "messaging/lcm_publisher.h"
#include "messaging/udpm_receiver.h"

namespace edgepose {
namespace {

constexpr const char* kReplayExamples = R"(Examples:
  edgepose replay session.lcmlog                                  # its frames, at the times of their reception
  edgepose replay session.lcmlog --speed 0 --record answers.lcmlog  # each frame when the one before is answered
  edgepose replay foreign.lcmlog --all --keep-times --speed 2

Frames are sent as if taken now, with sequence numbers beyond all before; --keep-times leaves them as logged.
Exit code: 0 if the log was sent, and at speed 0 each frame answered; 1 if an answer is missing; 2 for bad input.)";

// After the last answer its drill targets, and what else the service says of it, are on their way.
constexpr double kLinger = 0.5;  // [s]

struct ReplayCommand {
  std::filesystem::path log, record;
  ReplayOptions options;
  std::vector<std::string> channels;
  std::string url;
  bool all = false, force = false;

  void run();

 private:
  void print(const LogReplay& replay, const ReceiveCounters& received) const;
};

void ReplayCommand::run() {
  options.channels = {channels.begin(), channels.end()};
  if (channels.empty() && !all) options.channels = {channels::kDepth, channels::kCloud};
  const UdpmAddress address = parse_udpm_url(url);
  const StopSignals signals;
  AnswerInbox inbox;
  LcmPublisher publisher(address);
  LogReplay replay(
      log, options,
      [&](const std::string& channel, std::span<const std::byte> message) {
        return publisher.publish(channel, message);
      },
      inbox);
  std::optional<Recorder> recorder;
  if (!record.empty()) {
    check_output(record, {log});
    recorder.emplace(record, force ? LcmLogWriter::Existing::kReplace : LcmLogWriter::Existing::kRefuse,
                     Recorder::Options{});
  }
  std::optional<UdpmReceiver> receiver;
  receiver.emplace(address, [&](ReceivedMessage&& message) {
    inbox.see(message);
    if (recorder) recorder->take(std::move(message));
  });
  warn_of_small_buffer(*receiver, address);
  replay.run(signals.token());
  if (recorder) {
    const auto soon = [](double seconds) {
      return std::chrono::steady_clock::now() + steady_seconds(seconds);
    };
    if (options.speed > 0 && replay.counters().frames > 0) inbox.wait(signals.token(), soon(options.timeout));
    wait_until(soon(kLinger), signals.token());
  }
  const ReceiveCounters received = receiver->counters();
  receiver.reset();
  print(replay, received);
  if (recorder) {
    recorder->finish();
    print_recorded(std::cout, record, recorder->counters());
    print_losses(std::cout, recorder->counters(), received);
  }
  if (options.speed == 0 && replay.counters().answered < replay.counters().frames) exit_not_found();
}

void ReplayCommand::print(const LogReplay& replay, const ReceiveCounters& received) const {
  const ReplayCounters& counters = replay.counters();
  std::cout << "sent " << counters.sent << " messages, " << counters.frames << " of them frames\n";
  if (options.speed == 0) {
    const LatencyFigures figures = latency_figures(replay.latencies());
    std::cout << formatted("answered %zu, latency (publication to receipt) p50 %.1f ms, p99 %.1f ms\n",
                           figures.count, 1e3 * figures.p50, 1e3 * figures.p99);
    if (const std::string lost = losses(received); !lost.empty()) std::cout << "lost: " << lost << '\n';
  }
  const auto tell = [](uint64_t count, const char* what) {
    if (count > 0) std::cout << "skipped: " << count << ' ' << what << '\n';
  };
  uint64_t others = 0;
  for (const auto& [channel, count] : counters.other) others += count;
  tell(others, "messages of other channels (--all sends them)");
  tell(counters.malformed, "messages on a frames' channel that are no frames");
  tell(counters.beyond, "frames whose sequence number cannot be moved");
  tell(counters.refused, "messages that the system or LCM would not send");
  tell(counters.skipped_bytes, "bytes of the log that belong to no message");
  if (counters.cut_off) std::cout << "the log is cut off within a message\n";
}

}  // namespace

void add_replay_command(CLI::App& app) {
  auto command = std::make_shared<ReplayCommand>();
  CLI::App* replay = app.add_subcommand("replay", "Send the frames of a log once more");
  replay->add_option("LOG", command->log, "LCM log, of edgepose record or lcm-logger")->required();
  replay
      ->add_option("--speed", command->options.speed,
                   "Times as fast as recorded (default 1); 0: each frame when the one before is answered")
      ->check(number_between(0, 1000));
  replay->add_option("--timeout", command->options.timeout, "[s] At speed 0: for each answer (default 5)")
      ->check(number_between(0.001, kMaxSeconds));
  auto* channel = replay->add_option("--channel", command->channels,
                                     "Only these channels (default: EDGEPOSE_DEPTH and EDGEPOSE_CLOUD)");
  replay->add_flag("--all", command->all, "Every channel")->excludes(channel);
  replay->add_flag("--keep-times", command->options.keep_times,
                   "Leave times of capture and sequence numbers as they were logged");
  auto* record = add_output_option(*replay, "--record", command->record,
                                   "Log to write with all that is said meanwhile, answers included");
  replay->add_flag("--force", command->force, "Replace an existing --record file")->needs(record);
  add_url_option(*replay, command->url);
  replay->footer(kReplayExamples);
  replay->callback([command] { command->run(); });
}

}  // namespace edgepose
