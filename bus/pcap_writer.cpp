#include "bus/pcap_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstring>

#include "bus/frame_record.h"
#include "bus/pcap_format.h"
#include "common/error.h"
#include "common/output_target.h"

namespace edgepose {
namespace {

namespace format = pcap_format;

constexpr size_t kFlushAt = size_t{64} << 10;
constexpr size_t kRecordBytes = format::kRecordHeader + kFrameRecordBytes;

/// In this machine's byte order: readers look at the magic number.
template <class Integer>
void append_native(std::vector<uint8_t>& to, Integer value) {
  const auto bytes = std::bit_cast<std::array<uint8_t, sizeof(Integer)>>(value);
  to.insert(to.end(), bytes.begin(), bytes.end());
}

/// As many of the bytes as there is room for.
size_t write_all(int descriptor, const uint8_t* bytes, size_t size) {
  size_t done = 0;
  while (done < size) {
    const ssize_t some = ::write(descriptor, bytes + done, size - done);
    if (some < 0 && errno == EINTR) continue;
    if (some <= 0) break;
    done += static_cast<size_t>(some);
  }
  return done;
}

}  // namespace

PcapWriter::PcapWriter(const std::filesystem::path& path, int64_t wall_minus_steady_ns)
    : wall_minus_steady_ns_(wall_minus_steady_ns) {
  const std::filesystem::path target = output_target(path);
  descriptor_ = open(target.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  buffer_.reserve(kFlushAt + kRecordBytes);
  append_native(buffer_, format::kMagicMicroseconds);
  append_native(buffer_, format::kMajor);
  append_native(buffer_, format::kMinor);
  append_native(buffer_, uint64_t{0});  // zone and accuracy
  append_native(buffer_, uint32_t{kFrameRecordBytes});
  append_native(buffer_, format::kLinkTypeCanSocketCan);
  if (descriptor_ < 0 || write_all(descriptor_, buffer_.data(), buffer_.size()) != format::kHeader) {
    const int cause = errno;
    if (descriptor_ >= 0) close(descriptor_);
    throw InputError::at(path.string(), "a capture that can be written", std::strerror(cause));
  }
  buffer_.clear();
  file_bytes_ = format::kHeader;
}

PcapWriter::~PcapWriter() {
  flush();
  close(descriptor_);
}

void PcapWriter::write(const CanFrame& frame) {
  const int64_t us = std::max<int64_t>(0, (frame.time_ns + wall_minus_steady_ns_) / 1000);
  append_native(buffer_, static_cast<uint32_t>(us / 1'000'000));
  append_native(buffer_, static_cast<uint32_t>(us % 1'000'000));
  append_native(buffer_, uint32_t{kFrameRecordBytes});
  append_native(buffer_, uint32_t{kFrameRecordBytes});
  const FrameRecord record = to_record(frame);
  buffer_.insert(buffer_.end(), record.begin(), record.end());
  if (buffer_.size() >= kFlushAt) flush();
}

void PcapWriter::flush() {
  if (buffer_.empty()) return;
  const size_t whole = write_all(descriptor_, buffer_.data(), buffer_.size()) / kRecordBytes;
  const size_t missing = buffer_.size() / kRecordBytes - whole;
  file_bytes_ += whole * kRecordBytes;
  written_ += whole;
  if (missing > 0) {
    last_error_ = errno;
    lost_ += missing;
    // Back to the last whole record: shortening a file needs no room.
    if (ftruncate(descriptor_, static_cast<off_t>(file_bytes_)) != 0 ||
        lseek(descriptor_, static_cast<off_t>(file_bytes_), SEEK_SET) < 0)
      last_error_ = errno;
  }
  buffer_.clear();
}

}  // namespace edgepose
