#include "tests/arm_process/arm_processes.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <sstream>

#include "bus/steady_clock.h"

namespace edgepose::test {

int process_repetitions(int otherwise) {
  const char* text = std::getenv("EDGEPOSE_FAULT_REPETITIONS");
  return text == nullptr ? otherwise : std::max(1, std::atoi(text));
}

double TruthLine::fastest() const {
  return std::abs(*std::max_element(v, v + 6, [](double a, double b) { return std::abs(a) < std::abs(b); }));
}

bool TruthLine::stops() const {
  constexpr int kOperationEnabled = 5;  // DriveState
  return std::none_of(state, state + 6, [](int one) { return one == kOperationEnabled; });
}

ArmProcesses::ArmProcesses(uint64_t seed, std::vector<std::string> sim, std::vector<std::string> servo,
                           const std::string& bus)
    : bus_(bus.empty() ? "unix:" + path("bus").string() : bus), servo_options_(std::move(servo)) {
  const std::filesystem::path phantom = std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models/phantom";
  std::vector<std::string> command = {program("edgepose-sim"),
                                      "--model",
                                      phantom / "phantom.ply",
                                      "--plan",
                                      phantom / "drill_plan.json",
                                      "--bus",
                                      bus_,
                                      "--noise",
                                      "none",
                                      "--seed",
                                      std::to_string(seed),
                                      "--told",
                                      path("told"),
                                      "--truth",
                                      path("truth.csv"),
                                      "--control",
                                      path("sim.sock")};
  if (bus_.starts_with("unix:"))
    command.push_back("--keep-awake");  // a guest's processor is its host's to keep
  if (std::find(sim.begin(), sim.end(), "--publish") == sim.end())
    command.insert(command.end(), {"--publish", "poses"});
  command.insert(command.end(), sim.begin(), sim.end());
  simulator_ = std::make_unique<Process>(command, path("sim.log"));
  const bool serves = eventually(
      [&] { return !ask(path("sim.sock"), R"({"id":1,"method":"status","jsonrpc":"2.0"})").empty(); });
  if (!serves) throw std::runtime_error("edgepose-sim: " + read_text(path("sim.log")));
  start_controller();
}

void ArmProcesses::start_controller() {
  std::vector<std::string> command = {program("edgepose-servo"),
                                      "run",
                                      "--bus",
                                      bus_,
                                      "--hand-eye",
                                      path("told") / "hand-eye.json",
                                      "--tool",
                                      path("told") / "tool.json",
                                      "--socket",
                                      path("servo.sock")};
  if (std::find(servo_options_.begin(), servo_options_.end(), "--model") == servo_options_.end())
    command.insert(command.end(), {"--model", "vertebra_phantom"});
  command.insert(command.end(), servo_options_.begin(), servo_options_.end());
  controller_ = std::make_unique<Process>(command, path("servo.log"));
  const bool serves = eventually(
      [&] { return !ask(path("servo.sock"), R"({"id":1,"method":"status","jsonrpc":"2.0"})").empty(); });
  if (!serves) throw std::runtime_error("edgepose-servo: " + log());
}

void ArmProcesses::start_controller(std::vector<std::string> servo) {
  servo_options_ = std::move(servo);
  start_controller();
}

nlohmann::json ArmProcesses::call(const std::string& socket, const std::string& method,
                                  const nlohmann::json& params) {
  const nlohmann::json request = {{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}};
  const auto answer = nlohmann::json::parse(ask(path(socket), request.dump(), 10), nullptr, false);
  if (!answer.is_object()) throw std::runtime_error(method + ": no answer");
  if (answer.contains("error")) throw std::runtime_error(answer["error"]["message"].get<std::string>());
  return answer["result"];
}

nlohmann::json ArmProcesses::servo(const std::string& method, const nlohmann::json& params) {
  return call("servo.sock", method, params);
}

nlohmann::json ArmProcesses::sim(const std::string& method, const nlohmann::json& params) {
  return call("sim.sock", method, params);
}

std::string ArmProcesses::await_end() {
  std::string now;
  for (int i = 0; i < 300 && now != "converged" && now != "fault"; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // not more often: a guest has other work
    now = state();
  }
  return now;
}

void ArmProcesses::set_out(const std::string& hole) {
  servo("arm");
  eventually([&] { return servo("status")["poses_taken"] >= 3; });
  servo("go", {{"target", hole}});
  std::this_thread::sleep_for(std::chrono::milliseconds(400));
  if (state() != "approaching") throw std::runtime_error("it is not on its way: " + log());
}

std::vector<TruthLine> ArmProcesses::end_and_read_truth() {
  simulator_->signal(SIGTERM);
  simulator_->wait(5);
  return read_truth();
}

std::vector<TruthLine> ArmProcesses::read_truth(int64_t from_ns) const {
  std::ifstream file(path("truth.csv"));
  std::string text;
  std::getline(file, text);
  std::vector<TruthLine> lines;
  while (std::getline(file, text)) {
    if (file.eof() || std::atoll(text.c_str()) < from_ns) continue;  // no line break: not whole yet
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream fields(text);
    TruthLine line;
    fields >> line.time_ns;
    for (double& q : line.q) fields >> q;
    for (double& v : line.v) fields >> v;
    for (int& s : line.state) fields >> s;
    fields >> line.along >> line.across >> line.angle >> line.tip_speed;
    if (fields) lines.push_back(line);
  }
  return lines;
}

std::filesystem::path write_short_way(const Folder& folder) {
  const std::filesystem::path path = folder / "servo.toml";
  std::ofstream(path) << "[approach]\nstandoff = 0.03\n";
  return path;
}

int64_t steady_now() { return steady_ns(); }

double ms_until(const std::vector<TruthLine>& truth, int64_t from_ns,
                const std::function<bool(const TruthLine&)>& holds) {
  int64_t since = -1;
  for (const TruthLine& line : truth) {
    if (line.time_ns < from_ns) continue;
    if (!holds(line))
      since = -1;
    else if (since < 0)
      since = line.time_ns;
  }
  return since < 0 ? -1 : 1e-6 * static_cast<double>(since - from_ns);
}

}  // namespace edgepose::test
