#pragma once
#include <string>
#include <vector>

namespace edgepose {

/// The word of `known` with the fewest letters changed (Levenshtein); the first of equals. Empty if none.
std::string nearest_word(const std::string& word, const std::vector<std::string>& known);

}  // namespace edgepose
