#include "client/service/control_client.h"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>

#include "client/service/clock.h"
#include "client/service/control_socket.h"
#include "messaging/signed_command.h"

namespace edgepose {
namespace {

using nlohmann::json;
using std::chrono::steady_clock;

constexpr auto kWaitingInterval = std::chrono::milliseconds(100);

/// These change something (docs/control.md, "Signed commands").
bool is_to_be_signed(const std::string& method) {
  return method == "models.register" || method == "models.unregister" || method == "models.activate" ||
         method == "shutdown";
}

/// [ms] to hand to poll(), rounded up, at most `most`.
int milliseconds_until(SteadyTime end, std::chrono::milliseconds most) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - steady_clock::now());
  return static_cast<int>(std::clamp(left, std::chrono::milliseconds(0), most).count());
}

json result_of(const std::string& line, int64_t id, const ControlAddress& address) {
  const json answer = json::parse(line, nullptr, false);
  const auto malformed = [&](const std::string& found) {
    throw InputError::at(address.text(), "a JSON-RPC answer", found,
                         "is it " + address.program + " that listens there?");
  };
  if (!answer.is_object()) malformed("other text");
  if (const auto error = answer.find("error"); error != answer.end()) {
    if (!error->is_object() || !error->contains("message") || !error->at("message").is_string())
      malformed("an error without a message");
    const auto code = error->find("code");
    const bool has_code = code != error->end() && code->is_number_integer();
    throw ControlError(has_code ? code->get<int>() : 0, error->at("message").get<std::string>());
  }
  const auto number = answer.find("id"), result = answer.find("result");
  if (number == answer.end() || !number->is_number_integer() || number->get<int64_t>() != id)
    malformed("the answer to another request");
  if (result == answer.end()) malformed("neither a result nor an error");
  return *result;
}

}  // namespace

std::string ControlAddress::text() const {
  return port > 0 ? "127.0.0.1:" + std::to_string(port) : socket.string();
}

ControlClient::ControlClient(const ControlAddress& address, const std::optional<SecretKey>& key)
    : address_(address), key_(key), socket_(open_control_socket(address)), session_(utime_now()) {}

ControlClient::~ControlClient() { close(socket_); }

json ControlClient::call(const std::string& method, const json& params, double timeout,
                         const Waiting& waiting) {
  json request = {{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}};
  if (!params.is_null()) request["params"] = params;
  std::string line;
  try {
    line = envelope(method, request.dump());
  } catch (const json::type_error&) {
    throw InputError::at(method, "names in UTF-8", "other bytes");
  }
  if (line.size() + 1 > kMaxRequestBytes)
    throw InputError::at(method, "a request of at most 64 KiB", std::to_string(line.size()) + " bytes");
  send(line + "\n", timeout);
  return result_of(receive(timeout, waiting), id_, address_);
}

std::string ControlClient::envelope(const std::string& method, std::string request) {
  if (!key_ || !is_to_be_signed(method)) return request;
  return to_line(sign(*key_, std::move(request), session_, ++counter_, utime_now()));
}

void ControlClient::send(const std::string& line, double timeout) {
  const SteadyTime end = steady_clock::now() + steady_seconds(timeout);
  for (size_t sent = 0; sent < line.size();) {
    const ssize_t some = ::send(socket_, line.data() + sent, line.size() - sent, MSG_NOSIGNAL);
    if (some > 0) sent += static_cast<size_t>(some);
    if (some >= 0 || errno == EINTR) continue;
    // Who has refused us may have said why before hanging up.
    if (errno == EPIPE || errno == ECONNRESET) return;
    if (errno != EAGAIN)
      throw InputError::at(address_.text(), "a daemon that takes requests", std::strerror(errno));
    pollfd waits{socket_, POLLOUT, 0};
    if (poll(&waits, 1, milliseconds_until(end, std::chrono::seconds(60))) == 0 && steady_clock::now() >= end)
      throw InputError::at(address_.text(), "a daemon that takes requests", "none taken in time");
  }
}

std::string ControlClient::receive(double timeout, const Waiting& waiting) {
  const SteadyTime start = steady_clock::now(), end = start + steady_seconds(timeout);
  std::array<char, 16384> buffer;
  for (size_t searched = 0;;) {
    if (const size_t at = rest_.find('\n', searched); at != std::string::npos) {
      std::string line = rest_.substr(0, at);
      rest_.erase(0, at + 1);
      return line;
    }
    searched = rest_.size();
    if (rest_.size() > kMaxAnswerBytes)
      throw InputError::at(address_.text(), "an answer of at most 16 MiB", "a longer one");
    if (waiting) waiting(std::chrono::duration<double>(steady_clock::now() - start).count());
    pollfd waits{socket_, POLLIN, 0};
    if (poll(&waits, 1, milliseconds_until(end, kWaitingInterval)) <= 0) {
      if (steady_clock::now() < end) continue;
      throw InputError::at(address_.text(), "an answer within " + std::to_string(timeout) + " s", "none",
                           "--timeout waits longer; the daemon may be busy");
    }
    const ssize_t some = recv(socket_, buffer.data(), buffer.size(), 0);
    if (some > 0) rest_.append(buffer.data(), static_cast<size_t>(some));
    if (some > 0 || (some < 0 && (errno == EINTR || errno == EAGAIN))) continue;
    throw InputError::at(address_.text(), "an answer",
                         some == 0 ? "a connection that was closed" : std::strerror(errno));
  }
}

}  // namespace edgepose
