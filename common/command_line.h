#pragma once
#include <CLI/CLI.hpp>
#include <map>
#include <string>

namespace edgepose {

/// Refuses what nobody means to say, of every option and argument of `app` and its commands: an empty value
/// (of a script's variable that is not set), a whole number that is none, or negative where it cannot be, a
/// number that is not finite. To be called when all options are there.
void check_values(CLI::App& app);

/// What CLI11 found wrong, as InputError would say it, and whose --help shows more.
std::string command_line_fault(const CLI::App& app, const CLI::ParseError& error);

/// `option` takes one of these names, in small or capital letters.
template <class Value>
CLI::Option* choose(CLI::Option* option, const std::map<std::string, Value>& values) {
  std::string names;
  for (const auto& [name, value] : values) names += (names.empty() ? "" : "|") + name;
  const auto translate = [values, names](std::string& text) -> std::string {
    const auto chosen = values.find(CLI::detail::to_lower(text));
    if (chosen == values.end()) return "expected " + names + ", found '" + text + "'";
    text = std::to_string(static_cast<int>(chosen->second));
    return "";
  };
  return option->transform(CLI::Validator(translate, ""))->type_name(names);
}

}  // namespace edgepose
