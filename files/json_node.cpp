#include "files/json_node.h"

#include <cmath>
#include <limits>

#include "files/number_text.h"
#include "files/text_cursor.h"

namespace edgepose {

JsonNode JsonNode::at(const std::string& key) const {
  const auto member = find(key);
  if (!member) throw InputError::at(where_, "a member \"" + key + "\"", "none");
  return *member;
}

std::optional<JsonNode> JsonNode::find(const std::string& key) const {
  if (!value_->is_object()) fail("an object {...}");
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return JsonNode(*member, where_ + ": " + key);
}

std::vector<std::string> JsonNode::keys() const {
  if (!value_->is_object()) fail("an object {...}");
  std::vector<std::string> names;
  for (const auto& member : value_->items()) names.push_back(member.key());
  return names;
}

std::vector<JsonNode> JsonNode::items() const {
  if (!value_->is_array()) fail("an array [...]");
  std::vector<JsonNode> nodes;
  nodes.reserve(value_->size());
  for (size_t i = 0; i < value_->size(); ++i)
    nodes.emplace_back((*value_)[i], where_ + "[" + std::to_string(i) + "]");
  return nodes;
}

double JsonNode::number() const {
  if (!value_->is_number() || !std::isfinite(value_->get<double>())) fail("a finite number");
  return value_->get<double>();
}

double JsonNode::positive() const {
  const double value = number();
  if (!(value >= 1e-6)) fail("a number above 0");
  return value;
}

int JsonNode::integer() const {
  const double value = number();
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) fail("an integer");
  return static_cast<int>(value);
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) fail("true or false");
  return value_->get<bool>();
}

std::string JsonNode::text() const {
  if (!value_->is_string()) fail("a text in quotes");
  return value_->get<std::string>();
}

std::vector<double> JsonNode::numbers(size_t count) const {
  if (!value_->is_array() || value_->size() != count)
    fail("an array of " + std::to_string(count) + " numbers");
  std::vector<double> values;
  for (const JsonNode& item : items()) values.push_back(item.number());
  return values;
}

Eigen::Vector3d JsonNode::vector() const { return Eigen::Vector3d(numbers(3).data()); }

Eigen::Vector3d JsonNode::direction() const {
  const Eigen::Vector3d along = vector();
  const double length = along.stableNorm();
  if (!(length >= 1e-6 && length <= 1e6))
    throw InputError::at(where_, "a direction (a vector of length 1)",
                         "a vector of length " + number_text(length, 6));
  return along / length;
}

void JsonNode::fail(const std::string& expected, const std::string& advice) const {
  throw InputError::at(where_, expected, found(), advice);
}

std::string JsonNode::found() const {
  if (value_->is_number()) return number_text(value_->get<double>());
  if (value_->is_string()) return "the text " + edgepose::quoted(value_->get_ref<const std::string&>());
  if (value_->is_array()) return "an array of " + std::to_string(value_->size());
  if (value_->is_object()) return "an object with " + std::to_string(value_->size()) + " members";
  return value_->is_null() ? "null" : value_->get<bool>() ? "true" : "false";
}

nlohmann::json parse_json(std::string_view text, const std::string& name) {
  try {
    return nlohmann::json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error ... - last read: '...'"
    std::string_view message = error.what();
    if (const size_t end = message.find("] "); end != std::string_view::npos) message.remove_prefix(end + 2);
    throw InputError::at(name, "JSON", printable(message),
                         "the file is cut short or damaged, or is not JSON");
  }
}

}  // namespace edgepose
