#pragma once
#include <optional>
#include <vector>

#include "bus/can_frame.h"
#include "canopen/object_dictionary.h"
#include "canopen/sdo.h"

namespace edgepose {

/// Answers requests for objects, expedited and segmented; one transfer at a time, as each SDO channel has.
class SdoServer {
 public:
  SdoServer(ObjectDictionary& objects, int node) : objects_(objects), node_(node) {}

  /// The answer to a frame with a request (0x600 + node); none to other frames and to aborts.
  std::optional<CanFrame> answer(const CanFrame& frame, int64_t now_ns);
  /// Forgets the transfer under way.
  void reset() { transfer_ = Transfer::kNone; }

 private:
  enum class Transfer : uint8_t { kNone, kUpload, kDownload };

  std::optional<sdo::Bytes> answer_to(const sdo::Bytes& request);
  sdo::Bytes begin_upload(ObjectId id);
  sdo::Bytes begin_download(const sdo::Bytes& request);
  sdo::Bytes next_segment(const sdo::Bytes& request);
  sdo::Bytes take_segment(const sdo::Bytes& request);
  sdo::Bytes refuse(SdoAbort reason);

  ObjectDictionary& objects_;
  const int node_;
  Transfer transfer_ = Transfer::kNone;
  ObjectId id_;
  std::vector<uint8_t> data_;
  size_t at_ = 0;
  uint32_t announced_ = 0;
  bool toggle_ = false;
};

}  // namespace edgepose
