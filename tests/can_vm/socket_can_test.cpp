// The SocketCAN backend on the kernel's own CAN: what comes, when, and from whom.
#include <ctime>

#include "common/error.h"

#include "tests/can_vm/vcan.h"

namespace edgepose {
namespace {

using Kind = Received::Kind;

class SocketCan : public Vcan {};

TEST_F(SocketCan, WhatOneSendsTheOtherReceives) {
  SocketCanBus a("vcan0"), b("vcan0");
  for (uint8_t size = 0; size <= 8; ++size) {
    CanFrame out = frame(static_cast<uint16_t>(size * 0xff), 0xa0, size);
    for (uint8_t i = 0; i < size; ++i) out.data[i] = static_cast<uint8_t>(0x11 * i + size);
    if (size == 0) out.data = {};
    ASSERT_EQ(a.send(out), SendResult::kSent);
    const Received in = b.receive(soon());
    ASSERT_EQ(in.kind, Kind::kFrame);
    EXPECT_TRUE(in.frame.says_the_same(out)) << int{size};
  }
  EXPECT_EQ(a.counters().sent, 9u);
  EXPECT_EQ(b.counters().received, 9u);
  EXPECT_EQ(a.receive(0).kind, Kind::kNothing) << "own frames do not come back";
  EXPECT_EQ(a.counters().received, 0u);
  EXPECT_EQ(a.counters().unconfirmed, 0u) << "not asked for";
}

TEST_F(SocketCan, WaitsUntilItsDeadline) {
  SocketCanBus bus("vcan0");
  const int64_t before = steady_ns();
  EXPECT_EQ(bus.receive(before + 30 * kMillisecond).kind, Kind::kNothing);
  EXPECT_GE(steady_ns() - before, 30 * kMillisecond);
}

TEST_F(SocketCan, FramesBearTheTimeAtWhichTheyCame) {
  SocketCanBus a("vcan0"), b("vcan0");
  const int64_t before = steady_ns();
  ASSERT_EQ(a.send(frame(1)), SendResult::kSent);
  const int64_t after = steady_ns();
  usleep(50'000);  // read late
  const Received in = b.receive(soon());
  ASSERT_EQ(in.kind, Kind::kFrame);
  constexpr int64_t kConversion = kMillisecond;  // from the wall clock
  EXPECT_GE(in.frame.time_ns, before - kConversion);
  EXPECT_LE(in.frame.time_ns, after + kConversion);
}

TEST_F(SocketCan, SettingTheClockDoesNotMoveFrameTimes) {
  if (!std::getenv("EDGEPOSE_CAN_VM")) GTEST_SKIP() << "NOT TESTED: sets the clock, which only a guest may";
  SocketCanBus a("vcan0"), b("vcan0");
  for (const time_t step : {3600, -3600}) {
    const int64_t before = steady_ns();
    ASSERT_EQ(a.send(frame(1)), SendResult::kSent);
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    now.tv_sec += step;
    ASSERT_EQ(clock_settime(CLOCK_REALTIME, &now), 0);
    const Received in = b.receive(soon());
    ASSERT_EQ(in.kind, Kind::kFrame);
    EXPECT_GE(in.frame.time_ns, before) << step;
    EXPECT_LE(in.frame.time_ns, steady_ns()) << step;
  }
}

TEST_F(SocketCan, FiltersForExactIdentifiers) {
  SocketCanBus bus("vcan0", {.ids = {0x181, 0x701}, .receive_buffer_bytes = 1 << 16, .confirm = {}});
  const uint8_t data[2] = {1, 2};
  for (const uint32_t id : {0x180u, 0x181u, 0x182u, 0x581u, 0x701u, 0x781u, 0x181u | CAN_EFF_FLAG,
                            0x181u | CAN_RTR_FLAG, 0x101u, 0x7ffu})
    raw->put(id, data);
  EXPECT_EQ(bus.receive(soon()).frame.id, 0x181);
  EXPECT_EQ(bus.receive(soon()).frame.id, 0x701);
  EXPECT_EQ(bus.receive(0).kind, Kind::kNothing);
  EXPECT_EQ(bus.counters().not_decoded, 0u) << "the kernel has kept them away";
}

TEST_F(SocketCan, AtMost512Filters) {
  SocketCanOptions options;
  for (uint16_t id = 0; id < 512; ++id) options.ids.push_back(id);
  EXPECT_NO_THROW(SocketCanBus("vcan0", options));
  options.ids.push_back(512);
  EXPECT_THROW(SocketCanBus("vcan0", options), InputError);
}

TEST_F(SocketCan, OtherKindsOfFramesAreCounted) {
  SocketCanBus bus("vcan0");
  const uint8_t data[2] = {1, 2};
  raw->put(0x12345678u | CAN_EFF_FLAG, data);
  raw->put(0x123u | CAN_RTR_FLAG, data);
  raw->put_fd(0x124, 8);
  raw->put_fd(0x125, 64);
  raw->put(0x126, data);
  const Received in = bus.receive(soon());
  EXPECT_EQ(in.kind, Kind::kFrame);
  EXPECT_EQ(in.frame.id, 0x126);
  EXPECT_EQ(bus.counters().not_decoded, 4u);
  EXPECT_EQ(bus.counters().received, 1u);
}

TEST_F(SocketCan, FramesThatFindNoRoomAreCountedAsLost) {
  SocketCanBus bus("vcan0", {.ids = {}, .receive_buffer_bytes = 4096, .confirm = {}});
  const uint8_t data[1] = {0};
  constexpr uint64_t kBurst = 100;
  for (uint64_t i = 0; i < kBurst; ++i) raw->put(1, data);
  usleep(50'000);  // all have come
  while (bus.receive(0).kind == Kind::kFrame) continue;
  const uint64_t before = bus.counters().received;
  EXPECT_LT(before, kBurst);
  EXPECT_EQ(bus.counters().lost, 0u) << "known with the next frame only";
  raw->put(2, data);
  EXPECT_EQ(bus.receive(soon()).frame.id, 2);
  EXPECT_EQ(bus.counters().lost, kBurst - before);
}

TEST_F(SocketCan, OwnFramesAreConfirmedWhenTheyHaveBeenOnTheWire) {
  ASSERT_TRUE(run("tc qdisc add dev vcan0 root tbf rate 8kbit burst 32 limit 1000"));  // 62 frames a second
  SocketCanBus bus("vcan0", {.ids = {0x181}, .receive_buffer_bytes = 1 << 16, .confirm = {0x80}});
  SocketCanBus listener("vcan0");
  for (uint8_t i = 0; i < 12; ++i) {
    ASSERT_EQ(bus.send(frame(0x80, i)), SendResult::kSent);
    ASSERT_EQ(bus.send(frame(0x201, i)), SendResult::kSent) << "not asked for";
  }
  uint64_t heard = 0;
  const auto listen = [&] {
    while (listener.receive(0).kind == Kind::kFrame) ++heard;
  };
  EXPECT_EQ(bus.receive(0).kind, Kind::kNothing) << "a confirmation is no frame";
  EXPECT_GE(bus.counters().unconfirmed, 6u) << "the queue holds them back";
  EXPECT_EQ(bus.counters().unconfirmed + bus.counters().confirmed, 12u);
  for (const int64_t end = soon(5000); bus.counters().unconfirmed > 0 && steady_ns() < end;) {
    EXPECT_EQ(bus.receive(soon(20)).kind, Kind::kNothing);
    listen();
    EXPECT_LE(bus.counters().confirmed, heard) << "nothing is confirmed before it was on the wire";
  }
  EXPECT_EQ(bus.counters().confirmed, 12u);
  // The same frame by another is none of ours.
  const uint8_t data[1] = {0};
  raw->put(0x80, data);
  raw->put(0x181, data);
  EXPECT_EQ(bus.receive(soon(2000)).frame.id, 0x181);
  EXPECT_EQ(bus.counters().confirmed, 12u);
}

}  // namespace
}  // namespace edgepose
