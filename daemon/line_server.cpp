#include "daemon/line_server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "daemon/log.h"

namespace edgepose {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int kTick = 200;  // [ms] between looks for silent clients
constexpr std::chrono::seconds kFarewell{1};

}  // namespace

LineServer::LineServer(std::vector<ListeningSocket> sockets, Handler handler, Counters& counters,
                       const LineServerOptions& options)
    : sockets_(std::move(sockets)), handler_(std::move(handler)), counters_(counters), options_(options) {
  wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  if (wake_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
}

void LineServer::start() {
  thread_ = std::thread([this] { run(); });
}

LineServer::~LineServer() {
  stop();
  close(wake_);
}

void LineServer::stop() {
  stopping_ = true;
  eventfd_write(wake_, 1);
  if (thread_.joinable()) thread_.join();
}

void LineServer::answer(ClientId client, std::string line) {
  {
    const std::scoped_lock lock(mutex_);
    answers_.emplace_back(client, std::move(line));
  }
  eventfd_write(wake_, 1);
}

void LineServer::run() {
  Clock::time_point last = Clock::time_point::max();
  while (true) {
    if (stopping_ && last == Clock::time_point::max()) last = Clock::now() + kFarewell;
    take_answers();
    if (stopping_ && (finished() || Clock::now() > last)) return;
    std::vector<pollfd> waits = {{wake_, POLLIN, 0}};
    for (const ListeningSocket& socket : sockets_)
      waits.push_back({socket.descriptor(), static_cast<short>(stopping_ ? 0 : POLLIN), 0});
    std::vector<ClientId> ids;
    for (const auto& [id, client] : clients_) {
      const int events =
          (client->wants_to_receive() && !stopping_ ? POLLIN : 0) | (client->wants_to_send() ? POLLOUT : 0);
      waits.push_back({client->descriptor(), static_cast<short>(events), 0});
      ids.push_back(id);
    }
    if (poll(waits.data(), waits.size(), kTick) < 0 && errno != EINTR) {
      log_event(LogLevel::kError, "control_failed", {{"reason", std::strerror(errno)}});
      failed_ = true;
      return;
    }
    eventfd_t ignored = 0;
    eventfd_read(wake_, &ignored);
    for (size_t i = 0; i < sockets_.size(); ++i)
      if (waits[1 + i].revents != 0) accept_from(sockets_[i]);
    for (size_t i = 0; i < ids.size(); ++i)
      if (const short events = waits[1 + sockets_.size() + i].revents; events != 0) {
        const auto client = clients_.find(ids[i]);
        if (client != clients_.end()) serve(ids[i], *client->second, events);
      }
    drop_silent();
  }
}

void LineServer::accept_from(const ListeningSocket& socket) {
  const int descriptor = accept4(socket.descriptor(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (descriptor < 0) {
    if (errno != EMFILE && errno != ENFILE) return;
    // The client waits on; without a pause this would be asked again at once.
    log_limited(LogLevel::kError, "client_turned_away", "no descriptors left", {});
    std::this_thread::sleep_for(std::chrono::milliseconds(kTick));
    return;
  }
  if (clients_.size() >= static_cast<size_t>(options_.max_clients)) {
    counters_.add("clients_turned_away");
    log_limited(LogLevel::kWarning, "client_turned_away", "too many clients",
                {{"max_clients", std::to_string(options_.max_clients)}});
    close(descriptor);
    return;
  }
  counters_.add("clients");
  clients_.emplace(next_id_++, std::make_unique<LineConnection>(descriptor, socket.is_tcp()));
}

void LineServer::serve(ClientId id, LineConnection& client, short events) {
  if ((events & POLLIN) != 0 && client.wants_to_receive()) {
    if (!client.receive()) return drop(id, client.too_long() ? "a request that is too long" : "");
  } else if ((events & (POLLHUP | POLLERR)) != 0) {
    return drop(id, "");  // nobody is left to take an answer
  }
  if ((events & POLLOUT) != 0 && !client.send()) return drop(id, "");
  work_on_lines(id, client);
}

/// Until an answer has to be waited for.
void LineServer::work_on_lines(ClientId id, LineConnection& client) {
  while (!client.busy) {
    const std::optional<std::string> line = client.next_line();
    if (!line) break;
    if (line->empty()) continue;
    // A web page may send a request to the loopback whose body looks like a command; its first line does not.
    if (client.over_tcp() && line->front() != '{') return drop(id, "what is no request");
    const std::optional<std::string> reply = handler_(id, *line);
    client.busy = !reply;
    if (reply && !reply->empty() && !client.queue(*reply)) return drop(id, "answers that it does not take");
    if (!client.send()) return drop(id, "");
  }
  if (client.ended() && !client.busy && !client.wants_to_send() && !client.has_line()) drop(id, "");
}

void LineServer::take_answers() {
  std::vector<std::pair<ClientId, std::string>> ready;
  {
    const std::scoped_lock lock(mutex_);
    ready.swap(answers_);
  }
  for (const auto& [id, line] : ready) {
    const auto client = clients_.find(id);
    if (client == clients_.end()) continue;
    client->second->busy = false;
    client->second->last_heard = Clock::now();
    if (!line.empty() && !client->second->queue(line)) {
      drop(id, "answers that it does not take");
    } else if (!client->second->send()) {
      drop(id, "");
    } else {
      work_on_lines(id, *client->second);
    }
  }
}

/// Without a cause: the client has left by itself.
void LineServer::drop(ClientId id, const std::string& cause) {
  if (!cause.empty()) {
    counters_.add("clients_cut_off");
    log_limited(LogLevel::kWarning, "client_cut_off", cause, {});
  }
  clients_.erase(id);
}

void LineServer::drop_silent() {
  const auto now = Clock::now();
  std::vector<ClientId> silent;
  for (const auto& [id, client] : clients_)
    if (!client->busy &&
        std::chrono::duration<double>(now - client->last_heard).count() > options_.client_timeout)
      silent.push_back(id);
  for (const ClientId id : silent) drop(id, "silence");
}

bool LineServer::finished() const {
  for (const auto& [id, client] : clients_)
    if (client->busy || client->wants_to_send()) return false;
  return true;
}

}  // namespace edgepose
