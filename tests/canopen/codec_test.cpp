#include <gtest/gtest.h>

#include <random>
#include <string>

#include "canopen/cob_id.h"
#include "canopen/emergency.h"
#include "canopen/joint_scale.h"
#include "canopen/little_endian.h"
#include "canopen/nmt.h"
#include "canopen/pdo.h"
#include "canopen/sdo.h"

namespace edgepose {
namespace {

constexpr int kRounds = 20000;

CanFrame any_frame(std::mt19937& random) {
  CanFrame frame;
  frame.id = static_cast<uint16_t>(random() & 0x7ff);
  frame.size = static_cast<uint8_t>(random() % 9);
  for (uint8_t& byte : frame.data) byte = static_cast<uint8_t>(random());
  return frame;
}

TEST(Codec, NmtAndHeartbeatAsTheStandardHasThem) {
  const CanFrame start = nmt_frame({.command = NmtCommand::kStart, .node = 5}, 7);
  EXPECT_EQ(start.id, 0x000);
  EXPECT_EQ(start.size, 2);
  EXPECT_EQ(start.data[0], 0x01);
  EXPECT_EQ(start.data[1], 5);
  EXPECT_EQ(start.time_ns, 7);
  const CanFrame beat = heartbeat_frame(5, NmtState::kOperational, 0);
  EXPECT_EQ(beat.id, 0x705);
  EXPECT_EQ(beat.size, 1);
  EXPECT_EQ(beat.data[0], 0x05);
  EXPECT_EQ(sync_frame(0).id, 0x080);
  EXPECT_EQ(sync_frame(0).size, 0);
}

TEST(Codec, NmtRoundTrip) {
  for (const int command : {1, 2, 128, 129, 130})
    for (int node = 0; node <= 127; ++node) {
      const auto back = decode_nmt(nmt_frame({.command = static_cast<NmtCommand>(command), .node = node}, 0));
      ASSERT_TRUE(back);
      EXPECT_EQ(static_cast<int>(back->command), command);
      EXPECT_EQ(back->node, node);
    }
  for (const int state : {0, 4, 5, 127})
    EXPECT_EQ(decode_heartbeat(heartbeat_frame(9, static_cast<NmtState>(state), 0)),
              static_cast<NmtState>(state));
  CanFrame wrong = heartbeat_frame(9, NmtState::kOperational, 0);
  wrong.data[0] = 6;
  EXPECT_FALSE(decode_heartbeat(wrong));
}

TEST(Codec, EmergencyRoundTripAndText) {
  std::mt19937 random(1);
  for (int i = 0; i < kRounds; ++i) {
    Emergency emergency{.code = static_cast<uint16_t>(random()),
                        .error_register = static_cast<uint8_t>(random()),
                        .manufacturer = {}};
    for (uint8_t& byte : emergency.manufacturer) byte = static_cast<uint8_t>(random());
    const auto back = decode_emergency(emergency_frame(1 + i % 127, emergency, 0));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->code, emergency.code);
    EXPECT_EQ(back->error_register, emergency.error_register);
    EXPECT_EQ(back->manufacturer, emergency.manufacturer);
    EXPECT_GT(std::string(cause_of(emergency.code)).size(), 3u);
  }
  EXPECT_EQ(text_of(Emergency{0x8611, 0, {}}), "0x8611 (following error)");
  EXPECT_EQ(text_of(Emergency{0x8130, 0, {}}), "0x8130 (life guard or heartbeat error)");
  EXPECT_EQ(text_of(Emergency{0x2340, 0, {}}), "0x2340 (current)") << "an unknown one has its class";
}

TEST(Codec, TargetPdoBytes) {
  const CanFrame frame = target_frame(3, {.controlword = 0x000f, .mode = 8, .position = -2}, 0);
  EXPECT_EQ(frame.id, 0x203);
  EXPECT_EQ(frame.size, 7);
  EXPECT_EQ(frame.data, (std::array<uint8_t, 8>{0x0f, 0x00, 8, 0xfe, 0xff, 0xff, 0xff, 0}));
}

TEST(Codec, StateAndMotionPdo) {
  const CanFrame frame{.id = 0x182, .size = 7, .data = {0x37, 0x16, 8, 0x00, 0x00, 0x00, 0x80}, .time_ns = 0};
  const auto state = decode_state(frame);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->statusword, 0x1637);
  EXPECT_EQ(state->mode, 8);
  EXPECT_EQ(state->position, INT32_MIN);
  const CanFrame moving{.id = 0x282, .size = 6, .data = {0xff, 0xff, 0xff, 0xff, 0x18, 0xfc}, .time_ns = 0};
  const auto motion = decode_motion(moving);
  ASSERT_TRUE(motion);
  EXPECT_EQ(motion->velocity, -1);
  EXPECT_EQ(motion->torque, -1000);
}

TEST(Codec, MappingsAreAsLongAsTheCodecs) {
  const auto bits = [](const auto& mapping) {
    unsigned sum = 0;
    for (const MappedObject& object : mapping) sum += object.bits;
    return sum;
  };
  EXPECT_EQ(bits(kRpdo1Mapping), 56u);
  EXPECT_EQ(bits(kTpdo1Mapping), 56u);
  EXPECT_EQ(bits(kTpdo2Mapping), 48u);
  EXPECT_EQ(kRpdo1Mapping[2].entry(), 0x607a'0020u);
  for (const MappedObject& object : kRpdo1Mapping) {
    EXPECT_EQ(MappedObject::from(object.entry()).id, object.id);
    EXPECT_EQ(MappedObject::from(object.entry()).bits, object.bits);
  }
}

TEST(Codec, ArbitraryFramesAreDecodedOrRefused) {
  std::mt19937 random(2);
  int decoded = 0;
  for (int i = 0; i < kRounds * 10; ++i) {
    const CanFrame frame = any_frame(random);
    if (const auto nmt = decode_nmt(frame)) {
      EXPECT_LE(nmt->node, 127);
    }
    if (const auto state = decode_state(frame)) {
      ++decoded;
      EXPECT_GE(frame.size, 7);
      EXPECT_EQ(state->statusword, frame.data[0] | frame.data[1] << 8);
    }
    if (decode_motion(frame)) {
      EXPECT_GE(frame.size, 6);
    }
    if (decode_emergency(frame)) {
      EXPECT_EQ(frame.size, 8);
    }
    if (decode_heartbeat(frame)) {
      EXPECT_EQ(frame.size, 1);
    }
  }
  EXPECT_GT(decoded, 100);
}

TEST(Codec, SdoExpeditedBytes) {
  // CiA 301's commands for 1 to 4 bytes: 2F, 2B, 27, 23.
  const uint8_t commands[] = {0x2f, 0x2b, 0x27, 0x23};
  const std::array<uint8_t, 4> data{1, 2, 3, 4};
  for (size_t size = 1; size <= 4; ++size) {
    const auto bytes = sdo::expedited(sdo::kDownload, {0x1017, 0}, std::span(data).first(size));
    EXPECT_EQ(bytes[0], commands[size - 1]);
    EXPECT_EQ(bytes[1], 0x17);
    EXPECT_EQ(bytes[2], 0x10);
    EXPECT_EQ(bytes[3], 0);
    const auto back = sdo::expedited_data(bytes);
    EXPECT_TRUE(
        std::equal(back.begin(), back.end(), data.begin(), data.begin() + static_cast<std::ptrdiff_t>(size)));
  }
  EXPECT_EQ(sdo::plain(sdo::kUpload, {0x1018, 1})[0], 0x40);
  EXPECT_EQ(sdo::reason_of(sdo::abort({0x1018, 9}, SdoAbort::kNoSubIndex)), SdoAbort::kNoSubIndex);
  EXPECT_EQ(sdo::object_of(sdo::abort({0x1018, 9}, SdoAbort::kNoSubIndex)), (ObjectId{0x1018, 9}));
}

TEST(Codec, SdoSegmentsRoundTrip) {
  std::mt19937 random(3);
  for (int i = 0; i < kRounds; ++i) {
    std::vector<uint8_t> data(random() % 8);
    for (uint8_t& byte : data) byte = static_cast<uint8_t>(random());
    const bool toggle = i & 1, last = i & 2;
    const auto bytes = sdo::segment(sdo::kDownloadSegment, toggle, last, data);
    const auto back = sdo::segment_data(bytes);
    EXPECT_EQ(std::vector<uint8_t>(back.begin(), back.end()), data);
    EXPECT_EQ((bytes[0] & sdo::kToggle) != 0, toggle);
    EXPECT_EQ((bytes[0] & sdo::kLast) != 0, last);
  }
}

TEST(Codec, LittleEndianRoundTrip) {
  std::mt19937_64 random(4);
  std::array<uint8_t, 8> bytes{};
  for (int i = 0; i < kRounds; ++i) {
    const auto value = static_cast<int32_t>(random());
    write_little_endian(value, bytes, 3);
    EXPECT_EQ(read_little_endian<int32_t>(bytes, 3), value);
    write_little_endian(static_cast<int16_t>(value), bytes, 1);
    EXPECT_EQ(read_little_endian<int16_t>(bytes, 1), static_cast<int16_t>(value));
    write_little_endian(static_cast<int8_t>(value), bytes, 7);
    EXPECT_EQ(read_little_endian<int8_t>(bytes, 7), static_cast<int8_t>(value));
  }
}

TEST(JointScale, CountsAndRadians) {
  const JointScale scale;
  EXPECT_EQ(scale.to_counts(2 * std::numbers::pi), 1 << 20);
  EXPECT_EQ(scale.to_counts(-std::numbers::pi), -(1 << 19));
  EXPECT_EQ(scale.to_counts(1e300), INT32_MAX);
  EXPECT_EQ(scale.to_counts(-1e300), INT32_MIN);
  std::mt19937 random(5);
  for (int i = 0; i < kRounds; ++i) {
    const auto counts = static_cast<int32_t>(random());
    EXPECT_EQ(scale.to_counts(scale.to_radians(counts)), counts);
  }
}

}  // namespace
}  // namespace edgepose
