#include "bus/pcap_reader.h"

#include <array>
#include <cerrno>
#include <cstring>

#include "bus/frame_record.h"
#include "bus/pcap_format.h"
#include "common/error.h"

namespace edgepose {
namespace {

namespace format = pcap_format;

size_t read_some(std::ifstream& file, uint8_t* to, size_t size) {
  file.read(reinterpret_cast<char*>(to), static_cast<std::streamsize>(size));
  return static_cast<size_t>(file.gcount());
}

}  // namespace

PcapReader::PcapReader(const std::filesystem::path& path) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure))
    throw InputError::at(path.string(), "a capture", failure ? failure.message() : "no regular file");
  file_.open(path, std::ios::binary);
  if (!file_) throw InputError::at(path.string(), "a capture that can be read", std::strerror(errno));
  std::array<uint8_t, format::kHeader> header;
  if (read_some(file_, header.data(), header.size()) != header.size())
    throw InputError::at(path.string(), "a pcap capture", "less than its header of 24 bytes");
  const auto is = [&](uint32_t magic) { return number(header.data()) == magic; };
  swapped_ = !is(format::kMagicMicroseconds) && !is(format::kMagicNanoseconds);
  if (!is(format::kMagicMicroseconds) && !is(format::kMagicNanoseconds))
    throw InputError::at(path.string(), "a pcap capture", "another kind of file",
                         "editcap -F pcap makes one from pcapng");
  if (is(format::kMagicNanoseconds)) fraction_ns_ = 1;
  const uint32_t link_type = number(header.data() + 20) & 0x0fff'ffff;  // above: length of a checksum
  if (link_type != format::kLinkTypeCanSocketCan)
    throw InputError::at(path.string(), "a capture of SocketCAN (link type 227)",
                         "link type " + std::to_string(link_type));
}

uint32_t PcapReader::number(const uint8_t* at) const {
  uint32_t value = 0;
  std::memcpy(&value, at, sizeof(value));
  return swapped_ ? __builtin_bswap32(value) : value;
}

Received PcapReader::next() {
  std::array<uint8_t, format::kRecordHeader> header;
  std::array<uint8_t, format::kMaxRecord> bytes;
  while (!cut_off_) {
    const size_t got = read_some(file_, header.data(), header.size());
    if (got == 0) return {};
    const uint32_t kept = number(header.data() + 8);
    cut_off_ =
        got < header.size() || kept > format::kMaxRecord || read_some(file_, bytes.data(), kept) < kept;
    if (cut_off_) return {};
    Received read = from_record(std::span(bytes).first(kept));
    if (read.kind == Received::Kind::kNothing) {
      ++skipped_;
      continue;
    }
    read.frame.time_ns = int64_t{number(header.data())} * 1'000'000'000 +
                         int64_t{number(header.data() + 4)} * int64_t{fraction_ns_};
    return read;
  }
  return {};
}

}  // namespace edgepose
