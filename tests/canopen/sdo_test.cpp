#include <gtest/gtest.h>

#include <random>

#include "bus/loop_wire.h"
#include "canopen/drive_dictionary.h"
#include "canopen/sdo_client.h"
#include "canopen/sdo_server.h"

namespace edgepose {
namespace {

constexpr int64_t kTimeout = 300'000'000;

/// A client and a server of node 4 on one wire.
class Sdo : public testing::Test {
 protected:
  /// Lets both speak until the client has nothing under way.
  void run() {
    for (int i = 0; i < 1000 && client_.state() == SdoClient::State::kBusy; ++i) {
      for (Received got; (got = there_.receive(0)).kind == Received::Kind::kFrame;)
        if (const auto answer = server_.answer(got.frame, now_)) there_.send(*answer);
      for (Received got; (got = here_.receive(0)).kind == Received::Kind::kFrame;)
        client_.take(got.frame, now_);
      now_ += 1'000'000;
      client_.tick(now_);
    }
  }
  SdoAbort write(ObjectId id, const std::vector<uint8_t>& bytes) {
    client_.download(id, bytes, now_, kTimeout);
    run();
    return client_.abort_reason();
  }
  std::string read_text(ObjectId id) {
    client_.upload(id, now_, kTimeout);
    run();
    EXPECT_EQ(client_.state(), SdoClient::State::kDone);
    return {client_.data().begin(), client_.data().end()};
  }
  LoopWire wire_;
  LoopWire::Port &here_ = wire_.port(), &there_ = wire_.port();
  DriveOptions options_;
  ObjectDictionary objects_ = make_drive_dictionary(options_);
  SdoServer server_{objects_, 4};
  SdoClient client_{here_, 4};
  int64_t now_ = 0;
};

TEST_F(Sdo, ExpeditedUpload) {
  client_.upload(object::kVendor, now_, kTimeout);
  run();
  ASSERT_EQ(client_.state(), SdoClient::State::kDone);
  EXPECT_EQ(number_from(ObjectType::kU32, client_.data()), 0xed9);
}

TEST_F(Sdo, SegmentedUploadOfTheName) {
  EXPECT_EQ(read_text(object::kDeviceName), "edgepose simulated drive");
}

TEST_F(Sdo, TextsOfEveryLengthThereAndBack) {
  std::mt19937 random(6);
  for (size_t length = 0; length <= ObjectEntry::kMaxText; ++length) {
    std::vector<uint8_t> text(length);
    for (uint8_t& byte : text) byte = static_cast<uint8_t>(random());
    ASSERT_EQ(write(object::kAxisName, text), SdoAbort::kNone) << length;
    ASSERT_EQ(client_.state(), SdoClient::State::kDone) << length;
    EXPECT_EQ(read_text(object::kAxisName), std::string(text.begin(), text.end()));
  }
  EXPECT_EQ(write(object::kAxisName, std::vector<uint8_t>(65)), SdoAbort::kTooLong);
  EXPECT_EQ(write(object::kAxisName, std::vector<uint8_t>(257)), SdoAbort::kOutOfMemory);
}

TEST_F(Sdo, WhatTheDictionaryRefuses) {
  EXPECT_EQ(write({0x2345, 0}, {1}), SdoAbort::kNoObject);
  EXPECT_EQ(write({0x1018, 9}, {1}), SdoAbort::kNoSubIndex);
  EXPECT_EQ(write(object::kVendor, {1, 0, 0, 0}), SdoAbort::kReadOnly);
  EXPECT_EQ(write(object::kProducerHeartbeat, {1}), SdoAbort::kTooShort);
  EXPECT_EQ(write(object::kProducerHeartbeat, {1, 2, 3}), SdoAbort::kTooLong);
  EXPECT_EQ(write(object::kAbortOption, {4, 0}), SdoAbort::kTooHigh);
  EXPECT_EQ(write(object::kAbortOption, {0xff, 0xff}), SdoAbort::kTooLow);
  EXPECT_EQ(objects_.value(object::kAbortOption), 1) << "its default";
  EXPECT_EQ(write(object::kAbortOption, {3, 0}), SdoAbort::kNone);
  EXPECT_EQ(objects_.value(object::kAbortOption), 3);
}

TEST_F(Sdo, NumbersOfEveryTypeThereAndBack) {
  objects_.add({.id = {0x2001, 0}, .type = ObjectType::kI8, .access = ObjectAccess::kReadWrite});
  for (const ObjectId id : {ObjectId{0x2001, 0}, object::kProducerHeartbeat, object::kTargetPosition}) {
    const ObjectType type = objects_.find(id)->type;
    for (const int64_t value : {0, 1, 100, 127}) {
      std::vector<uint8_t> bytes;
      append_number(type, value, bytes);
      ASSERT_EQ(write(id, bytes), SdoAbort::kNone);
      EXPECT_EQ(objects_.value(id), value);
    }
  }
  ASSERT_EQ(write(object::kTargetPosition, {0xff, 0xff, 0xff, 0xff}), SdoAbort::kNone);
  EXPECT_EQ(objects_.value(object::kTargetPosition), -1);
}

TEST_F(Sdo, NobodyAnswersIsATimeoutAfterTheDeadline) {
  wire_.drop = [](const CanFrame& frame) { return frame.id == 0x584; };
  client_.upload(object::kVendor, now_, kTimeout);
  run();
  EXPECT_EQ(client_.state(), SdoClient::State::kTimedOut);
  EXPECT_EQ(now_, kTimeout);
  EXPECT_EQ(wire_.trace.back().data[0], 0x80) << "and the node is told";
}

TEST_F(Sdo, ARequestWaitsForRoomOnTheBus) {
  here_.answer = SendResult::kNoRoom;
  client_.upload(object::kVendor, now_, kTimeout);
  client_.tick(now_ + 1);
  EXPECT_EQ(wire_.trace.size(), 0u);
  here_.answer = SendResult::kSent;
  client_.tick(now_ + 2);
  run();
  EXPECT_EQ(client_.state(), SdoClient::State::kDone);
}

TEST_F(Sdo, AnswersThatNobodyAskedForAreCounted) {
  client_.take({.id = 0x584, .size = 8, .data = sdo::plain(sdo::kDownloadTaken, {0x6060, 0}), .time_ns = 0},
               now_);
  EXPECT_EQ(client_.unasked(), 1u);
}

TEST_F(Sdo, WrongToggleIsAborted) {
  const auto ask = [&](const sdo::Bytes& bytes) {
    return server_.answer({.id = 0x604, .size = 8, .data = bytes, .time_ns = 0}, now_)->data;
  };
  ask(sdo::plain(sdo::kUpload, object::kDeviceName));
  ask(sdo::plain(sdo::kUploadSegment, {}));
  EXPECT_EQ(sdo::reason_of(ask(sdo::plain(sdo::kUploadSegment, {}))), SdoAbort::kToggle);
  EXPECT_EQ(sdo::reason_of(ask(sdo::plain(sdo::kUploadSegment, {}))), SdoAbort::kUnknownCommand)
      << "no transfer any more";
}

TEST_F(Sdo, MoreThanAnnouncedIsRefused) {
  const auto ask = [&](const sdo::Bytes& bytes) {
    return server_.answer({.id = 0x604, .size = 8, .data = bytes, .time_ns = 0}, now_)->data;
  };
  const std::vector<uint8_t> seven(7, 0x41);
  ask(sdo::segmented(sdo::kDownload, object::kAxisName, 8));
  EXPECT_EQ(sdo::reason_of(ask(sdo::segment(sdo::kDownloadSegment, false, true, seven))),
            SdoAbort::kWrongLength);
  EXPECT_EQ(sdo::reason_of(ask(sdo::segmented(sdo::kDownload, object::kAxisName, 1 << 30))),
            SdoAbort::kOutOfMemory);
  EXPECT_EQ(read_text(object::kAxisName), "");
}

TEST_F(Sdo, ArbitraryBytesToServerAndClient) {
  std::mt19937 random(7);
  int answered = 0;
  for (int i = 0; i < 200000; ++i) {
    CanFrame frame{.id = 0x604, .size = 8, .data = {}, .time_ns = 0};
    for (uint8_t& byte : frame.data) byte = static_cast<uint8_t>(random());
    if (random() % 2) frame.data[1] = 0x00, frame.data[2] = 0x20, frame.data[3] = 0;  // the text
    if (const auto answer = server_.answer(frame, now_)) {
      ++answered;
      EXPECT_EQ(answer->id, 0x584);
    }
    if (client_.state() != SdoClient::State::kBusy) client_.upload(object::kDeviceName, now_, kTimeout);
    frame.id = 0x584;
    client_.take(frame, now_);
    EXPECT_LE(client_.data().size(), sdo::kMaxTransfer);
    wire_.trace.clear();
    while (there_.receive(0).kind != Received::Kind::kNothing) {
    }
  }
  EXPECT_GT(answered, 100000);
  EXPECT_LE(objects_.find(object::kAxisName)->text.size(), ObjectEntry::kMaxText);
}

TEST(SdoAbortText, EachHasItsOwnWords) {
  EXPECT_STREQ(text_of(SdoAbort::kNoObject), "object does not exist");
  EXPECT_STREQ(text_of(static_cast<SdoAbort>(0x1234)), "unknown abort code");
}

TEST(PdoMapping, IsCheckedAsTheStandardSays) {
  DriveOptions options;
  ObjectDictionary objects = make_drive_dictionary(options);
  objects.set_guard([&](ObjectId id, int64_t value) { return check_pdo_write(objects, id, value); });
  const auto write = [&](uint16_t index, uint8_t sub, uint32_t value, ObjectType type = ObjectType::kU32) {
    std::vector<uint8_t> bytes;
    append_number(type, value, bytes);
    return objects.write({index, sub}, bytes);
  };
  EXPECT_EQ(write(0x1a00, 1, 0x6041'0010), SdoAbort::kNone);
  EXPECT_EQ(write(0x1a00, 2, 0x6502'0020), SdoAbort::kNone);
  EXPECT_EQ(write(0x1a00, 0, 2, ObjectType::kU8), SdoAbort::kNotMappable);
  EXPECT_EQ(write(0x1a00, 2, 0x6064'0020), SdoAbort::kNone);
  EXPECT_EQ(write(0x1a00, 3, 0x606c'0020), SdoAbort::kNone);
  EXPECT_EQ(write(0x1a00, 0, 3, ObjectType::kU8), SdoAbort::kPdoTooLong);
  EXPECT_EQ(write(0x1a00, 0, 2, ObjectType::kU8), SdoAbort::kNone);
  EXPECT_EQ(write(0x1a00, 1, 0), SdoAbort::kDeviceState) << "its count is not 0";
  EXPECT_EQ(write(0x1800, 1, 0x181), SdoAbort::kNone);
  EXPECT_EQ(write(0x1a00, 0, 0, ObjectType::kU8), SdoAbort::kDeviceState) << "it is on";
  EXPECT_EQ(write(0x1600, 1, 0x6041'0010), SdoAbort::kNone);
  EXPECT_EQ(write(0x1600, 0, 1, ObjectType::kU8), SdoAbort::kNotMappable) << "statusword is not written";
}

}  // namespace
}  // namespace edgepose
