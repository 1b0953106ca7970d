#include "client/cli/eval_command.h"

#include <iostream>
#include <memory>

#include "client/cli/eval_output.h"
#include "client/cli/option_checks.h"
#include "client/cli/progress_bar.h"
#include "client/cli/set_input.h"
#include "common/atomic_file.h"
#include "common/error.h"
#include "evaluation/shard.h"
#include "files/number_text.h"
#include "settings/matcher_settings.h"

namespace edgepose {
namespace {

constexpr const char* kEvalExamples = R"(Examples:
  edgepose eval data/range --results range.csv
  edgepose eval data/industrial --all-models --results found.csv --report report/
  edgepose eval data/spine --group-by-modulo 3 --images 0-8
  edgepose eval data/spine --deadline-ms 50                      # how many are found in that time?
  edgepose eval data/spine --shard 2/8 --results part_2.shard    # on one of eight machines; then edgepose merge

The result file has BOP's columns: scene_id,im_id,obj_id,score,R,t,time (R row-major, t in mm, time in s for
that object in that image, its share of the preprocessing included). With --shard I/N every Nth image is looked at,
from the Ith on, and the result file is a shard, for edgepose merge. With --deadline-ms each object of an image has
that time for itself, all of the preprocessing included; match.max_seconds of --config then means nothing, and the
answers depend on how fast the machine is.)";

struct EvalCommand {
  SetInput input;
  EvalOutput output;
  std::string shard;
  bool all_models = false, paper_mode = false;
  std::optional<double> deadline_ms;

  void run() const;
  void run_shard(const TestSet& whole, const EvalOptions& options) const;
  std::string made_with(const TestSet& set, const EvalOptions& options) const;
  std::string command_line() const;
};

/// Program, set and every option, in one line: what parts of one evaluation have in common.
std::string EvalCommand::made_with(const TestSet& set, const EvalOptions& options) const {
  std::string text =
      "edgepose " EDGEPOSE_VERSION ", " + std::to_string(set.images.size()) + " images of " + set.name;
  if (!input.images.empty()) text += " (" + input.images + ")";
  for (const TestObject& object : set.objects) text += ", " + object.name;
  if (all_models) text += ", all models";
  if (deadline_ms) text += ", --deadline-ms " + number_text(*deadline_ms);
  Settings settings{options.train, options.scene, options.match};
  for (const SettingKey& key : setting_keys(settings))
    if (!key.path.ends_with(".threads")) text += "; " + key.path + "=" + to_toml(key);
  return one_line(text);
}

void EvalCommand::run_shard(const TestSet& whole, const EvalOptions& options) const {
  if (output.results.empty()) throw InputError::at("--shard", "--results FILE for the shard", "none");
  if (!output.report.empty() || output.group_modulo > 0)
    throw InputError::at("--shard", "no --report or --group-by-modulo", "one", "edgepose merge has them");
  output.check(input.files(whole));
  ShardRun run;
  run.shard = parse_shard(shard);
  const TestSet set = take_shard(whole, run.shard);
  const auto models = train_models(set, options, progress_bar("training"));
  run.made_with = made_with(whole, options);
  run.set_checksum = checksum_of(whole);
  run.folder = input.folder.string();
  run.objects = input.objects;
  run.images = input.images;
  run.all_models = all_models;
  run.models = facts_of(models);
  run.evaluation = run_evaluation(set, models, options, progress_bar("evaluating"));
  write_file_atomically(output.results, format_shard(run));
  std::cout << "part " << shard << ": " << run.evaluation.rows.size() << " answers in " << set.images.size()
            << " of " << whole.images.size() << " images, to " << output.results.string() << '\n';
}

std::string EvalCommand::command_line() const {
  std::string text = "edgepose eval " + input.command_line();
  if (all_models) text += " --all-models";
  if (paper_mode) text += " --paper-mode";
  if (deadline_ms) text += " --deadline-ms " + number_text(*deadline_ms);
  if (output.group_modulo > 0) text += " --group-by-modulo " + std::to_string(output.group_modulo);
  return text;
}

void EvalCommand::run() const {
  const TestSet set = input.read();
  EvalOptions options = input.options();
  options.all_models = all_models;
  if (deadline_ms) options.deadline = 1e-3 * *deadline_ms;
  if (paper_mode) options.match.verification = Verification::kPaper;
  if (!shard.empty()) return run_shard(set, options);
  output.check(input.files(set));

  const auto models = train_models(set, options, progress_bar("training"));
  const Evaluation evaluation = run_evaluation(set, models, options, progress_bar("evaluating"));
  output.write(set, evaluation, facts_of(models), all_models, command_line());
}

}  // namespace

void add_eval_command(CLI::App& app) {
  auto command = std::make_shared<EvalCommand>();
  CLI::App* eval =
      app.add_subcommand("eval", "Find the objects of a test set in its images and score the poses");
  command->input.add_options(*eval);
  command->output.add_options(*eval);
  eval->add_flag("--all-models", command->all_models,
                 "Ask for every model in every image; write and count only accepted poses");
  eval->add_flag("--paper-mode", command->paper_mode, "Verify poses as the paper does; always gives a pose");
  add_deadline_option(*eval, command->deadline_ms, "each object in each image");
  eval->add_option("--shard", command->shard,
                   "I/N: only every Nth image, from the Ith on, to a file for edgepose merge");
  eval->footer(kEvalExamples);
  eval->callback([command] { command->run(); });
}

}  // namespace edgepose
