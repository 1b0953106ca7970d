#include <nlohmann/json.hpp>

#include "daemon/json_rpc.h"
#include "daemon/params.h"
#include "fuzz/input_check.h"

namespace {

using namespace edgepose;

/// Only RpcError may come out.
template <class Read>
void ask(const Read& read) {
  try {
    read();
  } catch (const RpcError& error) {
    must_hold(error.what() != nullptr);
  }
}

}  // namespace

// A line that a client sends: taken apart, its parameters read as every type.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string line(text_of(data, size));
  ask([&] {
    const RpcRequest request = parse_request(line);
    must_hold(nlohmann::json::accept(request.id) && nlohmann::json::accept(request.params));
    must_hold(error_line(request.id, RpcCode::kBadInput, line).find('\n') == std::string::npos);
    const Params params(request.params, {"a", "name", "mesh", "unit", "models"});
    for (const std::string name : {"a", "name", "mesh", "unit", "models"}) {
      ask([&] { must_hold(!params.text(name).empty()); });
      ask([&] { params.flag(name, true); });
      ask([&] { must_hold(std::isfinite(params.number(name, 1))); });
      ask([&] { must_hold(params.path(name).front() == '/'); });
      if (params.has(name)) ask([&] { params.texts(name); });
    }
  });
  return 0;
}
