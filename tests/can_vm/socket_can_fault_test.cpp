// What goes wrong with a bus, as the kernel's own CAN says it.
#include <gmock/gmock.h>

#include "bus/open_bus.h"
#include "common/error.h"
#include "tests/can_vm/vcan.h"

namespace edgepose {
namespace {

using Kind = Received::Kind;

class SocketCanFault : public Vcan {
 protected:
  static BusEvent next_event(CanBus& bus) {
    const Received in = bus.receive(soon());
    return in.kind == Kind::kEvent ? in.event : BusEvent::kNone;
  }
  static std::string refusal(const std::string& name) {
    try {
      open_bus(name);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
};

TEST_F(SocketCanFault, AFullQueueDropsTheFrameAndNothingIsSentAgain) {
  ASSERT_TRUE(run("tc qdisc add dev vcan0 root tbf rate 200kbit burst 256 limit 2048"));
  SocketCanBus bus("vcan0"), listener("vcan0");
  std::vector<uint16_t> taken, heard;
  uint64_t refused = 0;
  const auto listen = [&](int64_t deadline) {
    for (Received in; (in = listener.receive(deadline)).kind == Kind::kFrame;) {
      heard.push_back(static_cast<uint16_t>(in.frame.data[0] | in.frame.data[1] << 8));
    }
  };
  for (uint16_t i = 0; i < 2000; ++i) {
    CanFrame out = frame(0x201, static_cast<uint8_t>(i));
    out.data[1] = static_cast<uint8_t>(i >> 8);
    const SendResult result = bus.send(out);
    if (result == SendResult::kSent) taken.push_back(i);
    refused += result == SendResult::kNoRoom;
    if (i % 64 == 0) listen(0);
  }
  for (const int64_t end = soon(3000); heard.size() < taken.size() && steady_ns() < end;) listen(soon(20));
  listen(soon(100));
  EXPECT_GT(refused, 0u);
  EXPECT_EQ(bus.counters().no_room, refused);
  EXPECT_EQ(bus.counters().sent, taken.size());
  EXPECT_EQ(taken.size() + refused, 2000u);
  EXPECT_EQ(heard, taken) << "each once, in order, and none that was refused";
}

TEST_F(SocketCanFault, ErrorFramesBecomeEvents) {
  SocketCanBus bus("vcan0", {.ids = {0x181}, .receive_buffer_bytes = 1 << 16, .confirm = {}});
  const struct {
    uint32_t error_class;
    uint8_t status;
    BusEvent event;
  } told[] = {
      {CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING, BusEvent::kErrorWarning},
      {CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE, BusEvent::kErrorPassive},
      {CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW, BusEvent::kControllerOverrun},
      {CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE, BusEvent::kErrorActive},
      {CAN_ERR_TX_TIMEOUT, 0, BusEvent::kTransmitTimeout},
      {CAN_ERR_LOSTARB, 0, BusEvent::kLostArbitration},
      {CAN_ERR_PROT, 0, BusEvent::kProtocolViolation},
      {CAN_ERR_TRX, 0, BusEvent::kTransceiver},
      {CAN_ERR_ACK, 0, BusEvent::kNoAcknowledge},
      {CAN_ERR_BUSERROR, 0, BusEvent::kBusError},
      {CAN_ERR_PROT | CAN_ERR_BUSOFF, 0, BusEvent::kBusOff},
      {CAN_ERR_RESTARTED, 0, BusEvent::kRestarted},
  };
  for (const auto& one : told) {
    raw->put_error(one.error_class, one.status);
    EXPECT_EQ(next_event(bus), one.event) << name_of(one.event);
  }
  EXPECT_EQ(bus.counters().events, std::size(told));
  EXPECT_EQ(bus.counters().not_decoded, 0u);
}

TEST_F(SocketCanFault, AfterBusOffNothingIsSentUntilTheControllerIsRestarted) {
  SocketCanBus bus("vcan0", {.ids = {}, .receive_buffer_bytes = 1 << 16, .confirm = {1}});
  SocketCanBus listener("vcan0");
  raw->put_error(CAN_ERR_BUSOFF);
  EXPECT_EQ(next_event(bus), BusEvent::kBusOff);
  EXPECT_EQ(next_event(listener), BusEvent::kBusOff);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(bus.send(frame(1)), SendResult::kDown);
  EXPECT_EQ(bus.counters().not_sent, 3u);
  EXPECT_EQ(bus.counters().unconfirmed, 0u);
  EXPECT_EQ(listener.receive(soon(50)).kind, Kind::kNothing);
  raw->put_error(CAN_ERR_RESTARTED);
  EXPECT_EQ(next_event(bus), BusEvent::kRestarted);
  EXPECT_EQ(bus.send(frame(2)), SendResult::kSent);
  EXPECT_EQ(next_event(listener), BusEvent::kRestarted);
  EXPECT_EQ(listener.receive(soon()).frame.id, 2);
}

TEST_F(SocketCanFault, LinkDownIsToldOnceAndTheBusWorksAgainAfterwards) {
  SocketCanBus bus("vcan0"), listener("vcan0");
  ASSERT_TRUE(run("ip link set vcan0 down"));
  EXPECT_EQ(next_event(bus), BusEvent::kDown);
  EXPECT_EQ(bus.receive(soon(20)).kind, Kind::kNothing);
  EXPECT_EQ(bus.send(frame(1)), SendResult::kDown);
  EXPECT_EQ(bus.counters().not_sent, 1u);
  EXPECT_EQ(next_event(listener), BusEvent::kDown);
  ASSERT_TRUE(run("ip link set vcan0 up"));
  EXPECT_EQ(bus.send(frame(2)), SendResult::kSent);
  EXPECT_EQ(listener.receive(soon()).frame.id, 2);
}

TEST_F(SocketCanFault, AnInterfaceThatIsDeletedIsDown) {
  SocketCanBus bus("vcan0");
  ASSERT_TRUE(run("ip link del vcan0"));
  EXPECT_EQ(next_event(bus), BusEvent::kDown);
  for (Received in; (in = bus.receive(0)).kind == Kind::kEvent;) EXPECT_EQ(in.event, BusEvent::kDown);
  EXPECT_EQ(bus.send(frame(1)), SendResult::kDown);
  EXPECT_EQ(bus.counters().not_sent, 1u);
}

TEST_F(SocketCanFault, WaitingEndsWhenTheLinkGoesDown) {
  SocketCanBus bus("vcan0");
  ASSERT_TRUE(run("(sleep 0.2; ip link set vcan0 down) &"));
  const int64_t before = steady_ns();
  const Received in = bus.receive(soon(10'000));
  EXPECT_EQ(in.event, BusEvent::kDown);
  EXPECT_LT(steady_ns() - before, 9000 * kMillisecond);
}

TEST_F(SocketCanFault, WrongInterfacesAreOneClearLine) {
  ASSERT_TRUE(run("ip link add vcan1 type vcan"));
  EXPECT_THAT(refusal("vcan1"), testing::HasSubstr("is down"));
  run("ip link del vcan1");
  EXPECT_THAT(refusal("vcan1"), testing::HasSubstr("no interface of this name"));
  EXPECT_THAT(refusal("lo"), testing::HasSubstr("an interface of another kind"));
  EXPECT_THAT(refusal("a_name_of_more_than_15"), testing::HasSubstr("22 characters"));
  for (const char* name : {"vcan1", "lo", "a_name_of_more_than_15"})
    EXPECT_THAT(refusal(name), testing::Not(testing::HasSubstr("\n")));
  EXPECT_EQ(refusal("vcan0"), "");
}

}  // namespace
}  // namespace edgepose
