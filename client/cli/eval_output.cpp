#include "client/cli/eval_output.h"

#include <iostream>

#include "client/cli/option_checks.h"
#include "common/output_target.h"
#include "evaluation/report.h"

namespace edgepose {

void EvalOutput::add_options(CLI::App& command) {
  add_output_option(command, "--results", results, "BOP result file (CSV) to write");
  command.add_option("--group-by-modulo", group_modulo, "Recall also by image number modulo this")
      ->check(CLI::Range(1, 1000));
  add_output_option(command, "--report", report, "Folder for report.md and its plots (needs gnuplot)");
}

void EvalOutput::check(const std::vector<std::filesystem::path>& read) const {
  if (!report.empty()) check_output_folder(report);
  if (!results.empty()) check_output(results, read);
}

void EvalOutput::write(const TestSet& set, const Evaluation& evaluation,
                       const std::vector<TrainingFacts>& models, bool all_models,
                       const std::string& command) const {
  if (!results.empty()) write_bop_results(results, to_bop_results(evaluation.rows, all_models));
  const Scores scores = score_results(set, make_pose_errors(set), evaluation.rows, all_models);
  const EvalReport told{set, all_models, models, evaluation, scores, group_modulo, command};
  std::cout << result_tables(told);
  if (report.empty()) return;
  if (const std::string warning = write_report(told, report); !warning.empty())
    std::cerr << "edgepose: warning: " << warning << std::endl;
  std::cout << "\nReport: " << (report / "report.md").string() << "\n";
}

}  // namespace edgepose
