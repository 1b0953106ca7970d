#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include "common/error.h"
#include "experiment/experiment.h"

namespace edgepose {
namespace {

constexpr const char* kTrialHeading =
    "arm;seed;steps;along_m;across_m;translation_m;angle_rad;end;distances_m;angles_rad\n";

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

std::string joined(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + number(value);
  return text;
}

std::vector<double> numbers(const std::string& text) {
  std::istringstream stream(text);
  return {std::istream_iterator<double>(stream), std::istream_iterator<double>()};
}

/// Empty if it is no whole line.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line)
    if (c == ';')
      fields.emplace_back();
    else
      fields.back() += c;
  if (fields.size() != 10) fields.clear();
  return fields;
}

}  // namespace

std::string trial_heading(const std::string& made_with) {
  return "# " + one_line(made_with) + "\n" + kTrialHeading;
}

std::string trial_line(const ExperimentArm& arm, const TrialResult& r) {
  std::string end = one_line(r.end);
  std::replace(end.begin(), end.end(), ';', ',');
  return arm.name + ";" + std::to_string(r.seed) + ";" + std::to_string(r.steps) + ";" +
         number(r.error.along) + ";" + number(r.error.across) + ";" + number(r.error.translation) + ";" +
         number(r.error.angle) + ";" + end + ";" + joined(r.distances) + ";" + joined(r.angles) + "\n";
}

std::vector<ArmResults> read_trials(const std::filesystem::path& path, const std::string& made_with,
                                    const std::vector<ExperimentArm>& arms) {
  std::vector<ArmResults> results;
  for (const ExperimentArm& arm : arms) results.push_back({arm, {}});
  std::ifstream file(path);
  if (!file) return results;
  std::string made, line;
  if (!std::getline(file, made) || !made.starts_with("# ") || !std::getline(file, line) ||
      line + "\n" != kTrialHeading)
    throw InputError::at(path.string(), "trials of an earlier run", "another file",
                         "name another folder, or remove it");
  if (made != "# " + one_line(made_with))
    throw InputError::at(path.string(), "trials made with " + one_line(made_with), made.substr(2),
                         "name another folder, or remove it");
  while (std::getline(file, line) && !file.eof()) {
    const std::vector<std::string> fields = fields_of(line);
    if (fields.empty()) continue;
    const auto arm = std::find_if(results.begin(), results.end(),
                                  [&](const ArmResults& one) { return one.arm.name == fields[0]; });
    if (arm == results.end()) continue;
    TrialResult trial;
    trial.seed = std::strtoull(fields[1].c_str(), nullptr, 10);
    trial.steps = std::atoi(fields[2].c_str());
    trial.error = {std::atof(fields[3].c_str()), std::atof(fields[4].c_str()), std::atof(fields[5].c_str()),
                   std::atof(fields[6].c_str())};
    trial.end = fields[7];
    trial.distances = numbers(fields[8]);
    trial.angles = numbers(fields[9]);
    arm->trials.push_back(std::move(trial));
  }
  return results;
}

}  // namespace edgepose
