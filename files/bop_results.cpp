#include "files/bop_results.h"

#include "common/atomic_file.h"
#include "common/error.h"
#include "files/number_text.h"
#include "files/rigid_values.h"
#include "files/text_cursor.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr const char* kHeader = "scene_id,im_id,obj_id,score,R,t,time";
constexpr const char* kExpectedResults = "a BOP result file (scene_id,im_id,obj_id,score,R,t,time)";
constexpr size_t kMaxResultBytes = 1u << 30;

std::string format_line(const BopResult& result) {
  std::vector<double> rotation, translation;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column)
      rotation.push_back(result.camera_T_model.linear()(row, column));
    translation.push_back(result.camera_T_model.translation()(row) * 1e3);
  }
  std::string line;
  for (const int id : {result.scene_id, result.image_id, result.object_id}) line += std::to_string(id) + ",";
  return line + number_text(result.score) + "," + numbers_text(rotation) + "," + numbers_text(translation) +
         "," + number_text(result.time) + "\n";
}

double number(std::string_view field, const std::string& where, const char* what) {
  const auto value = finite_number(field);
  if (!value) throw InputError::at(where, std::string("a finite number as ") + what, edgepose::quoted(field));
  return *value;
}

int id(std::string_view field, const std::string& where, const char* what) {
  const auto value = identifier(trim(field));
  if (!value) throw InputError::at(where, std::string("an id as ") + what, edgepose::quoted(field));
  return *value;
}

std::vector<double> numbers(std::string_view field, size_t count, const std::string& where,
                            const char* what) {
  const std::vector<std::string_view> parts = split_at_blanks(field);
  if (parts.size() != count)
    throw InputError::at(where, std::to_string(count) + " values as " + what, std::to_string(parts.size()));
  std::vector<double> values;
  values.reserve(count);
  for (const std::string_view part : parts) values.push_back(number(part, where, what));
  return values;
}

BopResult parse_line(std::string_view line, const std::string& where) {
  const std::vector<std::string_view> fields = split(line, ',');
  if (fields.size() != 7)
    throw InputError::at(where, std::string("7 fields ") + kHeader, std::to_string(fields.size()));
  BopResult result;
  result.scene_id = id(fields[0], where, "scene_id");
  result.image_id = id(fields[1], where, "im_id");
  result.object_id = id(fields[2], where, "obj_id");
  result.score = number(fields[3], where, "score");
  result.camera_T_model =
      rigid_from_row_major(numbers(fields[4], 9, where, "R"), numbers(fields[5], 3, where, "t"), where);
  result.time = number(fields[6], where, "time");
  return result;
}

}  // namespace

std::string format_bop_results(const std::vector<BopResult>& results) {
  std::string text = std::string(kHeader) + "\n";
  for (const BopResult& result : results) text += format_line(result);
  return text;
}

void write_bop_results(const std::filesystem::path& path, const std::vector<BopResult>& results) {
  write_file_atomically(path, std::string_view(format_bop_results(results)));
}

std::vector<BopResult> parse_bop_results(std::string_view text, const std::string& name) {
  std::vector<BopResult> results;
  TextCursor cursor(text, name);
  for (size_t number = 1; !cursor.at_end(); ++number) {
    const std::string_view line = trim(cursor.line());
    if (line.empty() || (number == 1 && line == kHeader)) continue;
    results.push_back(parse_line(line, name + ", line " + std::to_string(number)));
  }
  return results;
}

std::vector<BopResult> read_bop_results(const std::filesystem::path& path) {
  return parse_bop_results(read_whole_file(path, kExpectedResults, kMaxResultBytes), path.string());
}

}  // namespace edgepose
