#include "demo/demo_processes.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <utility>

#include "client/service/clock.h"
#include "client/service/control_client.h"
#include "client/service/stop_signals.h"
#include "common/error.h"

namespace edgepose {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr double kLookAgain = 0.05;  // [s]
constexpr double kComeToRest = 8;    // [s] for the controller, which brings the arm to rest first
constexpr double kEndAtOnce = 5;     // [s] for the others
constexpr double kSayVersion = 20;   // [s]

}  // namespace

std::string private_lcm_url() {
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;  // port 0: the kernel chooses one that is free
  socklen_t size = sizeof(at);
  const bool found = probe >= 0 && bind(probe, reinterpret_cast<const sockaddr*>(&at), size) == 0 &&
                     getsockname(probe, reinterpret_cast<sockaddr*>(&at), &size) == 0;
  const std::string reason = std::strerror(errno);
  if (probe >= 0) close(probe);
  if (!found) throw InputError::at("udpm", "a free UDP port", reason);
  return "udpm://239.255.76.67:" + std::to_string(ntohs(at.sin_port)) + "?ttl=0&recv_buf_size=4194304";
}

DemoProcesses::DemoProcesses(const DemoOptions& options, const PrivateFolder& folder, std::string lcm_url,
                             std::stop_token stop)
    : options_(options), folder_(folder), lcm_url_(std::move(lcm_url)), stop_(std::move(stop)) {
  for (const Part* part : {&service_, &simulator_, &controller_})
    versions_ += (versions_.empty() ? "" : ", ") + version_of(part->program);
}

std::string DemoProcesses::version_of(const std::string& program) {
  const std::filesystem::path said = folder_ / (program + ".version");
  ChildProgram child(program_folder() / program, {"--version"}, said);
  if (child.wait(kSayVersion) != 0)
    throw InputError::at(program + " --version", "exit code 0", "another or none");
  std::ifstream file(said);
  std::string line;
  std::getline(file, line);
  return one_line(line.substr(0, 100));
}

void DemoProcesses::start(Part& part, const std::vector<std::string>& arguments) {
  part.child.emplace(program_folder() / part.program, arguments, folder_ / (part.program + ".log"));
  const SteadyTime last = steady_clock::now() + steady_seconds(options_.start_seconds);
  while (true) {
    check();
    try {
      call(part, "status", json::object());
      return;
    } catch (const InputError& error) {
      check();
      if (steady_clock::now() > last) throw;
    }
    pause(kLookAgain);
  }
}

void DemoProcesses::start_service() {
  start(service_, {"--lcm-url", lcm_url_, "--state", folder_ / "state", "--socket", service_.socket});
}

void DemoProcesses::start_simulator() {
  std::vector<std::string> arguments = {"--model",
                                        options_.cell.model,
                                        "--plan",
                                        options_.cell.plan,
                                        "--keep-awake",
                                        "--bus",
                                        "unix:" + (folder_ / "bus").string(),
                                        "--lcm-url",
                                        lcm_url_,
                                        "--told",
                                        folder_ / "told",
                                        "--truth",
                                        folder_ / "truth.csv",
                                        "--control",
                                        simulator_.socket,
                                        "--seed",
                                        std::to_string(options_.seed),
                                        "--noise",
                                        options_.noise ? "paper" : "none",
                                        "--rate",
                                        std::to_string(options_.frame_rate)};
  if (!options_.cell.target.empty()) arguments.insert(arguments.end(), {"--target", options_.cell.target});
  start(simulator_, arguments);
}

void DemoProcesses::start_controller(const std::string& model, bool taught) {
  std::vector<std::string> arguments = {"run",
                                        "--bus",
                                        "unix:" + (folder_ / "bus").string(),
                                        "--lcm-url",
                                        lcm_url_,
                                        "--model",
                                        model,
                                        "--hand-eye",
                                        folder_ / "told" / "hand-eye.json",
                                        "--tool",
                                        folder_ / "told" / "tool.json",
                                        "--socket",
                                        controller_.socket,
                                        "--log",
                                        folder_ / "arm.csv",
                                        "--capture",
                                        folder_ / "bus.pcap"};
  if (taught) arguments.insert(arguments.end(), {"--taught", folder_ / "taught.json"});
  start(controller_, arguments);
}

json DemoProcesses::call(Part& part, const std::string& method, const json& params) {
  ControlAddress address;
  address.socket = part.socket;
  address.program = part.program;
  address.advice = "is the machine too busy?";
  return ControlClient(address, std::nullopt).call(method, params, options_.start_seconds, [this](double) {
    check();
  });
}

json DemoProcesses::service(const std::string& method, const json& params) {
  check();
  return call(service_, method, params);
}
json DemoProcesses::simulator(const std::string& method, const json& params) {
  check();
  return call(simulator_, method, params);
}
json DemoProcesses::controller(const std::string& method, const json& params) {
  check();
  return call(controller_, method, params);
}

void DemoProcesses::check() {
  if (stop_.stop_requested()) throw DemoStopped();
  for (Part* part : {&service_, &simulator_, &controller_})
    if (part->child) part->child->check();
}

void DemoProcesses::pause(double seconds) {
  wait_until(steady_clock::now() + steady_seconds(seconds), stop_);
  check();
}

void DemoProcesses::end() {
  if (controller_.child) controller_.child->end(kComeToRest);
  for (Part* part : {&simulator_, &service_})
    if (part->child) part->child->end(kEndAtOnce);
}

}  // namespace edgepose
