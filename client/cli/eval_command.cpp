#include "client/cli/eval_command.h"

#include <iostream>
#include <memory>

#include "client/cli/option_checks.h"
#include "client/cli/progress_bar.h"
#include "client/cli/set_input.h"
#include "common/output_target.h"
#include "evaluation/report.h"

namespace edgepose {
namespace {

constexpr const char* kEvalExamples = R"(Examples:
  edgepose eval data/range --results range.csv
  edgepose eval data/industrial --all-models --results found.csv --report report/
  edgepose eval data/spine --group-by-modulo 3 --images 0-8

The result file has BOP's columns: scene_id,im_id,obj_id,score,R,t,time (R row-major, t in mm, time in s for
that object in that image, its share of the preprocessing included).)";

struct EvalCommand {
  SetInput input;
  std::filesystem::path results, report;
  bool all_models = false, paper_mode = false;
  int group_modulo = 0;

  void run() const;
  std::string command_line() const;
};

std::string EvalCommand::command_line() const {
  std::string text = "edgepose eval " + input.command_line();
  if (all_models) text += " --all-models";
  if (paper_mode) text += " --paper-mode";
  if (group_modulo > 0) text += " --group-by-modulo " + std::to_string(group_modulo);
  return text;
}

void EvalCommand::run() const {
  const TestSet set = input.read();
  EvalOptions options = input.options();
  options.all_models = all_models;
  if (paper_mode) options.match.verification = Verification::kPaper;
  // Found out before the work, not after it.
  if (!report.empty()) check_output_folder(report);
  if (!results.empty()) check_output(results, input.files(set));

  const auto models = train_models(set, options, progress_bar("training"));
  const Evaluation evaluation = run_evaluation(set, models, options, progress_bar("evaluating"));
  if (!results.empty()) write_bop_results(results, to_bop_results(evaluation.rows, all_models));

  const Scores scores = score_results(set, make_pose_errors(set), evaluation.rows, all_models);
  const EvalReport told{set, options, models, evaluation, scores, group_modulo, command_line()};
  std::cout << result_tables(told);
  if (report.empty()) return;
  if (const std::string warning = write_report(told, report); !warning.empty())
    std::cerr << "edgepose: warning: " << warning << std::endl;
  std::cout << "\nReport: " << (report / "report.md").string() << "\n";
}

}  // namespace

void add_eval_command(CLI::App& app) {
  auto command = std::make_shared<EvalCommand>();
  CLI::App* eval =
      app.add_subcommand("eval", "Find the objects of a test set in its images and score the poses");
  command->input.add_options(*eval);
  add_output_option(*eval, "--results", command->results, "BOP result file (CSV) to write");
  eval->add_flag("--all-models", command->all_models,
                 "Ask for every model in every image; write and count only accepted poses");
  eval->add_flag("--paper-mode", command->paper_mode, "Verify poses as the paper does; always gives a pose");
  eval->add_option("--group-by-modulo", command->group_modulo, "Recall also by image number modulo this")
      ->check(CLI::Range(1, 1000));
  add_output_option(*eval, "--report", command->report, "Folder for report.md and its plots (needs gnuplot)");
  eval->footer(kEvalExamples);
  eval->callback([command] { command->run(); });
}

}  // namespace edgepose
