#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "daemon/counters.h"
#include "daemon/line_connection.h"
#include "daemon/listening_socket.h"

namespace edgepose {

struct LineServerOptions {
  int max_clients = 16;        ///< at once; others are turned away
  double client_timeout = 60;  ///< [s] without a whole request or a taken answer, while none is being made
};

/// Serves clients that send a request a line and get an answer a line, on a thread of its own. One request of
/// a client is worked on at a time, so answers keep the order. A client that is slow, silent or sends too
/// much is cut off and counted; it never holds up another.
class LineServer {
 public:
  using ClientId = uint64_t;
  /// Called on the server's thread, must be quick: gives the answer at once (empty: none is sent), or keeps
  /// `client` and calls answer() later, from any thread. Must not throw.
  using Handler = std::function<std::optional<std::string>(ClientId client, const std::string& line)>;

  LineServer(std::vector<ListeningSocket> sockets, Handler handler, Counters& counters,
             const LineServerOptions& options);
  LineServer(const LineServer&) = delete;
  LineServer& operator=(const LineServer&) = delete;
  ~LineServer();

  /// Serves from now on.
  void start();
  /// Takes no more requests; answers that are being made are still sent, for at most a second. Afterwards
  /// answer() does nothing.
  void stop();
  /// The system has refused to go on; nobody is served any more.
  bool failed() const { return failed_; }

  /// The answer to a request that the handler kept; dropped if the client has gone.
  void answer(ClientId client, std::string line);

 private:
  void run();
  void accept_from(const ListeningSocket& socket);
  void serve(ClientId id, LineConnection& client, short events);
  void work_on_lines(ClientId id, LineConnection& client);
  void take_answers();
  void drop(ClientId id, const std::string& cause);
  void drop_silent();
  bool finished() const;

  std::vector<ListeningSocket> sockets_;
  const Handler handler_;
  Counters& counters_;
  const LineServerOptions options_;
  std::map<ClientId, std::unique_ptr<LineConnection>> clients_;
  ClientId next_id_ = 1;
  int wake_ = -1;
  std::atomic<bool> stopping_ = false, failed_ = false;
  std::mutex mutex_;
  std::vector<std::pair<ClientId, std::string>> answers_;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace edgepose
