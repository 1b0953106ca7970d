#include "client/cli/study_command.h"

#include <algorithm>
#include <iostream>
#include <memory>

#include "client/cli/option_checks.h"
#include "client/cli/progress_bar.h"
#include "client/cli/set_input.h"
#include "common/atomic_file.h"
#include "common/output_target.h"
#include "evaluation/report.h"
#include "evaluation/study.h"

namespace edgepose {
namespace {

constexpr const char* kStudyExamples = R"(Examples:
  edgepose study data/spine --experiment sampling --group-by-modulo 3
  edgepose study data/range --report study_range/
  edgepose study data/range --experiment noise,verification --images 0-9

Experiments: noise (Gaussian noise of 0 to 2 mm), sampling (with and without emphasis on edges), verification
(surface overlap, the paper's S, free space), early-exit (three ways of running the paper's verification) and
sweep (the two steps, N and s). All of them take an hour on a large set; tables appear as they are ready.)";

struct StudyCommand {
  SetInput input;
  std::filesystem::path report;
  std::vector<std::string> names = {"all"};
  int group_modulo = 0;

  void run() const;
  std::vector<Experiment> wanted() const;
  std::string command_line() const;
};

std::vector<Experiment> StudyCommand::wanted() const {
  const bool all = std::find(names.begin(), names.end(), "all") != names.end();
  std::vector<Experiment> list;
  for (const std::string& name : all ? experiment_names() : names)
    for (Experiment& experiment : experiments(name, input.options())) list.push_back(std::move(experiment));
  return list;
}

std::string StudyCommand::command_line() const {
  std::string text = "edgepose study " + input.command_line() + " --experiment ";
  for (size_t i = 0; i < names.size(); ++i) text += (i ? "," : "") + shell_quoted(names[i]);
  if (group_modulo > 0) text += " --group-by-modulo " + std::to_string(group_modulo);
  return text;
}

void StudyCommand::run() const {
  const std::vector<Experiment> list = wanted();
  const TestSet set = input.read();
  if (!report.empty()) check_output_folder(report);
  const PoseErrors errors = make_pose_errors(set);

  std::string document = "# Study of " + harmless_text(set.name) + "\n\n    " + command_line() + "\n\n",
              warning;
  for (const Experiment& experiment : list) {
    const auto results = run_experiment(set, errors, experiment, progress_bar(experiment.key));
    const StudySection section = describe(set, experiment, results, group_modulo);
    std::cout << section.markdown << std::endl;
    if (report.empty()) continue;
    FileGroup files;  // one for each experiment, so that a stopped study is not lost
    document += section.markdown + draw_all(section.plots, report, files, warning) + "\n";
    files.add(report / "study.md", document);
    files.commit();
  }
  if (!warning.empty()) std::cerr << "edgepose: warning: " << warning << std::endl;
  if (!report.empty()) std::cout << "Report: " << (report / "study.md").string() << "\n";
}

}  // namespace

void add_study_command(CLI::App& app) {
  auto command = std::make_shared<StudyCommand>();
  CLI::App* study =
      app.add_subcommand("study", "Run the paper's experiments on a test set: tables and plots");
  command->input.add_options(*study);
  std::vector<std::string> known = experiment_names();
  known.emplace_back("all");
  study
      ->add_option("--experiment", command->names,
                   "Which: noise, sampling, verification, early-exit, sweep, all")
      ->delimiter(',')
      ->check(CLI::IsMember(known));
  study
      ->add_option("--group-by-modulo", command->group_modulo,
                   "Columns are image numbers modulo this, not objects")
      ->check(CLI::Range(1, 1000));
  add_output_option(*study, "--report", command->report, "Folder for study.md and its plots (needs gnuplot)");
  study->footer(kStudyExamples);
  study->callback([command] { command->run(); });
}

}  // namespace edgepose
