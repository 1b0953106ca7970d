#include "canopen/sdo_client.h"

#include <algorithm>

#include "canopen/cob_id.h"

namespace edgepose {

SdoClient::SdoClient(CanBus& bus, int node) : bus_(bus), node_(node) { data_.reserve(sdo::kMaxTransfer); }

void SdoClient::upload(ObjectId id, int64_t now_ns, int64_t timeout_ns) {
  begin(id, now_ns, timeout_ns, true);
  send(sdo::plain(sdo::kUpload, id), now_ns);
}

void SdoClient::download(ObjectId id, std::span<const uint8_t> data, int64_t now_ns, int64_t timeout_ns) {
  begin(id, now_ns, timeout_ns, false);
  if (data.size() > sdo::kMaxTransfer) return fail(SdoAbort::kOutOfMemory, now_ns);
  data_.assign(data.begin(), data.end());
  segments_ = data.empty() || data.size() > sdo::kMaxExpedited;
  send(segments_ ? sdo::segmented(sdo::kDownload, id, static_cast<uint32_t>(data.size()))
                 : sdo::expedited(sdo::kDownload, id, data),
       now_ns);
}

void SdoClient::begin(ObjectId id, int64_t now_ns, int64_t timeout_ns, bool upload) {
  state_ = State::kBusy;
  id_ = id;
  upload_ = upload;
  segments_ = toggle_ = by_node_ = false;
  reason_ = SdoAbort::kNone;
  data_.clear();
  at_ = announced_ = 0;
  deadline_ns_ = now_ns + timeout_ns;
}

void SdoClient::send(const sdo::Bytes& bytes, int64_t now_ns) {
  request_ = {
      .id = static_cast<uint16_t>(cob_id::kSdoRequest + node_), .size = 8, .data = bytes, .time_ns = now_ns};
  unsent_ = bus_.send(request_) != SendResult::kSent;
}

void SdoClient::fail(SdoAbort reason, int64_t now_ns) {
  state_ = State::kAborted;
  reason_ = reason;
  send(sdo::abort(id_, reason), now_ns);
  unsent_ = false;
}

void SdoClient::tick(int64_t now_ns) {
  if (state_ != State::kBusy) return;
  if (now_ns >= deadline_ns_) {
    fail(SdoAbort::kTimeout, now_ns);
    state_ = State::kTimedOut;
  } else if (unsent_) {
    send(request_.data, now_ns);
  }
}

void SdoClient::take(const CanFrame& frame, int64_t now_ns) {
  if (frame.id != cob_id::kSdoAnswer + node_ || frame.size != 8) return;
  if (state_ != State::kBusy) {
    ++unasked_;
    return;
  }
  const sdo::Bytes& bytes = frame.data;
  if (sdo::command_of(bytes) == sdo::kAbort) {
    if (sdo::object_of(bytes) != id_) return;  // of a transfer that was given up
    state_ = State::kAborted;
    reason_ = sdo::reason_of(bytes);
    by_node_ = true;
  } else if (upload_) {
    take_upload(bytes, now_ns);
  } else {
    take_download(bytes, now_ns);
  }
}

void SdoClient::take_upload(const sdo::Bytes& bytes, int64_t now_ns) {
  if (!segments_) {
    if (sdo::command_of(bytes) != sdo::kUploadAnswer) return fail(SdoAbort::kUnknownCommand, now_ns);
    if (sdo::object_of(bytes) != id_) return void(++unasked_);  // late, from before
    if (bytes[0] & sdo::kExpedited) {
      const auto got = sdo::expedited_data(bytes);
      data_.assign(got.begin(), got.end());
      state_ = State::kDone;
      return;
    }
    announced_ = sdo::announced_size(bytes);
    if (announced_ > sdo::kMaxTransfer) return fail(SdoAbort::kOutOfMemory, now_ns);
    segments_ = true;
    return send(sdo::plain(sdo::kUploadSegment, {}), now_ns);
  }
  if (sdo::command_of(bytes) != sdo::kSegmentOfUpload) return fail(SdoAbort::kUnknownCommand, now_ns);
  if (((bytes[0] & sdo::kToggle) != 0) != toggle_) return fail(SdoAbort::kToggle, now_ns);
  const auto more = sdo::segment_data(bytes);
  if (data_.size() + more.size() > sdo::kMaxTransfer) return fail(SdoAbort::kOutOfMemory, now_ns);
  data_.insert(data_.end(), more.begin(), more.end());
  if (bytes[0] & sdo::kLast) {
    if (announced_ != 0 && announced_ != data_.size()) return fail(SdoAbort::kWrongLength, now_ns);
    state_ = State::kDone;
    return;
  }
  toggle_ = !toggle_;
  send(sdo::plain(sdo::kUploadSegment | (toggle_ ? sdo::kToggle : 0), {}), now_ns);
}

void SdoClient::take_download(const sdo::Bytes& bytes, int64_t now_ns) {
  const bool first = at_ == 0 && sdo::command_of(bytes) == sdo::kDownloadTaken;
  if (first) {
    if (sdo::object_of(bytes) != id_) return void(++unasked_);
    if (!segments_) {
      state_ = State::kDone;
      return;
    }
    return send_segment(now_ns);
  }
  if (!segments_ || sdo::command_of(bytes) != sdo::kSegmentTaken)
    return fail(SdoAbort::kUnknownCommand, now_ns);
  // toggle_ is already the next segment's.
  if (((bytes[0] & sdo::kToggle) != 0) == toggle_) return fail(SdoAbort::kToggle, now_ns);
  if (at_ >= data_.size())
    state_ = State::kDone;
  else
    send_segment(now_ns);
}

void SdoClient::send_segment(int64_t now_ns) {
  const auto rest = std::span<const uint8_t>(data_).subspan(at_);
  const size_t size = std::min(rest.size(), sdo::kMaxSegment);
  send(sdo::segment(sdo::kDownloadSegment, toggle_, size == rest.size(), rest.first(size)), now_ns);
  at_ += size;
  toggle_ = !toggle_;
}

}  // namespace edgepose
