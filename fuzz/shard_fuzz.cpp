#include "evaluation/shard.h"
#include "fuzz/input_check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  ShardRun run;
  // With the checksum put right: what is behind it is to be seen.
  const std::string input = with_checksum(std::string(text_of(data, size)));
  if (!reads([&] { run = parse_shard_file(input, "part.shard"); })) return 0;
  for (const EvalRow& row : run.evaluation.rows) {
    const Eigen::Matrix3d& rotation = row.camera_T_model.linear();
    must_hold((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm() < 0.1);
  }
  // What was read is written as the same bits again.
  const std::string text = format_shard(run);
  ShardRun again;
  must_hold(reads([&] { again = parse_shard_file(text, "again.shard"); }) && format_shard(again) == text);
  return 0;
}
