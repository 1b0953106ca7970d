#include "messaging/lcm_log.h"

#include <array>
#include <cerrno>
#include <cstring>

#include "common/error.h"
#include "messaging/big_endian.h"
#include "messaging/lcm_log_format.h"

namespace edgepose {
namespace {

namespace format = lcm_log_format;

constexpr size_t kBlock = 1 << 16;

}  // namespace

LcmLogReader::LcmLogReader(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure))
    throw InputError::at(path.string(), "an LCM log", failure ? failure.message() : "no regular file");
  size_ = std::filesystem::file_size(path, failure);
  file_.open(path, std::ios::binary);
  if (!file_) throw InputError::at(path.string(), "an LCM log that can be read", std::strerror(errno));
  if (!find_sync()) throw InputError::at(path.string(), "an LCM log", "no record in it");
}

/// Moves to the next sync word; false if there is none.
bool LcmLogReader::find_sync() {
  const uint64_t from = at_;
  std::vector<std::byte> block(kBlock);
  while (at_ + format::kHeader <= size_) {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(at_));
    file_.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
    const auto got = static_cast<size_t>(file_.gcount());
    if (got < sizeof(format::kSync)) break;
    for (size_t i = 0; i + sizeof(format::kSync) <= got; ++i)
      if (read_big_endian<uint32_t>(block, i) == format::kSync) {
        at_ += i;
        skipped_ += at_ - from;
        return true;
      }
    at_ += got - (sizeof(format::kSync) - 1);
  }
  at_ = size_;
  skipped_ += at_ - from;
  return false;
}

bool LcmLogReader::next(LoggedMessage& message) {
  std::array<std::byte, format::kHeader> header;
  while (at_ + format::kHeader <= size_) {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(at_));
    if (!file_.read(reinterpret_cast<char*>(header.data()), format::kHeader)) break;
    if (read_big_endian<uint32_t>(header, 0) != format::kSync) {
      if (!find_sync()) break;
      continue;
    }
    const auto channel = read_big_endian<int32_t>(header, 20), data = read_big_endian<int32_t>(header, 24);
    if (channel < 1 || channel > format::kMaxChannel || data < 0 || data > format::kMaxData) {
      at_ += sizeof(format::kSync), skipped_ += sizeof(format::kSync);
      continue;
    }
    const uint64_t end = at_ + format::kHeader + static_cast<uint64_t>(channel) + static_cast<uint64_t>(data);
    if (end > size_) {
      // Cut off, unless the lengths are wrong and whole records follow.
      cut_off_ = true;
      at_ += sizeof(format::kSync), skipped_ += sizeof(format::kSync);
      continue;
    }
    cut_off_ = false;
    message.event = read_big_endian<int64_t>(header, 4);
    message.receive_utime = read_big_endian<int64_t>(header, 12);
    message.channel.resize(static_cast<size_t>(channel));
    message.data.resize(static_cast<size_t>(data));
    if (!file_.read(message.channel.data(), channel) ||
        !file_.read(reinterpret_cast<char*>(message.data.data()), data))
      break;
    at_ = end;
    return true;
  }
  cut_off_ = cut_off_ || at_ < size_;
  return false;
}

}  // namespace edgepose
