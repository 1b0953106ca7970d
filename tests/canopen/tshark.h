#pragma once
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace edgepose {

/// A capture of a bus in the words of an independent decoder: tshark's CANopen dissector.
class Tshark {
 public:
  using Row = std::map<std::string, std::string>;  ///< of a frame: fields of kFields that it has

  static bool is_there() { return !output_of("command -v tshark").empty(); }
  explicit Tshark(const std::string& file) : read_("tshark -r '" + file + "' -d can.subdissector,canopen ") {
    std::string fields;
    for (const char* field : kFields) fields += std::string(" -e ") + field;
    std::istringstream lines(output_of(read_ + "-T fields" + fields + " 2>/dev/null"));
    for (std::string line; std::getline(lines, line);) {
      Row row;
      std::istringstream parts(line);
      for (const char* field : kFields)
        if (std::string part; std::getline(parts, part, '\t') && !part.empty()) row[field] = part;
      rows_.push_back(row);
    }
  }

  const std::vector<Row>& rows() const { return rows_; }
  /// All that it says of the frames that a display filter lets through; it takes a second to start.
  std::string words(const std::string& filter) const {
    return output_of(read_ + "-V -Y '" + filter + "' 2>/dev/null");
  }
  /// Frames of which it says all of this (fields of canopen); -1 asks for the field only.
  size_t count(const std::map<std::string, int>& said) const {
    return static_cast<size_t>(std::count_if(rows_.begin(), rows_.end(), [&](const Row& row) {
      return std::all_of(said.begin(), said.end(), [&](const auto& one) {
        const int found = number(row, "canopen." + one.first);
        return one.second == -1 ? found != -1 : found == one.second;
      });
    }));
  }
  /// -1 if the frame has no such field.
  static int number(const Row& row, const std::string& field) {
    const auto at = row.find(field);
    return at == row.end() ? -1 : static_cast<int>(std::strtol(at->second.c_str(), nullptr, 0));
  }

 private:
  static std::string output_of(const std::string& command) {
    std::string text;
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return text;
    std::array<char, 4096> block;
    for (size_t got; (got = fread(block.data(), 1, block.size(), pipe)) > 0;) text.append(block.data(), got);
    pclose(pipe);
    return text;
  }

  static constexpr const char* kFields[] = {
      "frame.time_epoch",        "_ws.malformed",       "canopen.cob_id",
      "canopen.node_id",         "canopen.nmt_ctrl.cd", "canopen.nmt_ctrl.node_id",
      "canopen.nmt_guard.state", "canopen.sdo.ccs",     "canopen.sdo.scs",
      "canopen.sdo.main_idx",    "canopen.sdo.sub_idx", "canopen.sdo.abort_code",
      "canopen.sdo.data.bytes",  "canopen.em.err_code", "canopen.pdo.data.bytes"};
  const std::string read_;
  std::vector<Row> rows_;
};

}  // namespace edgepose
