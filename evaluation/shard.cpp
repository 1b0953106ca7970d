#include "evaluation/shard.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <fstream>

#include "common/error.h"

namespace edgepose {
namespace {

constexpr int kMaxShards = 100000;

/// Of the content; 0 if there is no such file.
uint64_t crc_of_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 1 << 16> bytes;
  uLong sum = 0;
  while (file.read(bytes.data(), bytes.size()), file.gcount() > 0)
    sum = crc32_z(sum, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<size_t>(file.gcount()));
  return sum;
}

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

std::string checksum_of(const TestSet& set) {
  std::vector<uint64_t> facts;
  for (const std::filesystem::path& file : set.descriptions) facts.push_back(crc_of_file(file));
  for (const TestObject& object : set.objects) facts.push_back(crc_of_file(object.mesh));
  for (const TestImage& image : set.images) {
    std::error_code missing;
    facts.push_back(std::filesystem::file_size(image.cloud.empty() ? image.depth : image.cloud, missing));
  }
  std::sort(facts.begin(), facts.end());  // folders list their files in any order
  char text[16];
  std::snprintf(text, sizeof text, "%08lx",
                crc32_z(0, reinterpret_cast<const Bytef*>(facts.data()), facts.size() * sizeof(uint64_t)));
  return text;
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
