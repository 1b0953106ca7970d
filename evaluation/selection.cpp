#include "evaluation/selection.h"

#include <algorithm>
#include <charconv>
#include <set>

#include "common/error.h"

namespace edgepose {
namespace {

std::optional<int> image_number(const std::string& text) {
  int value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  if (failure != std::errc() || stop != end || value < 0) return std::nullopt;
  return value;
}

bool is_called(const TestObject& object, const std::string& name) {
  return object.name == name || std::to_string(object.id) == name;
}

}  // namespace

void parse_images(const std::string& text, Selection& selection) {
  const size_t dash = text.find('-');
  const std::string first = text.substr(0, dash),
                    last = dash == std::string::npos ? first : text.substr(dash + 1);
  const std::optional<int> a = first.empty() ? 0 : image_number(first);
  const std::optional<int> b = image_number(last);
  if (!a || (!b && !last.empty()) || (first.empty() && last.empty()) || (b && *b < *a))
    throw InputError::at("--images", "image numbers as 3, 3-7, 3- or -7", "'" + text.substr(0, 40) + "'");
  selection.first_image = *a;
  selection.last_image = b;
}

TestSet select(TestSet set, const Selection& selection) {
  std::set<int> wanted;
  std::string known;
  for (const TestObject& object : set.objects) known += (known.empty() ? "" : ", ") + object.name;
  for (const std::string& name : selection.objects) {
    bool hit = false;
    for (const TestObject& object : set.objects) {
      if (!is_called(object, name)) continue;
      wanted.insert(object.id);
      hit = true;
    }
    if (!hit) throw InputError::at(set.name, "object '" + name.substr(0, 40) + "'", "only " + known);
  }
  if (!selection.objects.empty()) {
    std::erase_if(set.objects, [&](const TestObject& object) { return !wanted.count(object.id); });
    for (TestImage& image : set.images)
      std::erase_if(image.truth, [&](const GroundTruth& truth) { return !wanted.count(truth.object_id); });
  }
  std::erase_if(set.images, [&](const TestImage& image) {
    return image.image_id < selection.first_image ||
           (selection.last_image && image.image_id > *selection.last_image);
  });
  if (set.images.empty())
    throw InputError::at(set.name,
                         "images from " + std::to_string(selection.first_image) +
                             (selection.last_image ? " to " + std::to_string(*selection.last_image) : ""),
                         "none");
  return set;
}

}  // namespace edgepose
