#include "fuzz/input_check.h"
#include "server/training_messages.h"

// What the child prints, and what it is told.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  const std::string text(text_of(data, size));
  reads([&] { parse_report(text); });
  reads([&] {
    const TrainingOrder order = parse_order(text);
    must_hold(parse_order(to_text(order)).options.seed == order.options.seed);
  });
  return 0;
}
