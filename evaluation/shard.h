#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "evaluation/evaluate.h"

namespace edgepose {

/// One of `count` parts of an evaluation, which many machines work on.
struct Shard {
  int index = 1;  ///< 1 to count
  int count = 1;  ///< 1 to 100000
};

/// "2/8". Throws InputError.
Shard parse_shard(const std::string& text);

/// Every `count`th image of `set`, from the `index`th on; there may be none.
TestSet take_shard(TestSet set, const Shard& shard);

/// Tells test sets apart by what is in them, wherever they lie: contents of descriptions and meshes, sizes of
/// images.
std::string checksum_of(const TestSet& set);

/// What an evaluation of a part found, and what is needed to put it together with the others.
struct ShardRun {
  Shard shard;
  std::string made_with;             ///< program, test set and options in one line: the same for all parts
  std::string set_checksum;          ///< of the whole selection
  std::string folder;                ///< of the test set
  std::vector<std::string> objects;  ///< of the selection, as Selection has them
  std::string images;
  bool all_models = false;
  std::vector<TrainingFacts> models;
  Evaluation evaluation;
};

/// A shard file: a line of JSON that says what it is, then one for each question, then one with a checksum of
/// all before. Doubles are written so that they are read as the same bits.
std::string format_shard(const ShardRun& run);
/// `text` and the line with its checksum.
std::string with_checksum(const std::string& text);
/// Throws InputError that names the file, the line and what is wrong.
ShardRun read_shard(const std::filesystem::path& path);
ShardRun parse_shard_file(std::string_view text, const std::string& name);

/// The whole evaluation: rows in the order of `set` (the whole selection), times added up. Throws InputError
/// if a part is missing, is there twice, was made with something else or of another set, or lacks an answer.
/// `names`: of the parts, for messages.
ShardRun merge_shards(const std::vector<ShardRun>& parts, const std::vector<std::string>& names,
                      const TestSet& set);

}  // namespace edgepose
