#include "files/uwa_names.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "common/error.h"
#include "files/text_cursor.h"

namespace edgepose {
namespace {

namespace fs = std::filesystem;
using Paths = std::vector<fs::path>;

/// Lower case without punctuation: "T-rex_high" -> "trexhigh".
std::string plain(std::string_view name) {
  std::string result = lower_case(name);
  std::erase_if(result, [](char c) { return !(c >= 'a' && c <= 'z') && !(c >= '0' && c <= '9'); });
  return result;
}

template <typename Accept>
Paths select(const Paths& plys, Accept accept) {
  Paths chosen;
  std::copy_if(plys.begin(), plys.end(), std::back_inserter(chosen),
               [&](const fs::path& ply) { return accept(ply.stem().string()); });
  return chosen;
}

/// If several remain: those whose folder has `hint` in its name, if there are any.
Paths prefer_folder(const Paths& candidates, std::string_view hint) {
  if (candidates.size() < 2) return candidates;
  Paths chosen;
  for (const fs::path& path : candidates)
    if (lower_case(path.parent_path().filename().string()).find(hint) != std::string::npos)
      chosen.push_back(path);
  return chosen.empty() ? candidates : chosen;
}

Paths scenes_named(const Paths& plys, std::string_view name) {
  return prefer_folder(
      select(plys, [&](const std::string& stem) { return lower_case(stem) == lower_case(name); }), "scene");
}

Paths models_named(const Paths& plys, std::string_view name) {
  const std::string wanted = plain(name);
  if (wanted.empty()) return {};
  Paths exact = select(plys, [&](const std::string& stem) { return plain(stem) == wanted; });
  if (!exact.empty()) return prefer_folder(exact, "model");
  return prefer_folder(select(plys, [&](const std::string& stem) { return plain(stem).starts_with(wanted); }),
                       "model");
}

const fs::path& the_only_one(const Paths& candidates, const std::string& where, const std::string& expected) {
  if (candidates.empty()) throw InputError::at(where, expected, "none");
  if (candidates.size() > 1)
    throw InputError::at(where, expected,
                         "several: " + candidates[0].string() + " and " + candidates[1].string(),
                         "leave one of them in the folder");
  return candidates.front();
}

UwaTruthFile match_one(const fs::path& truth, const Paths& plys) {
  const std::string stem = truth.stem().string();
  // Object names may have hyphens, too (T-rex-rs1): the scene is what a PLY exists for, from the right.
  for (size_t hyphen = stem.rfind('-'); hyphen != std::string::npos && hyphen > 0;
       hyphen = stem.rfind('-', hyphen - 1)) {
    const std::string object = stem.substr(0, hyphen), scene = stem.substr(hyphen + 1);
    const Paths scenes = scenes_named(plys, scene);
    if (scenes.empty()) continue;
    const fs::path& scene_ply =
        the_only_one(scenes, truth.string(), "one PLY of the scene " + edgepose::quoted(scene));
    Paths models = models_named(plys, object);
    std::erase(models, scene_ply);
    return {truth, the_only_one(models, truth.string(), "one PLY of the model " + edgepose::quoted(object)),
            scene_ply};
  }
  throw InputError::at(truth.string(), "a name <object>-<scene>.xf with <scene>.ply in the test set",
                       "no PLY of that scene among " + std::to_string(plys.size()));
}

}  // namespace

std::vector<UwaTruthFile> match_uwa_names(const Paths& truths, const Paths& plys) {
  std::vector<UwaTruthFile> matched;
  for (const fs::path& truth : truths) matched.push_back(match_one(truth, plys));
  return matched;
}

}  // namespace edgepose
