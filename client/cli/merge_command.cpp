#include "client/cli/merge_command.h"

#include <memory>

#include "client/cli/eval_output.h"
#include "client/cli/set_input.h"
#include "evaluation/shard.h"

namespace edgepose {
namespace {

constexpr const char* kMergeExamples = R"(Examples:
  edgepose merge part_*.shard --results spine.csv --report report/
  edgepose merge part_*.shard --set /mnt/data/spine    # where the test set is here

The parts are what edgepose eval --shard I/N wrote, all N of them. Results, tables and report are those of the whole
evaluation in one run, the same bits; only times are those of the machines. Refused are parts that were changed since
they were written, and parts of another set: other meshes, truth or sizes of images. deploy/cluster has a Slurm array and
a Kubernetes job.)";

struct MergeCommand {
  std::vector<std::filesystem::path> shards;
  std::filesystem::path folder;
  EvalOutput output;

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
  SetInput input;
  input.folder = folder.empty() ? std::filesystem::path(first.folder) : folder;
  input.objects = first.objects;
  input.images = first.images;
  const TestSet set = input.read();
  output.check(shards);

  const ShardRun whole = merge_shards(parts, names, set);
  output.write(set, whole.evaluation, whole.models, whole.all_models,
               "edgepose merge, of " + std::to_string(parts.size()) + " parts");
}

}  // namespace

void add_merge_command(CLI::App& app) {
  auto command = std::make_shared<MergeCommand>();
  CLI::App* merge = app.add_subcommand("merge", "Put the parts of an evaluation (eval --shard) together");
  merge->add_option("SHARD", command->shards, "Files that edgepose eval --shard wrote, all parts")
      ->required();
  merge->add_option("--set", command->folder, "The test set, if it is elsewhere than the shards say");
  command->output.add_options(*merge);
  merge->footer(kMergeExamples);
  merge->callback([command] { command->run(); });
}

}  // namespace edgepose
