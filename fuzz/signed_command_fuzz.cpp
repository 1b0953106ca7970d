#include "fuzz/input_check.h"
#include "messaging/signed_command.h"

// What is read comes back from its own line, and has no signature unless somebody who has the key made it.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  static const SecretKey key = SecretKey::random();
  SignedCommand command, again;
  const std::string fault = parse_signed_command(text_of(data, size), command);
  for (const unsigned char c : fault) must_hold(c >= ' ');
  if (!fault.empty()) return 0;
  must_hold(!verify(key, command));
  must_hold(parse_signed_command(to_line(command), again).empty());
  must_hold(again.text == command.text && again.session == command.session &&
            again.counter == command.counter && again.utime == command.utime && again.tag == command.tag);
  return 0;
}
