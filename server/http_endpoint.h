#pragma once
#include <functional>
#include <string>

struct MHD_Daemon;

namespace edgepose {

/// What is answered to a GET.
struct HttpAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8", body;
};

/// Answers GET requests on a TCP port of the loopback, on a thread of its own (libmicrohttpd). Clients,
/// their memory and their time are limited.
class HttpEndpoint {
 public:
  /// Called on the endpoint's thread; must not throw.
  using Handler = std::function<HttpAnswer(const std::string& path)>;

  /// Throws InputError if the port is taken.
  HttpEndpoint(int port, Handler handler);
  HttpEndpoint(const HttpEndpoint&) = delete;
  HttpEndpoint& operator=(const HttpEndpoint&) = delete;
  ~HttpEndpoint();

  const Handler& handler() const { return handler_; }

 private:
  const Handler handler_;
  MHD_Daemon* daemon_ = nullptr;
};

}  // namespace edgepose
