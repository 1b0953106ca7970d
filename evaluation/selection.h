#pragma once
#include <optional>
#include <string>
#include <vector>

#include "files/test_set.h"

namespace edgepose {

/// Which part of a test set is wanted. Scores and false positives are then those of this part.
struct Selection {
  std::vector<std::string> objects;  ///< names or ids; empty = all
  int first_image = 0;               ///< image number, this one included
  std::optional<int> last_image;     ///< this one too; none = no bound
};

/// "a-b", "a-", "-b" or "a" as image numbers. Throws InputError.
void parse_images(const std::string& text, Selection& selection);

/// The part of `set`. Throws InputError if an object is unknown or no image is left.
TestSet select(TestSet set, const Selection& selection);

}  // namespace edgepose
