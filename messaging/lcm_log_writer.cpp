#include "messaging/lcm_log_writer.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <utility>

#include "common/error.h"
#include "common/output_target.h"
#include "messaging/big_endian.h"
#include "messaging/lcm_log_format.h"

namespace edgepose {
namespace {

namespace format = lcm_log_format;

constexpr size_t kBufferBytes = size_t{1} << 20;

void append(std::vector<std::byte>& to, std::span<const std::byte> more) {
  to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

LcmLogWriter::LcmLogWriter(const std::filesystem::path& path, Existing existing) : path_(path) {
  const std::filesystem::path target = output_target(path);
  // Its length is cut only once it is known that it can be opened; O_EXCL takes no link to nowhere.
  const int how = existing == Existing::kRefuse ? O_EXCL : O_TRUNC;
  descriptor_ = open(target.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | how, 0644);
  if (descriptor_ >= 0) return;
  if (errno == EEXIST)
    throw InputError::at(path.string(), "a new log", "a file of this name", "--force replaces it");
  throw InputError::at(path.string(), "a log that can be written", std::strerror(errno));
}

LcmLogWriter::~LcmLogWriter() {
  if (descriptor_ < 0) return;
  try {
    flush();
  } catch (const InputError&) {
    return;  // closed, cut to its last whole record
  }
  ::close(descriptor_);
}

void LcmLogWriter::write(int64_t receive_utime, std::string_view channel, std::span<const std::byte> data) {
  if (channel.empty() || channel.size() > size_t{format::kMaxChannel})
    throw std::invalid_argument("channel's length");
  if (data.size() > size_t{format::kMaxData}) throw std::invalid_argument("message's length");
  std::array<std::byte, format::kHeader> header;
  write_big_endian(format::kSync, header, 0);
  write_big_endian(static_cast<int64_t>(next_event_++), header, 4);
  write_big_endian(receive_utime, header, 12);
  write_big_endian(static_cast<int32_t>(channel.size()), header, 20);
  write_big_endian(static_cast<int32_t>(data.size()), header, 24);
  append(buffer_, header);
  append(buffer_, std::as_bytes(std::span(channel)));
  append(buffer_, data);
  ends_.push_back(buffer_.size());
  if (buffer_.size() >= kBufferBytes) flush();
}

void LcmLogWriter::flush() {
  size_t written = 0;
  while (written < buffer_.size()) {
    const ssize_t some = ::write(descriptor_, buffer_.data() + written, buffer_.size() - written);
    if (some < 0 && errno == EINTR) continue;
    if (some <= 0) fail(written, some < 0 ? errno : ENOSPC);
    written += static_cast<size_t>(some);
  }
  kept_bytes_ += buffer_.size();
  kept_records_ += ends_.size();
  buffer_.clear();
  ends_.clear();
}

void LcmLogWriter::close() {
  flush();
  if (fsync(descriptor_) != 0 && errno != EINVAL) fail(0, errno);
  if (::close(std::exchange(descriptor_, -1)) != 0)
    throw InputError::at(path_.string(), "a log that can be written", std::strerror(errno));
}

void LcmLogWriter::fail(size_t written, int cause) {
  const auto whole = std::upper_bound(ends_.begin(), ends_.end(), written);
  kept_records_ += static_cast<uint64_t>(whole - ends_.begin());
  kept_bytes_ += whole == ends_.begin() ? 0 : *(whole - 1);
  buffer_.clear();
  ends_.clear();
  const bool cut = ftruncate(descriptor_, static_cast<off_t>(kept_bytes_)) == 0;
  ::close(std::exchange(descriptor_, -1));
  throw InputError::at(path_.string(), "room for the log", std::strerror(cause),
                       std::to_string(kept_records_) + " messages (" + std::to_string(kept_bytes_) +
                           " bytes) were kept" + (cut ? "" : ", and part of another"));
}

}  // namespace edgepose
