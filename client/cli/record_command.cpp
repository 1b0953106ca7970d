#include "client/cli/record_command.h"

#include <iostream>
#include <memory>
#include <optional>

#include "client/cli/lcm_options.h"
#include "client/cli/option_checks.h"
#include "client/cli/record_report.h"
#include "client/service/recorder.h"
#include "client/service/stop_signals.h"
#include "messaging/udpm_receiver.h"

namespace edgepose {
namespace {

constexpr const char* kRecordExamples = R"(Examples:
  edgepose record session.lcmlog
  edgepose record poses.lcmlog --channel EDGEPOSE_POSES --channel EDGEPOSE_DRILL_TARGETS
  edgepose record minute.lcmlog --seconds 60 --force

lcm-logplayer and edgepose replay play the log. Ctrl-C ends it with its summary. Exit code 2 if the disk is full:
what was written up to then is a sound log.)";

struct RecordCommand {
  std::filesystem::path file;
  std::vector<std::string> channels;
  std::string url;
  double seconds = 0;
  uint64_t messages = 0;
  size_t queue_mb = 256;
  bool force = false;

  void run() const;
};

void RecordCommand::run() const {
  const UdpmAddress address = parse_udpm_url(url);
  const StopSignals signals;
  Recorder recorder(file, force ? LcmLogWriter::Existing::kReplace : LcmLogWriter::Existing::kRefuse,
                    {{channels.begin(), channels.end()}, queue_mb << 20, messages});
  std::optional<UdpmReceiver> receiver;
  receiver.emplace(address, [&](ReceivedMessage&& message) { recorder.take(std::move(message)); });
  warn_of_small_buffer(*receiver, address);
  std::cerr << "recording to " << file.string() << "; Ctrl-C ends it" << std::endl;
  const double longest = seconds > 0 ? seconds : 100 * kMaxSeconds;
  recorder.wait(signals.token(), std::chrono::steady_clock::now() + steady_seconds(longest));
  const ReceiveCounters received = receiver->counters();
  receiver.reset();
  recorder.finish();
  print_recorded(std::cout, file, recorder.counters());
  print_losses(std::cout, recorder.counters(), received);
}

}  // namespace

void add_record_command(CLI::App& app) {
  auto command = std::make_shared<RecordCommand>();
  CLI::App* record = app.add_subcommand("record", "Write what is said over LCM to a log");
  add_output_option(*record, "FILE", command->file, "Log to write")->required();
  record->add_option("--channel", command->channels, "Only these channels (default: all)");
  record->add_option("--seconds", command->seconds, "[s] End after this time")
      ->check(number_between(0.001, kMaxSeconds));
  record->add_option("--messages", command->messages, "End after so many messages")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1'000'000'000'000}));
  record->add_option("--queue", command->queue_mb, "[MB] That may wait for a slow disk (default 256)")
      ->check(CLI::Range(size_t{1}, size_t{65536}));
  record->add_flag("--force", command->force, "Replace an existing file");
  add_url_option(*record, command->url);
  record->footer(kRecordExamples);
  record->callback([command] { command->run(); });
}

}  // namespace edgepose
