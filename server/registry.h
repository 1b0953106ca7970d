#pragma once
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/manifest.h"
#include "server/registered_model.h"

namespace edgepose {

/// Files that are ready to be registered; they lie in the registry's incoming() folder.
struct PreparedModel {
  std::string name, mesh;
  std::filesystem::path model, plan;  ///< plan empty: none
  bool active = true;
};

/// A registered model that cannot be loaded: its files stay until it is removed or replaced.
struct BrokenModel {
  ManifestEntry entry;
  std::string fault;
};

/// The models that the daemon knows, in a folder of its own: registry.json says which files belong to which
/// name, and is replaced at once, so that a crash at any moment leaves the old state or the new one. Safe
/// from any thread; snapshots never wait for disk.
class Registry {
 public:
  /// Loads what is registered (tables are memory-mapped) and removes what nobody names. A model whose files
  /// are damaged is left out, see broken(). Throws InputError if the folder or registry.json cannot be used,
  /// or another daemon uses it.
  explicit Registry(const std::filesystem::path& folder);
  Registry(const Registry&) = delete;
  Registry& operator=(const Registry&) = delete;
  ~Registry();

  ModelList all() const;
  ModelList active() const;
  std::vector<BrokenModel> broken() const;
  ModelHandle find(const std::string& name) const;  ///< nullptr: no such model
  std::vector<std::string> names() const;           ///< of broken ones too

  /// Where files are prepared: the same file system, so that a rename moves them.
  std::filesystem::path incoming() const { return folder_ / "incoming"; }
  /// Takes over the files; replaces a model of that name. Throws InputError if they do not load or cannot be
  /// stored; then everything is as before.
  ModelHandle add(const PreparedModel& prepared);
  /// False if there is no such model.
  bool remove(const std::string& name);
  ModelHandle activate(const std::string& name, bool active);  ///< nullptr: no such model

 private:
  void load_all();
  ModelHandle load(const ManifestEntry& entry) const;
  void store(ModelList next, std::vector<BrokenModel> next_broken);
  void remove_orphans() const;

  const std::filesystem::path folder_;
  int lock_ = -1;
  std::mutex change_;         // one change at a time
  mutable std::mutex mutex_;  // guards models_
  ModelList models_;
  std::vector<BrokenModel> broken_;  // guarded by mutex_
};

}  // namespace edgepose
