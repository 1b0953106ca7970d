#include "servo/experiment_command.h"

#include <cstdio>
#include <ctime>
#include <fstream>
#include <iostream>
#include <memory>

#include "client/service/stop_signals.h"
#include "common/error.h"
#include "experiment/experiment_report.h"

namespace edgepose {
namespace {

constexpr const char* kExperimentExamples = R"(Examples:
  edgepose-servo experiment --mesh phantom.ply --plan drill_plan.json -o experiment/
  edgepose-servo experiment --mesh phantom.ply --plan drill_plan.json -o experiment/ --trials 10 --only "C exact goal"

Each trial: the real controller and the real pose service's code on rendered, noisy depth, CANopen frames on a wire in
memory; in simulated time, with rows A (one shot), B, C, D1 and D5 (docs/servoing.md). An experiment that was cut short
goes on where it was when it is started again with the same folder. Ctrl-C ends it; what is done is kept.
Exit code: 0 done, 1 cut short, 2 bad input (one line on stderr says what).)";

std::string utc_date() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%d", std::gmtime(&now));
  return text;
}

bool ends_with_a_line(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (file.tellg() <= 0) return true;
  file.seekg(-1, std::ios::end);
  return file.get() == '\n';
}

/// FNV-1a, 64 bits: tells contents apart that were changed, not those that were forged.
std::string checksum(const std::filesystem::path& path) {
  uint64_t sum = 0xcbf2'9ce4'8422'2325;
  std::ifstream file(path, std::ios::binary);
  for (char c = 0; file.get(c);) sum = (sum ^ static_cast<uint8_t>(c)) * 0x0000'0100'0000'01b3;
  char text[20];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sum));
  return text;
}

struct ExperimentCommand {
  WorkCellOptions cell;
  ExperimentOptions options;
  std::filesystem::path output;
  std::vector<std::string> only;

  void choose_arms() {
    if (only.empty()) return;
    std::vector<ExperimentArm> chosen;
    for (const std::string& name : only) {
      const size_t before = chosen.size();
      for (const ExperimentArm& arm : standard_arms())
        if (arm.name == name || arm.name.substr(0, arm.name.find(' ')) == name) chosen.push_back(arm);
      if (chosen.size() == before)
        throw InputError::at("--only", "A, B, C, D1, D5 or the name of a row", "'" + name + "'");
    }
    options.arms = chosen;
  }

  /// What trials of one file have in common.
  std::string made_with() const {
    const auto named = [](const std::filesystem::path& path) {
      return path.filename().string() + " (" + checksum(path) + ")";
    };
    return "edgepose " EDGEPOSE_VERSION ", mesh " + named(cell.model) + ", plan " + named(cell.plan) +
           ", target " + (cell.target.empty() ? "the first" : cell.target);
  }

  void run() {
    choose_arms();
    const WorkCell work_cell = make_work_cell(cell);
    std::filesystem::create_directories(output);
    const std::filesystem::path file = output / "trials.csv";
    const std::string origin = made_with();
    std::vector<ArmResults> done = read_trials(file, origin, options.arms);
    for (ArmResults& arm : done)
      std::erase_if(arm.trials, [&](const TrialResult& trial) {
        return trial.seed < options.first_seed ||
               trial.seed >= options.first_seed + static_cast<uint64_t>(options.trials);
      });
    size_t count = 0;
    for (const ArmResults& arm : done) count += arm.trials.size();
    const size_t all = static_cast<size_t>(options.trials) * options.arms.size();
    if (count > 0) std::cerr << count << " of " << all << " trials are there already\n";
    const bool is_new = !std::filesystem::exists(file);
    std::ofstream lines(file, std::ios::app);
    if (is_new)
      lines << trial_heading(origin);
    else if (!ends_with_a_line(file))  // cut short while it was written
      lines << '\n';
    if (!lines) throw InputError::at(file.string(), "a file that can be written", "none");
    const StopSignals signals;
    const auto note = [&](const ExperimentArm& arm, const TrialResult& result) {
      lines << trial_line(arm, result) << std::flush;
      std::fprintf(stderr, "%zu of %zu: %s, seed %llu: %s, %.2f mm, %.2f degrees\n", ++count, all,
                   arm.name.c_str(), static_cast<unsigned long long>(result.seed), result.end.c_str(),
                   1e3 * result.error.translation, result.error.angle * 180 / M_PI);
    };
    const std::vector<ArmResults> results =
        run_experiment(work_cell, options, std::move(done), note, signals.token());
    write_report(output, results, "edgepose-servo experiment --trials " + std::to_string(options.trials),
                 utc_date());
    std::cout << results_table(results) << "\nreport: " << (output / "report.md").string() << '\n';
    if (signals.token().stop_requested()) throw CLI::RuntimeError(1);
  }
};

}  // namespace

void add_experiment_command(CLI::App& app) {
  auto command = std::make_shared<ExperimentCommand>();
  CLI::App* experiment = app.add_subcommand("experiment", "Many positionings in simulated time, to a table");
  experiment->add_option("--mesh", command->cell.model, "Mesh of the bone, millimetres")->required();
  experiment->add_option("--plan", command->cell.plan, "Drill plan for it")->required();
  experiment->add_option("--target", command->cell.target, "Hole of the plan (default: its first)");
  experiment->add_option("-o,--output", command->output, "Folder for trials.csv, report.md and plots")
      ->required();
  experiment->add_option("--trials", command->options.trials, "Trials of each row (default 200)")
      ->check(CLI::Range(1, 1'000'000));
  experiment->add_option("--first-seed", command->options.first_seed, "Of the first trial (default 1)");
  experiment->add_option("--only", command->only, "Rows: A, B, C, D1, D5 or a whole name; more than once");
  experiment->add_option("--threads", command->options.threads, "Trials at once (default: all cores)")
      ->check(CLI::Range(0, 256));
  experiment->footer(kExperimentExamples);
  experiment->callback([command] { command->run(); });
}

}  // namespace edgepose
