#include "server/http_endpoint.h"

#include <arpa/inet.h>
#include <microhttpd.h>
#include <netinet/in.h>

#include <cerrno>
#include <cstring>

#include "common/error.h"

namespace edgepose {
namespace {

constexpr unsigned kMaxConnections = 16, kTimeout = 5;  // [s]
constexpr size_t kMemory = 32 << 10;                    // [bytes] of a connection

MHD_Result respond(MHD_Connection* connection, const HttpAnswer& answer) {
  MHD_Response* response = MHD_create_response_from_buffer(
      answer.body.size(), const_cast<char*>(answer.body.data()), MHD_RESPMEM_MUST_COPY);
  if (response == nullptr) return MHD_NO;
  MHD_add_response_header(response, MHD_HTTP_HEADER_CONTENT_TYPE, answer.type.c_str());
  const MHD_Result queued = MHD_queue_response(connection, static_cast<unsigned>(answer.status), response);
  MHD_destroy_response(response);
  return queued;
}

MHD_Result on_request(void* endpoint, MHD_Connection* connection, const char* path, const char* method,
                      const char* /*version*/, const char* /*body*/, size_t* body_size, void** seen) {
  // The first call comes before a body, if there is one; it must be swallowed before the answer.
  static int marker;
  if (*seen == nullptr) {
    *seen = &marker;
    return MHD_YES;
  }
  if (*body_size > 0) {
    *body_size = 0;
    return MHD_YES;
  }
  if (std::strcmp(method, MHD_HTTP_METHOD_GET) != 0)
    return respond(connection, {MHD_HTTP_METHOD_NOT_ALLOWED, "text/plain; charset=utf-8", "only GET\n"});
  return respond(connection, static_cast<HttpEndpoint*>(endpoint)->handler()(path));
}

}  // namespace

HttpEndpoint::HttpEndpoint(int port, Handler handler) : handler_(std::move(handler)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  daemon_ = MHD_start_daemon(MHD_USE_INTERNAL_POLLING_THREAD, static_cast<uint16_t>(port), nullptr, nullptr,
                             &on_request, this, MHD_OPTION_SOCK_ADDR, reinterpret_cast<sockaddr*>(&address),
                             MHD_OPTION_CONNECTION_LIMIT, kMaxConnections, MHD_OPTION_CONNECTION_TIMEOUT,
                             kTimeout, MHD_OPTION_CONNECTION_MEMORY_LIMIT, kMemory, MHD_OPTION_END);
  if (daemon_ == nullptr)
    throw InputError::at("127.0.0.1:" + std::to_string(port), "a port that is free (service.http_port)",
                         std::strerror(errno));
}

HttpEndpoint::~HttpEndpoint() { MHD_stop_daemon(daemon_); }

}  // namespace edgepose
