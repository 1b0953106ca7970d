#include "client/service/answer_pairs.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <iterator>
#include <optional>
#include <set>

namespace edgepose {
namespace {

using Answers = std::vector<LoggedAnswer>;

constexpr size_t kMostOffsets = 50;  // answers that may be missing at one log's beginning

/// Numbers from the first one's on; nothing if they do not rise, or not within 63 bits.
std::optional<std::vector<int64_t>> counted(const Answers& answers) {
  std::vector<int64_t> numbers;
  for (const LoggedAnswer& answer : answers) {
    int64_t number = 0;
    if (__builtin_sub_overflow(answer.sequence, answers.front().sequence, &number)) return std::nullopt;
    if (number < 0 || (!numbers.empty() && number <= numbers.back())) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

AnswerPairs pair_at(const Answers& a, const Answers& b, const std::vector<int64_t>& numbers_a,
                    const std::vector<int64_t>& numbers_b, int64_t offset) {
  AnswerPairs pairs;
  size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    const int64_t apart = numbers_b[j] - numbers_a[i];
    if (apart == offset)
      pairs.both.emplace_back(&a[i++], &b[j++]);
    else if (apart < offset)
      ++j;
    else
      ++i;
  }
  pairs.only_a = a.size() - pairs.both.size();
  pairs.only_b = b.size() - pairs.both.size();
  return pairs;
}

AnswerPairs pair_by_order(const Answers& a, const Answers& b) {
  AnswerPairs pairs;
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i) pairs.both.emplace_back(&a[i], &b[i]);
  pairs.only_a = a.size() - pairs.both.size();
  pairs.only_b = b.size() - pairs.both.size();
  return pairs;
}

size_t same_count(const AnswerPairs& pairs) {
  return static_cast<size_t>(std::count_if(pairs.both.begin(), pairs.both.end(), [](const auto& pair) {
    return same_bits(*pair.first, *pair.second);
  }));
}

}  // namespace

bool same_bits(const LoggedPose& a, const LoggedPose& b) {
  // Not ==, to which 0 and -0 are the same.
  const auto same = [](double x, double y) {
    return std::bit_cast<uint64_t>(x) == std::bit_cast<uint64_t>(y);
  };
  return std::equal(std::begin(a.sent.quaternion), std::end(a.sent.quaternion), b.sent.quaternion, same) &&
         std::equal(std::begin(a.sent.translation), std::end(a.sent.translation), b.sent.translation, same);
}

bool same_bits(const LoggedAnswer& a, const LoggedAnswer& b) {
  return std::equal(
      a.models.begin(), a.models.end(), b.models.begin(), b.models.end(),
      [](const auto& of_a, const auto& of_b) {
        return of_a.first == of_b.first &&
               std::equal(of_a.second.begin(), of_a.second.end(), of_b.second.begin(), of_b.second.end(),
                          [](const LoggedPose& p, const LoggedPose& q) { return same_bits(p, q); });
      });
}

AnswerPairs pair_answers(const Answers& a, const Answers& b) {
  const auto numbers_a = counted(a), numbers_b = counted(b);
  if (!numbers_a || !numbers_b) return pair_by_order(a, b);
  // The nearest first: of equals the first stays.
  std::set<int64_t> tried;
  std::vector<int64_t> offsets;
  for (size_t i = 0; i < kMostOffsets; ++i) {
    if (i < b.size() && tried.insert((*numbers_b)[i]).second) offsets.push_back((*numbers_b)[i]);
    if (i < a.size() && tried.insert(-(*numbers_a)[i]).second) offsets.push_back(-(*numbers_a)[i]);
  }
  AnswerPairs best = pair_by_order(a, {});
  size_t best_same = 0;
  for (const int64_t offset : offsets) {
    AnswerPairs pairs = pair_at(a, b, *numbers_a, *numbers_b, offset);
    if (pairs.both.size() < best.both.size()) continue;
    const size_t same = same_count(pairs);
    if (pairs.both.size() == best.both.size() && same <= best_same) continue;
    best = std::move(pairs), best_same = same;
  }
  if (best.both.empty()) best.only_a = a.size(), best.only_b = b.size();
  return best;
}

}  // namespace edgepose
