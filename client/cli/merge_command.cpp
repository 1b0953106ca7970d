#include "client/cli/merge_command.h"

#include <iostream>
#include <memory>

#include "client/cli/option_checks.h"
#include "common/error.h"
#include "common/output_target.h"
#include "evaluation/report.h"
#include "evaluation/selection.h"
#include "evaluation/shard.h"

namespace edgepose {
namespace {

constexpr const char* kMergeExamples = R"(Examples:
  edgepose merge part_*.shard --results spine.csv --report report/
  edgepose merge part_*.shard --set /mnt/data/spine    # where the test set is here

The parts are what edgepose eval --shard I/N wrote, all N of them. Results, tables and report are those of the whole
evaluation in one run, the same bits; only times are those of the machines. deploy/cluster has a Slurm array and a
Kubernetes job.)";

struct MergeCommand {
  std::vector<std::filesystem::path> shards;
  std::filesystem::path folder, results, report;
  int group_modulo = 0;

  void run() const;
};

void MergeCommand::run() const {
  std::vector<ShardRun> parts;
  std::vector<std::string> names;
  for (const std::filesystem::path& path : shards) {
    parts.push_back(read_shard(path));
    names.push_back(path.string());
  }
  const ShardRun& first = parts.front();
  Selection selection;
  selection.objects = first.objects;
  if (!first.images.empty()) parse_images(first.images, selection);
  const std::filesystem::path where = folder.empty() ? std::filesystem::path(first.folder) : folder;
  const TestSet set = select(read_test_set(where), selection);
  if (!report.empty()) check_output_folder(report);
  if (!results.empty()) check_output(results, shards);

  const ShardRun whole = merge_shards(parts, names, set);
  if (!results.empty()) write_bop_results(results, to_bop_results(whole.evaluation.rows, whole.all_models));
  const Scores scores = score_results(set, make_pose_errors(set), whole.evaluation.rows, whole.all_models);
  const EvalReport told{set,
                        whole.all_models,
                        whole.models,
                        whole.evaluation,
                        scores,
                        group_modulo,
                        "edgepose merge, of " + std::to_string(parts.size()) + " parts"};
  std::cout << result_tables(told);
  if (report.empty()) return;
  if (const std::string warning = write_report(told, report); !warning.empty())
    std::cerr << "edgepose: warning: " << warning << std::endl;
  std::cout << "\nReport: " << (report / "report.md").string() << "\n";
}

}  // namespace

void add_merge_command(CLI::App& app) {
  auto command = std::make_shared<MergeCommand>();
  CLI::App* merge = app.add_subcommand("merge", "Put the parts of an evaluation (eval --shard) together");
  merge->add_option("SHARD", command->shards, "Files that edgepose eval --shard wrote, all parts")
      ->required();
  merge->add_option("--set", command->folder, "The test set, if it is elsewhere than the shards say");
  add_output_option(*merge, "--results", command->results, "BOP result file (CSV) to write");
  merge->add_option("--group-by-modulo", command->group_modulo, "Recall also by image number modulo this")
      ->check(CLI::Range(1, 1000));
  add_output_option(*merge, "--report", command->report,
                    "Folder for report.md and its plots (needs gnuplot)");
  merge->footer(kMergeExamples);
  merge->callback([command] { command->run(); });
}

}  // namespace edgepose
