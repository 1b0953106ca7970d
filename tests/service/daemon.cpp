#include "tests/service/daemon.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace edgepose::test {
namespace {

using Clock = std::chrono::steady_clock;

int to_milliseconds(double seconds) { return static_cast<int>(1000 * seconds); }

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  return address;
}

int notify_socket(const std::string& path) {
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const sockaddr_un address = address_of(path);
  unlink(path.c_str());
  if (bind(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0)
    throw std::runtime_error("cannot bind " + path);
  return descriptor;
}

std::vector<std::string> command(const std::filesystem::path& folder, const std::string& config) {
  std::ofstream(folder / "edgeposed.toml") << config;
  return {program("edgeposed"), "--config", folder / "edgeposed.toml", "--state",
          folder / "state",     "--socket", folder / "control.sock"};
}

}  // namespace

Process::Process(const std::vector<std::string>& command, const std::filesystem::path& log,
                 const std::vector<std::string>& environment) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  pid_ = fork();
  if (pid_ != 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int output = open(log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  for (const std::string& pair : environment) putenv(const_cast<char*>(pair.c_str()));
  execvp(arguments[0], arguments.data());
  _exit(127);
}

Process::~Process() {
  if (end_) return;
  kill(pid_, SIGKILL);
  wait(10);
}

void Process::signal(int number) const {
  if (!end_) kill(pid_, number);
}

std::optional<int> Process::wait(double seconds) {
  eventually(
      [&] {
        int status = 0;
        if (!end_ && waitpid(pid_, &status, WNOHANG) == pid_)
          end_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
        return end_.has_value();
      },
      seconds);
  return end_;
}

Daemon::Daemon(const std::filesystem::path& folder, const std::string& config)
    : folder_(folder),
      notify_(folder / "notify.sock"),
      notify_socket_(notify_socket(notify_)),
      process_(command(folder, config), folder / "log", {"NOTIFY_SOCKET=" + notify_}) {
  const auto start = Clock::now();
  while (!ready_seconds_ && Clock::now() - start < std::chrono::seconds(20)) {
    pollfd wait{notify_socket_, POLLIN, 0};
    std::array<char, 4096> text{};
    if (poll(&wait, 1, 20) == 1 && recv(notify_socket_, text.data(), text.size() - 1, 0) > 0 &&
        std::string(text.data()).find("READY=1") != std::string::npos)
      ready_seconds_ = std::chrono::duration<double>(Clock::now() - start).count();
    if (!ready_seconds_ && process_.wait(0)) break;
  }
  close(notify_socket_);
}

nlohmann::json Daemon::call(const std::string& method, const nlohmann::json& params) {
  const nlohmann::json request = {{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}};
  const std::string answer = ask(socket(), request.dump());
  return answer.empty() ? nlohmann::json::object() : nlohmann::json::parse(answer);
}

nlohmann::json Daemon::result(const std::string& method, const nlohmann::json& params) {
  const nlohmann::json answer = call(method, params);
  if (!answer.contains("result")) throw std::runtime_error(method + ": " + answer.dump() + "\n" + log());
  return answer["result"];
}

int64_t Daemon::counter(const std::string& name) {
  return result("stats")["counters"].value(name, int64_t{0});
}

std::string Daemon::log() const { return read_text(folder_ / "log"); }

int connect_to(const std::filesystem::path& path) {
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_un address = address_of(path);
  if (connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0)
    return descriptor;
  close(descriptor);
  return -1;
}

std::string ask(const std::filesystem::path& path, const std::string& line, double seconds) {
  const int descriptor = connect_to(path);
  if (descriptor < 0) return "";
  const std::string request = line + "\n";
  std::string answer;
  if (send(descriptor, request.data(), request.size(), MSG_NOSIGNAL) ==
      static_cast<ssize_t>(request.size())) {
    pollfd wait{descriptor, POLLIN, 0};
    std::array<char, 65536> buffer;
    while (answer.find('\n') == std::string::npos && poll(&wait, 1, to_milliseconds(seconds)) == 1) {
      const ssize_t got = recv(descriptor, buffer.data(), buffer.size(), 0);
      if (got <= 0) break;
      answer.append(buffer.data(), static_cast<size_t>(got));
    }
  }
  close(descriptor);
  return answer.substr(0, answer.find('\n'));
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string program(const std::string& name) { return std::string(EDGEPOSE_PROGRAM_DIR) + "/" + name; }

}  // namespace edgepose::test
