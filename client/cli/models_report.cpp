#include "client/cli/models_report.h"

#include <ctime>
#include <nlohmann/json.hpp>
#include <ostream>

#include "client/cli/control_options.h"
#include "client/cli/text.h"

namespace edgepose {
namespace {

using nlohmann::json;

std::string date_of(const json& object, const char* key) {
  const json& value = member(object, key);
  if (!value.is_number_integer()) return "-";
  const auto seconds = static_cast<std::time_t>(value.get<int64_t>() / 1'000'000);
  std::tm utc{};
  char text[32] = "-";
  if (gmtime_r(&seconds, &utc) != nullptr) std::strftime(text, sizeof(text), "%Y-%m-%d %H:%M:%S", &utc);
  return text;
}

}  // namespace

void print_models(std::ostream& out, const json& models) {
  out << formatted("%-20s %-6s %11s %7s %-9s %5s  %-19s  %s\n", "model", "active", "diameter mm", "points",
                   "symmetric", "holes", "registered (UTC)", "file");
  if (!models.is_array()) return;
  for (const json& model : models)
    out << formatted("%-20.20s %-6.6s %11s %7s %-9.9s %5s  %-19s  ", text_of(model, "name").c_str(),
                     text_of(model, "active").c_str(), number_of(model, "diameter", 1e3, 1).c_str(),
                     number_of(model, "points", 1, 0).c_str(), text_of(model, "symmetric").c_str(),
                     text_of(model, "plan").c_str(), date_of(model, "registered_utime").c_str())
        << text_of(model, "file") << '\n';
  if (models.empty()) out << "none; edgepose models add MESH makes one\n";
}

void print_model(std::ostream& out, const json& model) {
  const auto say = [&](const char* label, const std::string& text) {
    if (text != "-") out << formatted("%-12s ", label) << text << '\n';
  };
  say("model", text_of(model, "name"));
  say("active", text_of(model, "active"));
  say("diameter",
      number_of(model, "diameter", 1e3, 2) == "-" ? "-" : number_of(model, "diameter", 1e3, 2) + " mm");
  say("points", number_of(model, "points", 1, 0));
  say("symmetric", text_of(model, "symmetric"));
  say("holes", text_of(model, "plan"));
  say("targets", text_of(model, "plan_targets"));
  say("registered",
      date_of(model, "registered_utime") == "-" ? "-" : date_of(model, "registered_utime") + " UTC");
  say("hash", text_of(model, "content_hash"));
  say("mesh", text_of(model, "mesh"));
  say("file", text_of(model, "file"));
  say("bytes", number_of(model, "file_bytes", 1, 0));
  const std::string trained = number_of(model, "training_seconds", 1, 1);
  say("training", trained == "-" ? "-" : trained + " s");
  const json& notes = member(model, "notes");
  if (!notes.is_array()) return say("note", text_of(model, "notes"));
  for (const json& note : notes) say("note", text_of(json{{"note", note}}, "note"));
}

}  // namespace edgepose
