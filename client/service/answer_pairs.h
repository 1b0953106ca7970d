#pragma once
#include <utility>
#include <vector>

#include "client/service/answer_log.h"

namespace edgepose {

/// Whether both say the same of the same models: every double of every accepted pose.
bool same_bits(const LoggedPose& a, const LoggedPose& b);
bool same_bits(const LoggedAnswer& a, const LoggedAnswer& b);

/// Which answers of two logs are of the same frame.
struct AnswerPairs {
  std::vector<std::pair<const LoggedAnswer*, const LoggedAnswer*>> both;
  size_t only_a = 0, only_b = 0;
};

/// Pairs them by sequence number, but for a constant offset: that which pairs most answers, of equals that
/// with the most answers of the same bits. By order where numbers do not rise. The result points into
/// `a` and `b`.
AnswerPairs pair_answers(const std::vector<LoggedAnswer>& a, const std::vector<LoggedAnswer>& b);

}  // namespace edgepose
