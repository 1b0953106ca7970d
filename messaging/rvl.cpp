#include "messaging/rvl.h"

#include <algorithm>

namespace edgepose {
namespace {

// Eight nibbles make a 32-bit word, little endian, the first nibble in its highest bits. A nibble holds three
// bits of a number, the lowest first, and says in its highest bit whether another follows.
constexpr int kNibbles = 8;

class NibbleWriter {
 public:
  void write(uint32_t value) {
    do {
      const uint32_t low = value & 7;
      value >>= 3;
      put(value ? low | 8 : low);
    } while (value);
  }
  std::vector<std::byte> finish() {
    while (filled_) put(0);
    return std::move(bytes_);
  }

 private:
  void put(uint32_t nibble) {
    word_ = word_ << 4 | nibble;
    if (++filled_ < kNibbles) return;
    for (int i = 0; i < 4; ++i) bytes_.push_back(static_cast<std::byte>(word_ >> (8 * i) & 0xff));
    word_ = 0, filled_ = 0;
  }
  std::vector<std::byte> bytes_;
  uint32_t word_ = 0;
  int filled_ = 0;
};

class NibbleReader {
 public:
  explicit NibbleReader(std::span<const std::byte> bytes) : bytes_(bytes) {}

  /// False at the end, and for numbers of more than 32 bits.
  bool read(uint32_t& value) {
    value = 0;
    for (int shift = 0; shift <= 30; shift += 3) {
      uint32_t nibble = 0;
      if (!take(nibble)) return false;
      value |= (nibble & 7) << shift;
      if (!(nibble & 8)) return true;
    }
    return false;
  }
  /// Nothing but the padding of the last word is left.
  bool at_end() const { return at_ + 4 > bytes_.size() && word_ == 0; }

 private:
  bool take(uint32_t& nibble) {
    if (left_ == 0) {
      if (at_ + 4 > bytes_.size()) return false;
      word_ = 0;
      for (size_t i = 0; i < 4; ++i) word_ |= std::to_integer<uint32_t>(bytes_[at_ + i]) << (8 * i);
      at_ += 4, left_ = kNibbles;
    }
    nibble = word_ >> 28;
    word_ <<= 4;
    --left_;
    return true;
  }
  std::span<const std::byte> bytes_;
  size_t at_ = 0;
  uint32_t word_ = 0;
  int left_ = 0;
};

uint32_t zigzag(int32_t difference) {
  return static_cast<uint32_t>(difference) << 1 ^ static_cast<uint32_t>(difference >> 31);
}

int32_t from_zigzag(uint32_t value) {
  return static_cast<int32_t>(value >> 1) ^ -static_cast<int32_t>(value & 1);
}

}  // namespace

std::vector<std::byte> encode_rvl(std::span<const uint16_t> depth) {
  NibbleWriter out;
  int32_t previous = 0;
  for (size_t i = 0; i < depth.size();) {
    const auto zero = [](uint16_t d) { return d == 0; };
    const auto run_begin = depth.begin() + static_cast<std::ptrdiff_t>(i);
    const auto measured = std::find_if_not(run_begin, depth.end(), zero);
    const auto run_end = std::find_if(measured, depth.end(), zero);
    out.write(static_cast<uint32_t>(measured - run_begin));
    out.write(static_cast<uint32_t>(run_end - measured));
    for (auto d = measured; d != run_end; ++d) {
      out.write(zigzag(*d - previous));
      previous = *d;
    }
    i = static_cast<size_t>(run_end - depth.begin());
  }
  return out.finish();
}

bool decode_rvl(std::span<const std::byte> bytes, std::span<uint16_t> depth) {
  if (bytes.size() % 4 != 0) return false;
  NibbleReader in(bytes);
  int32_t previous = 0;
  for (size_t i = 0; i < depth.size();) {
    uint32_t zeros = 0, measured = 0;
    if (!in.read(zeros) || !in.read(measured)) return false;
    const size_t left = depth.size() - i;
    if (zeros > left || measured > left - zeros || (zeros == 0 && measured == 0)) return false;
    std::fill_n(depth.begin() + static_cast<std::ptrdiff_t>(i), zeros, uint16_t{0});
    i += zeros;
    for (; measured > 0; --measured, ++i) {
      uint32_t difference = 0;
      if (!in.read(difference)) return false;
      const int64_t value = int64_t{previous} + from_zigzag(difference);
      if (value < 1 || value > 0xffff) return false;
      previous = static_cast<int32_t>(value);
      depth[i] = static_cast<uint16_t>(value);
    }
  }
  return in.at_end();
}

}  // namespace edgepose
