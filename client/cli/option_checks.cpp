#include "client/cli/option_checks.h"

#include "evaluation/deadline.h"
#include "files/number_text.h"

namespace edgepose {

CLI::Validator number_between(double low, double high) {
  const std::string range = number_text(low) + " to " + number_text(high);
  const auto check = [=](const std::string& text) -> std::string {
    const auto value = finite_number(text);
    if (value && *value >= low && *value <= high) return "";
    return "expected a number from " + range + ", found '" + printable(text) + "'";
  };
  return {check, "NUMBER in [" + range + "]"};
}

CLI::Option* add_deadline_option(CLI::App& command, std::optional<double>& milliseconds,
                                 const std::string& what) {
  const auto check = [](const std::string& text) -> std::string {
    const auto value = finite_number(text);
    if (value && *value > 0 && *value <= 1e3 * kLongestDeadline) return "";
    return "expected milliseconds above 0, at most " + number_text(1e3 * kLongestDeadline) + ", found '" +
           printable(text) + "'";
  };
  return command
      .add_option(
          "--deadline-ms", milliseconds,
          "Milliseconds for " + what + ", preprocessing included: the best pose by then is the answer")
      ->check(CLI::Validator(check, "MS"));
}

CLI::Option* add_output_option(CLI::App& command, const std::string& names, std::filesystem::path& path,
                               const std::string& description) {
  return command.add_option(names, path, description)
      ->check(
          [](const std::string& text) -> std::string {
            return text.empty() ? "expected the name of what to write, found an empty one" : "";
          },
          "");
}

}  // namespace edgepose
