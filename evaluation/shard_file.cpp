#include <zlib.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "evaluation/shard.h"
#include "files/json_node.h"
#include "files/rigid_values.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

using nlohmann::json;

constexpr const char* kKind = "edgepose-shard";
constexpr int kVersion = 2;
constexpr size_t kMaxBytes = size_t{1} << 30;
constexpr size_t kMaxText = 1u << 16;

json heading(const ShardRun& run) {
  json models = json::array();
  for (const TrainingFacts& m : run.models)
    models.push_back({{"object", m.object_id},
                      {"diameter_m", m.diameter},
                      {"points", m.points},
                      {"pairs", m.pairs},
                      {"bytes", m.bytes},
                      {"seconds", m.seconds}});
  return {{"kind", kKind},
          {"version", kVersion},
          {"shard", run.shard.index},
          {"of", run.shard.count},
          {"made_with", run.made_with},
          {"set_checksum", run.set_checksum},
          {"folder", run.folder},
          {"objects", run.objects},
          {"images", run.images},
          {"all_models", run.all_models},
          {"models", models},
          {"rows", run.evaluation.rows.size()},
          {"wall_seconds", run.evaluation.wall_seconds},
          {"cpu_seconds", run.evaluation.cpu_seconds},
          {"peak_memory_megabytes", run.evaluation.peak_memory_megabytes}};
}

json row_json(const EvalRow& row) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rotation = row.camera_T_model.linear();
  const Eigen::Vector3d translation = row.camera_T_model.translation();
  const StageTimes& s = row.stages;
  return {{"scene", row.scene_id},
          {"image", row.image_id},
          {"object", row.object_id},
          {"found", row.found},
          {"accepted", row.accepted},
          {"cut_short", row.cut_short},
          {"score", row.score},
          {"rotation", std::vector<double>(rotation.data(), rotation.data() + 9)},
          {"translation_m", std::vector<double>(translation.begin(), translation.end())},
          {"seconds", row.seconds},
          {"preprocessing", row.preprocessing},
          {"stages", {s.sampling, s.voting, s.clustering, s.verification, s.refinement}},
          {"reason", row.reason}};
}

size_t count_of(const JsonNode& node) {
  const double value = node.number();
  if (!(value >= 0 && value <= 1e15)) node.fail("a count");
  return static_cast<size_t>(value);
}

double time_of(const JsonNode& node) {
  const double value = node.number();
  if (!(value >= 0 && value <= 1e9)) node.fail("a time in seconds, not negative");
  return value;
}

std::string short_text(const JsonNode& node) {
  std::string text = node.text();
  if (text.size() > kMaxText) node.fail("a text of at most 64 KiB");
  return text;
}

TrainingFacts model_from(const JsonNode& node) {
  TrainingFacts facts;
  facts.object_id = node.at("object").integer();
  facts.diameter = node.at("diameter_m").positive();
  facts.points = count_of(node.at("points"));
  facts.pairs = count_of(node.at("pairs"));
  facts.bytes = count_of(node.at("bytes"));
  facts.seconds = time_of(node.at("seconds"));
  return facts;
}

/// The same bits as were written: checked to be a rotation, but not mended.
RigidTransform pose_from(const JsonNode& node) {
  const std::vector<double> rotation = node.at("rotation").numbers(9);
  std::vector<double> translation = node.at("translation_m").numbers(3);
  RigidTransform pose = RigidTransform::Identity();
  for (int i = 0; i < 9; ++i) pose.linear()(i / 3, i % 3) = rotation[static_cast<size_t>(i)];
  for (int i = 0; i < 3; ++i) pose.translation()[i] = translation[static_cast<size_t>(i)];
  for (double& t : translation) t *= 1e3;
  rigid_from_row_major(rotation, translation, node.where());
  return pose;
}

EvalRow row_from(const JsonNode& node) {
  EvalRow row;
  row.scene_id = node.at("scene").integer();
  row.image_id = node.at("image").integer();
  row.object_id = node.at("object").integer();
  row.found = node.at("found").boolean();
  row.accepted = node.at("accepted").boolean();
  row.cut_short = node.at("cut_short").boolean();
  row.score = node.at("score").number();
  row.camera_T_model = pose_from(node);
  row.seconds = time_of(node.at("seconds"));
  row.preprocessing = time_of(node.at("preprocessing"));
  const std::vector<double> stages = node.at("stages").numbers(5);
  row.stages = {stages[0], stages[1], stages[2], stages[3], stages[4]};
  row.reason = short_text(node.at("reason"));
  return row;
}

ShardRun heading_from(const JsonNode& node, size_t& rows) {
  if (const JsonNode kind = node.at("kind"); kind.text() != kKind)
    kind.fail(std::string("\"") + kKind + "\"", "edgepose eval --shard writes such files");
  if (const JsonNode version = node.at("version"); version.integer() != kVersion)
    version.fail("version " + std::to_string(kVersion), "evaluate again with this program");
  ShardRun run;
  run.shard = {node.at("shard").integer(), node.at("of").integer()};
  parse_shard(std::to_string(run.shard.index) + "/" + std::to_string(run.shard.count));
  run.made_with = short_text(node.at("made_with"));
  run.set_checksum = short_text(node.at("set_checksum"));
  run.folder = short_text(node.at("folder"));
  for (const JsonNode& object : node.at("objects").items()) run.objects.push_back(short_text(object));
  run.images = short_text(node.at("images"));
  run.all_models = node.at("all_models").boolean();
  for (const JsonNode& model : node.at("models").items()) run.models.push_back(model_from(model));
  run.evaluation.wall_seconds = time_of(node.at("wall_seconds"));
  run.evaluation.cpu_seconds = time_of(node.at("cpu_seconds"));
  run.evaluation.peak_memory_megabytes = node.at("peak_memory_megabytes").number();
  rows = count_of(node.at("rows"));
  return run;
}

/// Changes of a disk, a network or a hand; nobody is kept from forging.
std::string crc_text(std::string_view text) {
  char digits[16];
  std::snprintf(digits, sizeof digits, "%08lx",
                crc32_z(0, reinterpret_cast<const unsigned char*>(text.data()), text.size()));
  return digits;
}

std::string crc_line(const std::string& sum) { return "{\"crc32\":\"" + sum + "\"}\n"; }

/// `text` without the last line, which must hold the checksum of the others.
std::string_view checked(std::string_view text, const std::string& name) {
  constexpr const char* kAgain = "evaluate this part again";
  const size_t lines = static_cast<size_t>(std::count(text.begin(), text.end(), '\n'));
  if (!text.ends_with('\n'))
    throw InputError::at(name + ", line " + std::to_string(lines + 1), "a whole line",
                         "a file that ends within it", kAgain);
  const std::string_view before = text.substr(0, text.rfind('\n', text.size() - 2) + 1);
  const std::string sum = crc_text(before), line = crc_line(sum);
  const std::string_view last = text.substr(before.size());
  if (last == line) return before;
  if (last.size() == line.size() && last.starts_with("{\"crc32\":\""))
    throw InputError::at(name, "the checksum " + std::string(last.substr(10, 8)) + ", as its last line says",
                         sum + ": it was changed since it was written", kAgain);
  throw InputError::at(name + ", line " + std::to_string(lines), "the checksum that ends a shard",
                       "another line: the end is missing", kAgain);
}

}  // namespace

std::string with_checksum(const std::string& text) { return text + crc_line(crc_text(text)); }

std::string format_shard(const ShardRun& run) {
  const auto plain = [](const json& value) {
    return value.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
  };
  std::string text = plain(heading(run));
  for (const EvalRow& row : run.evaluation.rows) text += plain(row_json(row));
  return with_checksum(text);
}

ShardRun parse_shard_file(std::string_view text, const std::string& name) {
  if (!text.starts_with('{'))
    throw InputError::at(name, "a shard of edgepose eval --shard",
                         text.empty() ? "an empty file" : "another file",
                         "what eval writes without --shard is whole already");
  std::optional<ShardRun> run;
  size_t rows = 0, number = 0;
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    const std::string where = name + ", line " + std::to_string(++number);
    const json value = parse_json(text.substr(0, end), where);
    const JsonNode node(value, where);
    if (run) {
      run->evaluation.rows.push_back(row_from(node));
    } else {
      run = heading_from(node, rows);  // before the checksum: other versions have none
      text = checked(text, name);
    }
    text.remove_prefix(end + 1);
  }
  if (run->evaluation.rows.size() != rows)
    throw InputError::at(name, std::to_string(rows) + " answers, as its first line says",
                         std::to_string(run->evaluation.rows.size()), "evaluate this part again");
  return *std::move(run);
}

ShardRun read_shard(const std::filesystem::path& path) {
  return parse_shard_file(read_whole_file(path, "a shard of edgepose eval --shard", kMaxBytes),
                          path.string());
}

}  // namespace edgepose
