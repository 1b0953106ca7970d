#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace edgepose {

/// The word of `known` with the fewest letters changed (Levenshtein), `most` or fewer; the first of equals.
/// Empty if none.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known,
                         size_t most = std::numeric_limits<size_t>::max() - 1);

}  // namespace edgepose
