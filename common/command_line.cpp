#include "common/command_line.h"

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "common/nearest_word.h"

namespace edgepose {
namespace {

/// As CLI11 converts: decimal, or octal and hexadecimal with their marks.
bool is_whole_number(const std::string& text, bool negative_too) {
  if (text.empty() || (text[0] == '-' && !negative_too)) return false;
  char* end = nullptr;
  errno = 0;
  if (negative_too)
    std::strtoll(text.c_str(), &end, 0);
  else
    std::strtoull(text.c_str(), &end, 0);
  return errno == 0 && end == text.c_str() + text.size();
}

bool is_finite_number(const std::string& text) {
  char* end = nullptr;
  return std::isfinite(std::strtod(text.c_str(), &end)) && end == text.c_str() + text.size();
}

std::string quoted_find(const std::string& text) {
  constexpr size_t kMost = 80;
  return ", found '" + (text.size() > kMost ? text.substr(0, kMost) + "..." : text) + "'";
}

std::string value_fault(const std::string& type, const std::string& text) {
  if (text.empty()) return "expected a value, found an empty one";
  if (type.starts_with("UINT") && !is_whole_number(text, false))
    return "expected a whole number, not negative" + quoted_find(text);
  if (type.starts_with("INT") && !is_whole_number(text, true))
    return "expected a whole number" + quoted_find(text);
  if (type.starts_with("FLOAT") && !is_finite_number(text))
    return "expected a finite number" + quoted_find(text);
  return "";
}

const CLI::App& innermost_command(const CLI::App& app) {
  const CLI::App* command = &app;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().back();
  return *command;
}

std::string whole_name(const CLI::App& command) {
  const CLI::App* const parent = command.get_parent();
  return parent ? whole_name(*parent) + " " + command.get_name() : command.get_name();
}

std::string unexpected_argument(const CLI::App& app, const CLI::App& command) {
  const std::vector<std::string> unexpected = app.remaining(true);
  if (unexpected.empty()) return "";
  const std::string& first = unexpected.front();
  if (!first.starts_with("-")) return "unexpected argument '" + first + "'";
  const std::string name = first.substr(0, first.find('='));
  std::vector<std::string> known;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& long_name : option->get_lnames()) known.push_back("--" + long_name);
  const std::string near = nearest_word(name, known, 1 + name.size() / 4);
  return "no option is called '" + name + "'" + (near.empty() ? "" : "; did you mean " + near + "?");
}

/// "1000.000000" as "1000".
std::string without_zeros(const std::string& number) {
  if (number.find('.') == std::string::npos) return number;
  const size_t last = number.find_last_not_of('0');
  return number.substr(0, number[last] == '.' ? last : last + 1);
}

/// CLI11's sentences about values, where we have one of our own.
std::string in_our_words(const std::string& text) {
  // NAME: Value FOUND not in range LOW to HIGH
  const std::string value = ": Value ", range = " not in range ", to = " to ";
  const size_t value_at = text.find(value), range_at = text.rfind(range);
  if (value_at != std::string::npos && range_at != std::string::npos && value_at < range_at) {
    const size_t found_at = value_at + value.size(), low_at = range_at + range.size();
    const size_t to_at = text.find(to, low_at);
    if (found_at <= range_at && to_at != std::string::npos)
      return text.substr(0, value_at) + ": expected a number from " +
             without_zeros(text.substr(low_at, to_at - low_at)) + to +
             without_zeros(text.substr(to_at + to.size())) +
             quoted_find(text.substr(found_at, range_at - found_at));
  }
  // NAME: 1 required TYPE missing
  if (const size_t missing = text.rfind(": 1 required ");
      missing != std::string::npos && text.ends_with(" missing"))
    return text.substr(0, missing) + ": expected a value, found none";
  // NAME: FOUND not in {A,B}
  const std::string set = " not in {";
  const size_t colon = text.find(": "), set_at = text.rfind(set);
  if (colon != std::string::npos && set_at != std::string::npos && colon + 2 <= set_at &&
      text.ends_with("}")) {
    std::string names = text.substr(set_at + set.size(), text.size() - set_at - set.size() - 1);
    for (size_t at = 0; (at = names.find(',', at)) != std::string::npos; at += 2) names.replace(at, 1, ", ");
    return text.substr(0, colon) + ": expected one of " + names +
           quoted_find(text.substr(colon + 2, set_at - colon - 2));
  }
  return text;
}

}  // namespace

void check_values(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    if (option->get_items_expected_max() == 0) continue;  // a flag
    const std::string type = option->get_type_name();
    const auto fault = [type](const std::string& text) { return value_fault(type, text); };
    // First, as CLI11's own check of a range takes what is no number for one out of range; but checks of ours
    // say themselves which numbers they want.
    if (type.starts_with("FLOAT"))
      option->check(fault, "");
    else
      option->transform(CLI::Validator([fault](std::string& text) { return fault(text); }, ""));
  }
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) check_values(*command);
}

std::string command_line_fault(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = innermost_command(app);
  std::string fault;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) fault = unexpected_argument(app, command);
  if (fault.empty()) fault = in_our_words(error.what());
  const bool more = !command.get_subcommands([](const CLI::App*) { return true; }).empty();
  return fault + " (" + whole_name(command) + " --help shows the " + (more ? "commands)" : "options)");
}

}  // namespace edgepose
