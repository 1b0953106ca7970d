#include "server/service.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <systemd/sd-daemon.h>
#include <unistd.h>

#include <cerrno>
#include <memory>

#include "common/error.h"
#include "daemon/clock.h"
#include "daemon/log.h"
#include "daemon/signals.h"
#include "messaging/udpm_receiver.h"
#include "server/control.h"
#include "server/frame_intake.h"
#include "server/http_endpoint.h"
#include "server/metrics.h"
#include "server/status_message.h"
#include "settings/control_address.h"

namespace edgepose {
namespace {

constexpr int kStatusPeriod = 1000;  // [ms]
constexpr double kStuck = 30;        // [s] of work on one frame after which the daemon is not healthy

std::optional<SecretKey> key_of(const ServiceOptions& options) {
  if (options.key_file.empty()) return std::nullopt;
  return SecretKey::read(options.key_file);
}

std::filesystem::path or_default(const std::string& configured, std::filesystem::path (*otherwise)()) {
  return configured.empty() ? otherwise() : std::filesystem::path(configured);
}

std::vector<ListeningSocket> control_sockets(const ServiceOptions& options) {
  std::vector<ListeningSocket> sockets;
  sockets.push_back(ListeningSocket::on_file(or_default(options.control_socket, default_control_socket)));
  if (options.control_port != 0) sockets.push_back(ListeningSocket::on_loopback(options.control_port));
  return sockets;
}

/// The daemon's parts, in the order in which they depend on each other.
class Service {
 public:
  Service(const ServiceOptions& options, const std::filesystem::path& config,
          std::function<ServiceOptions()> read_again)
      : options_(options),
        config_(config),
        read_again_(std::move(read_again)),
        address_(parse_udpm_url(options.lcm_url)),
        key_(key_of(options)),
        registry_(or_default(options.state_folder, default_state_folder)),
        publisher_(address_, key_),
        worker_(mailbox_, registry_, options_, publisher_, statistics_),
        registrar_(registry_, options_),
        intake_(mailbox_, statistics_.counters, [this] { return options_.get()->frames; }),
        receiver_(address_, [this](ReceivedMessage&& message) { intake_.take(message); }),
        control_({registry_, registrar_, worker_, statistics_, options_, [this] { signals_.end(); }, key_},
                 facts()) {
    server_ = std::make_unique<LineServer>(
        control_sockets(options),
        [this](LineServer::ClientId client, const std::string& line) {
          return control_.handle(client, line, [this](LineServer::ClientId to, std::string answer) {
            server_->answer(to, std::move(answer));
          });
        },
        statistics_.counters, LineServerOptions{options.max_clients, options.client_timeout});
    if (options.http_port != 0)
      http_ = std::make_unique<HttpEndpoint>(options.http_port,
                                             [this](const std::string& path) { return answer_http(path); });
    server_->start();
  }

  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;
  ~Service() { server_->stop(); }

  void run() {
    say_ready();
    while (true) {
      switch (signals_.wait(kStatusPeriod)) {
        case Wake::kEnd:
          log_event(LogLevel::kInfo, "stopping");
          sd_notify(0, "STOPPING=1");
          return;
        case Wake::kReload:
          reload();
          break;
        case Wake::kTick:
          tick();
          break;
      }
    }
  }

 private:
  ServiceFacts facts() const {
    return {EDGEPOSE_VERSION, to_url(address_), config_.string(), receiver_.receive_buffer_bytes(),
            start_utime_};
  }

  void say_ready() {
    const auto options = options_.get();
    for (const BrokenModel& model : registry_.broken())
      log_event(LogLevel::kError, "model_broken", {{"model", model.entry.name}, {"reason", model.fault}});
    if (receiver_.receive_buffer_bytes() < address_.receive_buffer_bytes)
      log_event(LogLevel::kWarning, "small_receive_buffer",
                {{"wanted", std::to_string(address_.receive_buffer_bytes)},
                 {"granted", std::to_string(receiver_.receive_buffer_bytes())},
                 {"advice", "depth frames will be lost: sysctl net.core.rmem_max=8388608"}});
    log_event(LogLevel::kInfo, "ready",
              {{"models", std::to_string(registry_.all().size())},
               {"active", std::to_string(registry_.active().size())},
               {"lcm", to_url(address_)},
               {"control", or_default(options->control_socket, default_control_socket).string()},
               {"control_port", std::to_string(options->control_port)},
               {"http_port", std::to_string(options->http_port)},
               {"signed", key_ ? "yes" : "no"},
               {"seconds", std::to_string(1e-6 * static_cast<double>(utime_now() - start_utime_))}});
    sd_notify(0, "READY=1\nSTATUS=ready");
  }

  void tick() {
    if (receiver_.failed() || server_->failed())
      throw InputError("service: the system refuses to wait for messages; ending");
    take_receiver_counters();
    edgepose_lcm::service_status_t status =
        status_message(statistics_, registry_, 1e-6 * static_cast<double>(utime_now() - start_utime_));
    publisher_.publish_status(status);
    if (is_healthy()) sd_notify(0, "WATCHDOG=1");
  }

  bool is_healthy() const {
    return worker_.stuck_for() < kStuck && !receiver_.failed() && !server_->failed();
  }

  /// The receiver counts for itself; here is what has come since the last look.
  void take_receiver_counters() {
    const ReceiveCounters now = receiver_.counters();
    const auto add = [&](const std::string& name, uint64_t current, uint64_t before) {
      if (current > before) statistics_.counters.add(name, current - before);
    };
    add("datagrams", now.datagrams, seen_.datagrams);
    add("datagrams_malformed", now.malformed, seen_.malformed);
    add("datagrams_lost_by_kernel", now.lost_by_kernel, seen_.lost_by_kernel);
    add("messages_given_up", now.assembly.given_up, seen_.assembly.given_up);
    add("fragments_refused", now.assembly.refused, seen_.assembly.refused);
    add("fragments_duplicate", now.assembly.duplicates, seen_.assembly.duplicates);
    if (now.lost_by_kernel > seen_.lost_by_kernel)
      log_limited(LogLevel::kWarning, "datagrams_lost", "receive buffer full",
                  {{"datagrams", std::to_string(now.lost_by_kernel - seen_.lost_by_kernel)}});
    seen_ = now;
  }

  void reload() {
    sd_notify(0, "RELOADING=1");
    try {
      ServiceOptions next = read_again_();
      ServiceOptions current = *options_.get();
      keep_what_is_not_live(next, current);
      set_log_level(next.log_level);
      options_.set(std::move(next));
      log_event(LogLevel::kInfo, "reloaded", {{"config", config_.string()}});
    } catch (const std::exception& error) {
      log_event(LogLevel::kError, "reload_failed",
                {{"reason", error.what()}, {"advice", "the old options stay"}});
    }
    sd_notify(0, "READY=1");
  }

  static void keep_what_is_not_live(ServiceOptions& next, ServiceOptions& current) {
    const std::vector<SettingKey> wanted = service_keys(next), now = service_keys(current);
    for (size_t i = 0; i < wanted.size(); ++i) {
      if (is_live(wanted[i].path) || to_toml(wanted[i]) == to_toml(now[i])) continue;
      log_event(
          LogLevel::kWarning, "needs_restart",
          {{"key", wanted[i].path}, {"in_effect", to_toml(now[i])}, {"configured", to_toml(wanted[i])}});
      std::visit([&](auto* field) { *field = *std::get<std::decay_t<decltype(field)>>(now[i].field); },
                 wanted[i].field);
    }
  }

  HttpAnswer answer_http(const std::string& path) {
    if (path == "/metrics")
      return {200, "text/plain; version=0.0.4; charset=utf-8", metrics_text(statistics_, registry_)};
    if (path != "/healthz") return {404, "text/plain; charset=utf-8", "there is /healthz and /metrics\n"};
    if (is_healthy()) return {200, "text/plain; charset=utf-8", "ok\n"};
    return {503, "text/plain; charset=utf-8",
            "a frame has been worked on for more than 30 s, or the network failed\n"};
  }

  const int64_t start_utime_ = utime_now();
  Signals signals_;  // first: threads inherit what is blocked
  LiveOptions options_;
  const std::filesystem::path config_;
  const std::function<ServiceOptions()> read_again_;
  const UdpmAddress address_;
  const std::optional<SecretKey> key_;
  Statistics statistics_;
  FrameMailbox mailbox_;
  Registry registry_;
  std::unique_ptr<LineServer> server_;  // made last, but outlives those that answer late
  AnswerPublisher publisher_;
  Worker worker_;
  Registrar registrar_;
  FrameIntake intake_;
  UdpmReceiver receiver_;
  ReceiveCounters seen_;
  Control control_;
  std::unique_ptr<HttpEndpoint> http_;
};

}  // namespace

void run_service(const ServiceOptions& options, const std::filesystem::path& config,
                 const std::function<ServiceOptions()>& read_again) {
  set_log_level(options.log_level);
  Service service(options, config, read_again);
  service.run();
}

}  // namespace edgepose
