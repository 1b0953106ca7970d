#include "controller/controller.h"

#include <systemd/sd-daemon.h>

#include <chrono>
#include <memory>
#include <thread>

#include "bus/open_bus.h"
#include "bus/pcap_writer.h"
#include "bus/steady_clock.h"
#include "canopen/cob_id.h"
#include "common/error.h"
#include "controller/equipment.h"
#include "controller/sample_log.h"
#include "controller/servo_control.h"
#include "controller/state_message.h"
#include "daemon/clock.h"
#include "daemon/keep_awake.h"
#include "daemon/log.h"
#include "daemon/signals.h"
#include "messaging/channels.h"
#include "messaging/lcm_publisher.h"
#include "messaging/udpm_receiver.h"

namespace edgepose {
namespace {

constexpr std::chrono::milliseconds kReportPeriod{5};
constexpr int64_t kPublishNs = 50'000'000;
constexpr double kComeToRest = 5;  // [s] at most, when the program ends

MasterOptions master_options(const ControllerOptions& options) {
  MasterOptions master = options.master;
  master.identity.vendor = static_cast<uint32_t>(options.vendor);
  master.identity.product = static_cast<uint32_t>(options.product);
  return master;
}

std::optional<SecretKey> servo_key(const ControllerOptions& options) {
  if (options.key_file.empty()) return std::nullopt;
  return SecretKey::read(options.key_file);
}

std::vector<ListeningSocket> servo_sockets(const ControllerOptions& options) {
  std::vector<ListeningSocket> sockets;
  sockets.push_back(ListeningSocket::on_file(options.control_socket.empty()
                                                 ? default_servo_socket()
                                                 : std::filesystem::path(options.control_socket)));
  return sockets;
}

/// The controller's parts, in the order in which they depend on each other.
class Controller {
 public:
  explicit Controller(const ControllerOptions& options)
      : options_(options),
        address_(parse_udpm_url(options.lcm_url)),
        key_(servo_key(options)),
        equipment_(read_equipment(options)),
        poses_(options.model, options.camera, key_),
        loop_(
            open_bus(options.bus, master_options(options).received_ids(), {cob_id::kSync}),
            [&](CanBus& bus) {
              return std::make_unique<ArmController>(bus, aubo_i5(), equipment_.told,
                                                     equipment_.camera_T_tool, options.servo,
                                                     master_options(options));
            },
            poses_, options.servo.motion.cycle, options.real_time),
        control_(loop_, poses_, facts(), [this] { signals_.end(); }),
        publisher_(address_),
        receiver_(address_, [this](ReceivedMessage&& message) {
          poses_.take(message, steady_ns(), wall_minus_steady_ns());
        }) {
    if (options.keep_awake) keep_awake_.emplace();
    if (!options.log.empty()) log_ = std::make_unique<SampleLog>(options.log);
    if (!options.capture.empty())
      capture_ = std::make_unique<PcapWriter>(options.capture, wall_minus_steady_ns());
    server_ = std::make_unique<LineServer>(
        servo_sockets(options),
        [this](LineServer::ClientId client, const std::string& line) {
          return control_.handle(client, line, [this](LineServer::ClientId to, std::string answer) {
            server_->answer(to, std::move(answer));
          });
        },
        counters_, LineServerOptions{});
  }
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;
  ~Controller() {
    loop_.finish(kComeToRest);
    reporting_ = false;
    if (reporter_.joinable()) reporter_.join();
    server_->stop();
  }

  void run() {
    loop_.start();
    reporter_ = std::thread([this] { report(); });
    server_->start();
    say_ready();
    while (signals_.wait(1000) != Wake::kEnd) {
      if (receiver_.failed() || server_->failed())
        throw InputError("edgepose-servo: the system refuses to wait for messages; ending");
    }
    loop_.stop();  // before anything that may wait
    log_event(LogLevel::kInfo, "stopping");
    sd_notify(0, "STOPPING=1");
  }

 private:
  ControllerFacts facts() const {
    return {EDGEPOSE_VERSION, options_.bus,         to_url(address_),
            options_.model,   equipment_.is_taught, key_.has_value()};
  }

  void say_ready() const {
    if (!equipment_.is_taught)
      log_event(LogLevel::kWarning, "not_taught",
                {{"advice",
                  "the errors of hand-eye and tool stay in the goal: an untaught set-up cannot "
                  "reach 1 mm (docs/servoing.md; edgepose teach, controller.taught)"}});
    if (const std::string fault = loop_.real_time_fault(); !fault.empty())
      log_event(LogLevel::kWarning, "not_real_time",
                {{"reason", fault}, {"advice", "root, CAP_SYS_NICE or LimitRTPRIO; or rt_priority = 0"}});
    log_event(LogLevel::kInfo, "ready",
              {{"bus", options_.bus},
               {"model", options_.model},
               {"goal", equipment_.is_taught ? "taught" : "from calibrations"},
               {"lcm", to_url(address_)},
               {"signed", key_ ? "yes" : "no"}});
    sd_notify(0, "READY=1\nSTATUS=ready");
  }

  /// What the loop leaves behind is written, published and said here.
  void report() {
    int64_t next_publish = 0;
    ServoState said = ServoState::kIdle;
    bool last_round = false;
    while (!last_round) {
      last_round = !reporting_;
      control_.finish_requests();
      bool any = false;
      for (ControlSample sample; loop_.samples().pop(sample);) {
        any = true;
        newest_ = sample;
        if (log_) log_->write(sample);
      }
      for (CanFrame frame; loop_.frames().pop(frame);)
        if (capture_) capture_->write(frame);
      if (any && newest_.servo.state != said) say_state(said = newest_.servo.state);
      if (any && newest_.time_ns >= next_publish) {
        publish();
        next_publish = newest_.time_ns + kPublishNs;
      }
      if (!last_round) std::this_thread::sleep_for(kReportPeriod);
    }
  }

  void say_state(ServoState state) {
    const std::string fault = loop_.fault_text();
    log_event(state == ServoState::kFault ? LogLevel::kError : LogLevel::kInfo, "state",
              {{"state", state_name(state)}, {"target", control_.target()}, {"fault", fault}});
    if (capture_) capture_->flush();  // what led here is on the disk
    if (log_) log_->flush();
  }

  void publish() {
    edgepose_lcm::arm_state_t message = to_message(newest_, loop_.fault_text(), control_.target());
    message.send_utime = utime_now();
    publisher_.publish(channels::kArmState, encode(message));
    if (loop_.samples().dropped() > 0 || loop_.frames().dropped() > 0)
      log_limited(LogLevel::kWarning, "recording_lost", "written too slowly",
                  {{"frames", std::to_string(loop_.frames().dropped())},
                   {"cycles", std::to_string(loop_.samples().dropped())}});
    if ((capture_ && capture_->lost() > 0) || (log_ && log_->lost() > 0))
      log_limited(LogLevel::kWarning, "recording_lost", "the disk has no room",
                  {{"frames", std::to_string(capture_ ? capture_->lost() : 0)},
                   {"cycles", std::to_string(log_ ? log_->lost() : 0)}});
  }

  Signals signals_;  // first: threads inherit what is blocked
  std::optional<KeepAwake> keep_awake_;
  const ControllerOptions options_;
  const UdpmAddress address_;
  const std::optional<SecretKey> key_;
  const Equipment equipment_;
  Counters counters_;
  PoseInbox poses_;
  ControlLoop loop_;
  std::unique_ptr<LineServer> server_;  // made late, but outlives those that answer late
  ServoControl control_;
  LcmPublisher publisher_;
  UdpmReceiver receiver_;
  std::unique_ptr<SampleLog> log_;
  std::unique_ptr<PcapWriter> capture_;
  ControlSample newest_;
  std::atomic<bool> reporting_ = true;
  std::thread reporter_;
};

}  // namespace

void run_controller(const ControllerOptions& options) {
  set_log_level(options.log_level);
  Controller controller(options);
  controller.run();
}

}  // namespace edgepose
