#include "evaluation/shard.h"

#include <charconv>

#include "common/error.h"

namespace edgepose {
namespace {

constexpr int kMaxShards = 100000;

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  const char* const end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  const bool has_slash = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  const auto count = has_slash ? std::from_chars(index.ptr + 1, end, shard.count) : index;
  if (!has_slash || count.ec != std::errc() || count.ptr != end || shard.index < 1 ||
      shard.count < shard.index || shard.count > kMaxShards)
    throw InputError::at("--shard", "I/N, 1 to N of at most " + std::to_string(kMaxShards), "'" + text + "'",
                         "such as 2/8, the second of eight parts");
  return shard;
}

TestSet take_shard(TestSet set, const Shard& shard) {
  std::vector<TestImage> images;
  for (size_t i = static_cast<size_t>(shard.index) - 1; i < set.images.size();
       i += static_cast<size_t>(shard.count))
    images.push_back(std::move(set.images[i]));
  set.images = std::move(images);
  return set;
}

}  // namespace edgepose
