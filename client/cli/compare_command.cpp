#include "client/cli/compare_command.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "client/cli/compare_report.h"
#include "client/cli/exit_codes.h"
#include "client/cli/match_report.h"
#include "client/cli/option_checks.h"
#include "client/cli/text.h"
#include "common/error.h"

namespace edgepose {
namespace {

constexpr const char* kCompareExamples = R"(Examples:
  edgepose compare recorded.lcmlog replayed.lcmlog                     # equal bit for bit?
  edgepose compare a.lcmlog b.lcmlog --tolerance-mm 0.5 --tolerance-deg 0.2
  edgepose compare answers.lcmlog --truth spine/test/000001 --json

Compares accepted poses. Two logs: by sequence number, which may start elsewhere. Truth: the images of the set in
their order, as edgepose send sends them. Exit code: 0 if equal (with --truth: all found, within 0.1 diameters),
1 if different, 2 for bad input.)";

struct CompareCommand {
  std::vector<std::filesystem::path> logs;
  std::filesystem::path truth;
  std::string camera;
  std::optional<double> tolerance_mm, tolerance_deg;
  bool as_json = false;

  void run() const;

 private:
  AnswerLog read(const std::filesystem::path& path) const;
  bool compare_two() const;
  bool compare_truth() const;
  template <class Result>
  void print(const Result& result) const;
};

AnswerLog CompareCommand::read(const std::filesystem::path& path) const {
  AnswerLog log = read_answer_log(path);
  const auto warn = [&](const std::string& what) {
    std::cerr << path.string() << ": warning: " << what << std::endl;
  };
  if (log.malformed > 0) warn(std::to_string(log.malformed) + " malformed answers were left out");
  if (log.skipped_bytes > 0)
    warn(std::to_string(log.skipped_bytes) + " bytes that belong to no message were skipped");
  if (log.cut_off) warn("it is cut off within a message");
  if (camera.empty()) return log;
  std::string known;
  for (const auto& [name, answers] : log.cameras) known += (known.empty() ? "" : ", ") + name;
  if (!log.cameras.contains(camera))
    throw InputError::at(path.string(), "answers for camera " + camera, known);
  std::erase_if(log.cameras, [&](const auto& each) { return each.first != camera; });
  return log;
}

template <class Result>
void CompareCommand::print(const Result& result) const {
  if (as_json)
    print_json(std::cout, to_json(result));
  else
    print_table(std::cout, result);
}

bool CompareCommand::compare_two() const {
  const Comparison result = compare_logs(read(logs[0]), read(logs[1]));
  print(result);
  const bool relaxed = tolerance_mm || tolerance_deg;
  const bool equal =
      relaxed ? result.is_within(1e-3 * tolerance_mm.value_or(0), tolerance_deg.value_or(0) / kDegrees)
              : result.is_bit_equal();
  if (!as_json)
    std::cout << (!equal ? "different\n" : relaxed ? "equal within the tolerance\n" : "equal bit for bit\n");
  return equal;
}

bool CompareCommand::compare_truth() const {
  const AnswerLog log = read(logs[0]);
  if (log.cameras.size() != 1)
    throw InputError::at(logs[0].string(), "answers for one camera",
                         std::to_string(log.cameras.size()) + " cameras", "choose one with --camera");
  const TestSet set = read_truth(truth);
  const TruthComparison result = compare_with_truth(log.cameras.begin()->second, set, make_pose_errors(set));
  print(result);
  return result.all_within(0.1);
}

void CompareCommand::run() const {
  if (truth.empty() ? logs.size() != 2 : logs.size() != 1)
    throw InputError::at("compare", truth.empty() ? "two logs, or one and --truth" : "one log with --truth",
                         std::to_string(logs.size()));
  if (!(truth.empty() ? compare_two() : compare_truth())) exit_not_found();
}

}  // namespace

void add_compare_command(CLI::App& app) {
  auto command = std::make_shared<CompareCommand>();
  CLI::App* compare =
      app.add_subcommand("compare", "Compare the poses in a log with another's, or with the truth");
  compare->add_option("LOG", command->logs, "LCM logs with answers, of edgepose record or replay --record")
      ->required();
  auto* truth =
      compare->add_option("--truth", command->truth, "BOP set, or scene folder in one (SET/test/NNNNNN)");
  compare->add_option("--camera", command->camera, "Only the answers for this camera");
  compare->add_option("--tolerance-mm", command->tolerance_mm, "Translations may differ so much")
      ->check(number_between(0, 1e6))
      ->excludes(truth);
  compare->add_option("--tolerance-deg", command->tolerance_deg, "Rotations may differ so much")
      ->check(number_between(0, 180))
      ->excludes(truth);
  compare->add_flag("--json", command->as_json, "Print JSON, SI units");
  compare->footer(kCompareExamples);
  compare->callback([command] { command->run(); });
}

}  // namespace edgepose
