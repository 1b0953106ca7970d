#include "matcher/pair_table.h"

#include <algorithm>

#include "matcher/parallel.h"

namespace edgepose {
namespace {

constexpr size_t kCountedPoints = 256;

struct Pair {
  uint32_t bucket;
  PairEntry entry;
};

bool share_a_view(const std::vector<uint64_t>& a, const std::vector<uint64_t>& b) {
  for (size_t w = 0; w < a.size(); ++w)
    if (a[w] & b[w]) return true;
  return false;
}

std::vector<Pair> pairs_of(uint32_t reference, const std::vector<OrientedPoint>& points,
                           const FeatureQuantiser& quantiser, const PairFilter& filter) {
  std::vector<Pair> pairs;
  const ReferenceFrame frame(points[reference]);
  const float least = filter.min_normal_angle * quantiser.inverse_angle_step,
              most = filter.max_normal_angle * quantiser.inverse_angle_step;
  for (uint32_t second = 0; second < points.size(); ++second) {
    const float distance = (points[reference].position - points[second].position).norm();
    if (second == reference || distance <= 0 ||
        !share_a_view(filter.seen_from[reference], filter.seen_from[second]))
      continue;
    const PairFeature f = quantiser.feature(points[reference], points[second], distance);
    // The angle itself, not its bucket: buckets are wider than the few degrees that are filtered.
    if (f.angle_normals < least || f.angle_normals > most) continue;
    const uint32_t normals = quantiser.angle_bin(f.angle_normals);
    const uint32_t distance_bin = std::min(static_cast<uint32_t>(f.distance), quantiser.distance_bins - 1);
    pairs.push_back({quantiser.bucket(distance_bin, quantiser.angle_bin(f.angle_reference),
                                      quantiser.angle_bin(f.angle_second), normals),
                     {static_cast<uint16_t>(reference), frame.alpha(points[second].position)}});
  }
  return pairs;
}

}  // namespace

std::pair<uint32_t, uint32_t> normal_bins(const PairFilter& filter, const FeatureQuantiser& quantiser) {
  const auto bin = [&](float angle) { return quantiser.angle_bin(angle * quantiser.inverse_angle_step); };
  return {bin(filter.min_normal_angle), bin(filter.max_normal_angle)};
}

TableSize estimate_table(const std::vector<OrientedPoint>& points, const FeatureQuantiser& quantiser,
                         const PairFilter& filter) {
  const size_t every = std::max<size_t>(1, points.size() / kCountedPoints);
  double pairs = 0, counted = 0;
  for (size_t i = 0; i < points.size(); i += every, ++counted)
    pairs += static_cast<double>(pairs_of(static_cast<uint32_t>(i), points, quantiser, filter).size());
  return {static_cast<double>(quantiser.bucket_count() + 1) * sizeof(uint32_t),
          pairs / std::max(counted, 1.0) * static_cast<double>(points.size()) * sizeof(PairEntry)};
}

PairTable build_pair_table(const std::vector<OrientedPoint>& points, const FeatureQuantiser& quantiser,
                           const PairFilter& filter, int threads) {
  std::vector<std::vector<Pair>> pairs(points.size());
  parallel_for(points.size(), threads,
               [&](size_t i) { pairs[i] = pairs_of(static_cast<uint32_t>(i), points, quantiser, filter); });

  PairTable table;  // counting sort: stable, so the order does not depend on the threads
  table.offsets.assign(quantiser.bucket_count() + 1, 0);
  for (const auto& list : pairs)
    for (const Pair& p : list) ++table.offsets[p.bucket + 1];
  for (size_t b = 1; b < table.offsets.size(); ++b) table.offsets[b] += table.offsets[b - 1];
  table.entries.resize(table.offsets.back());
  std::vector<uint32_t> next(table.offsets.begin(), table.offsets.end() - 1);
  for (const auto& list : pairs)
    for (const Pair& p : list) table.entries[next[p.bucket]++] = p.entry;
  return table;
}

}  // namespace edgepose
