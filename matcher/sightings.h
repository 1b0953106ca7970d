#pragma once
#include <cstddef>

namespace edgepose {

/// How many rounds of 75 references would lead to a candidate that `sightings` of the first `looked` batches
/// of `batch` references have led to, had the search gone through all `references` (600 to 900). That is
/// what acceptance_score() was fitted to; a search that ends early must not make a pose look less likely for
/// it. At least 1.
int expected_rounds(int sightings, size_t looked, int batch, size_t references);

}  // namespace edgepose
