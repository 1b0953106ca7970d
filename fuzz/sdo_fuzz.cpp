#include "canopen/drive_dictionary.h"
#include "canopen/sdo_client.h"
#include "canopen/sdo_server.h"
#include "fuzz/sink_bus.h"

// Eight bytes at a time, to a server and as answers to a client.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  const DriveOptions options;
  ObjectDictionary objects = make_drive_dictionary(options);
  objects.set_guard([&](ObjectId id, int64_t value) { return check_pdo_write(objects, id, value); });
  SdoServer server(objects, 1);
  SinkBus bus(nullptr, 0);
  SdoClient client(bus, 1);
  const uint8_t text[] = "a text that takes several segments";
  for (int64_t now = 0; size >= 8; now += 1'000'000, data += 8, size -= 8) {
    CanFrame frame{.id = 0x601, .size = 8, .data = {}, .time_ns = now};
    std::copy_n(data, 8, frame.data.begin());
    if (const auto answer = server.answer(frame, now)) must_hold(answer->id == 0x581 && answer->size == 8);
    if (client.state() != SdoClient::State::kBusy) {
      if (now / 1'000'000 % 2 == 0)
        client.upload(object::kDeviceName, now, 50'000'000);
      else
        client.download(object::kAxisName, text, now, 50'000'000);
    }
    frame.id = 0x581;
    client.take(frame, now);
    client.tick(now);
    must_hold(client.data().size() <= sdo::kMaxTransfer);
  }
  must_hold(objects.find(object::kAxisName)->text.size() <= ObjectEntry::kMaxText);
  must_hold(objects.value(object::kVendor) == options.identity.vendor);
  return 0;
}
