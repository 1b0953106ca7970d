#pragma once
#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/error.h"

namespace edgepose {

/// A value in a JSON file that knows where it stands, so that every complaint can say so. All readers throw
/// InputError. Internal to this folder: nlohmann's types go no further.
class JsonNode {
 public:
  JsonNode(const nlohmann::json& value, std::string where) : value_(&value), where_(std::move(where)) {}

  const std::string& where() const { return where_; }

  JsonNode at(const std::string& key) const;                   ///< a member that must be there
  std::optional<JsonNode> find(const std::string& key) const;  ///< ... that may be there
  std::vector<std::string> keys() const;                       ///< of an object, sorted
  std::vector<JsonNode> items() const;                         ///< of an array

  double number() const;    ///< finite
  double positive() const;  ///< finite, at least 1e-6: whatever the unit, less is a mistake
  int integer() const;
  bool boolean() const;
  std::string text() const;
  std::vector<double> numbers(size_t count) const;  ///< an array of exactly `count` finite numbers

  Eigen::Vector3d vector() const;     ///< an array of 3
  Eigen::Vector3d direction() const;  ///< ... scaled to length 1

  [[noreturn]] void fail(const std::string& expected, const std::string& advice = "") const;

 private:
  std::string found() const;  ///< the value in a few words

  const nlohmann::json* value_;
  std::string where_;
};

/// Largest JSON file read: the tree in memory takes up to ten times as much.
inline constexpr size_t kMaxJsonBytes = 64u << 20;

/// Throws InputError led by `name` if `text` is no JSON.
nlohmann::json parse_json(std::string_view text, const std::string& name);

}  // namespace edgepose
