#include "canopen/sdo_server.h"

#include <algorithm>

#include "canopen/cob_id.h"

namespace edgepose {

std::optional<CanFrame> SdoServer::answer(const CanFrame& frame, int64_t now_ns) {
  if (frame.id != cob_id::kSdoRequest + node_ || frame.size != 8) return std::nullopt;
  const auto bytes = answer_to(frame.data);
  if (!bytes) return std::nullopt;
  return CanFrame{
      .id = static_cast<uint16_t>(cob_id::kSdoAnswer + node_), .size = 8, .data = *bytes, .time_ns = now_ns};
}

std::optional<sdo::Bytes> SdoServer::answer_to(const sdo::Bytes& request) {
  switch (sdo::command_of(request)) {
    case sdo::kAbort:
      transfer_ = Transfer::kNone;
      return std::nullopt;
    case sdo::kUpload:
      return begin_upload(sdo::object_of(request));
    case sdo::kDownload:
      return begin_download(request);
    case sdo::kUploadSegment:
      return next_segment(request);
    case sdo::kDownloadSegment:
      return take_segment(request);
    default:
      id_ = sdo::object_of(request);
      return refuse(SdoAbort::kUnknownCommand);
  }
}

sdo::Bytes SdoServer::refuse(SdoAbort reason) {
  transfer_ = Transfer::kNone;
  return sdo::abort(id_, reason);
}

sdo::Bytes SdoServer::begin_upload(ObjectId id) {
  id_ = id;
  if (const SdoAbort refused = objects_.read(id, data_); refused != SdoAbort::kNone) return refuse(refused);
  transfer_ = Transfer::kNone;
  if (!data_.empty() && data_.size() <= sdo::kMaxExpedited)
    return sdo::expedited(sdo::kUploadAnswer, id, data_);
  transfer_ = Transfer::kUpload;
  at_ = 0;
  toggle_ = false;
  return sdo::segmented(sdo::kUploadAnswer, id, static_cast<uint32_t>(data_.size()));
}

sdo::Bytes SdoServer::next_segment(const sdo::Bytes& request) {
  if (transfer_ != Transfer::kUpload) return refuse(SdoAbort::kUnknownCommand);
  if (((request[0] & sdo::kToggle) != 0) != toggle_) return refuse(SdoAbort::kToggle);
  const auto rest = std::span<const uint8_t>(data_).subspan(at_);
  const size_t size = std::min(rest.size(), sdo::kMaxSegment);
  const bool last = size == rest.size();
  const sdo::Bytes answer = sdo::segment(sdo::kSegmentOfUpload, toggle_, last, rest.first(size));
  at_ += size;
  toggle_ = !toggle_;
  if (last) transfer_ = Transfer::kNone;
  return answer;
}

sdo::Bytes SdoServer::begin_download(const sdo::Bytes& request) {
  id_ = sdo::object_of(request);
  transfer_ = Transfer::kNone;
  if (request[0] & sdo::kExpedited) {
    auto data = sdo::expedited_data(request);
    // Without their number the entry tells how many of the four bytes count.
    const ObjectEntry* entry = objects_.find(id_);
    if (!(request[0] & sdo::kSizeGiven) && entry && bytes_of(entry->type) > 0)
      data = data.first(bytes_of(entry->type));
    if (const SdoAbort refused = objects_.write(id_, data); refused != SdoAbort::kNone)
      return refuse(refused);
    return sdo::plain(sdo::kDownloadTaken, id_);
  }
  announced_ = sdo::announced_size(request);
  if (announced_ > sdo::kMaxTransfer) return refuse(SdoAbort::kOutOfMemory);
  if (!objects_.find(id_)) return refuse(objects_.read(id_, data_));
  transfer_ = Transfer::kDownload;
  data_.clear();
  toggle_ = false;
  return sdo::plain(sdo::kDownloadTaken, id_);
}

sdo::Bytes SdoServer::take_segment(const sdo::Bytes& request) {
  if (transfer_ != Transfer::kDownload) return refuse(SdoAbort::kUnknownCommand);
  if (((request[0] & sdo::kToggle) != 0) != toggle_) return refuse(SdoAbort::kToggle);
  const auto more = sdo::segment_data(request);
  if (data_.size() + more.size() > sdo::kMaxTransfer) return refuse(SdoAbort::kOutOfMemory);
  data_.insert(data_.end(), more.begin(), more.end());
  const bool toggle = toggle_;
  toggle_ = !toggle_;
  if (request[0] & sdo::kLast) {
    if (announced_ != 0 && announced_ != data_.size()) return refuse(SdoAbort::kWrongLength);
    if (const SdoAbort refused = objects_.write(id_, data_); refused != SdoAbort::kNone)
      return refuse(refused);
    transfer_ = Transfer::kNone;
  }
  sdo::Bytes answer{};
  answer[0] = static_cast<uint8_t>(sdo::kSegmentTaken | (toggle ? sdo::kToggle : 0));
  return answer;
}

}  // namespace edgepose
