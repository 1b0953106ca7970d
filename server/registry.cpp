#include "server/registry.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <regex>
#include <set>

#include "common/error.h"
#include "daemon/clock.h"
#include "files/model_file.h"
#include "matcher/model_block.h"

namespace edgepose {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxModels = 200;  // as many answers as fit into a message, and some

ManifestEntry entry_of(const RegisteredModel& m) {
  return {m.name, m.file, m.plan_file, m.mesh, m.active, m.registered_utime};
}

std::string hex(uint64_t value) {
  std::string text(16, '0');
  for (size_t i = 16; i-- > 0; value >>= 4) text[i] = "0123456789abcdef"[value & 15];
  return text;
}

void make_folder(const fs::path& folder) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure)
    throw InputError::at(folder.string(), "a folder that the daemon may write (service.state_folder)",
                         failure.message());
}

/// The renames in it are on the disk from then on.
void flush_folder(const fs::path& folder) {
  const int descriptor = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  const bool flushed = descriptor >= 0 && fsync(descriptor) == 0;
  if (descriptor >= 0) close(descriptor);
  if (!flushed) throw InputError::at(folder.string(), "a folder that can be flushed", std::strerror(errno));
}

/// Held as long as the process lives.
int lock_folder(const fs::path& folder) {
  const fs::path file = folder / "lock";
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
  if (descriptor < 0)
    throw InputError::at(file.string(), "a folder that the daemon may write (service.state_folder)",
                         std::strerror(errno));
  if (flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
    close(descriptor);
    throw InputError::at(folder.string(), "a state folder of its own", "another edgeposed that uses it",
                         "stop that one, or set service.state_folder");
  }
  return descriptor;
}

}  // namespace

Registry::Registry(const fs::path& folder) : folder_(folder) {
  make_folder(folder_);
  lock_ = lock_folder(folder_);
  try {
    fs::remove_all(incoming());  // of registrations that were cut off
    make_folder(incoming());
    load_all();
    remove_orphans();
  } catch (...) {
    close(lock_);
    throw;
  }
}

Registry::~Registry() { close(lock_); }

ModelList Registry::all() const {
  const std::scoped_lock lock(mutex_);
  return models_;
}

std::vector<BrokenModel> Registry::broken() const {
  const std::scoped_lock lock(mutex_);
  return broken_;
}

ModelList Registry::active() const {
  ModelList list = all();
  std::erase_if(list, [](const ModelHandle& model) { return !model->active; });
  return list;
}

ModelHandle Registry::find(const std::string& name) const {
  for (const ModelHandle& model : all())
    if (model->name == name) return model;
  return nullptr;
}

std::vector<std::string> Registry::names() const {
  std::vector<std::string> names;
  for (const ModelHandle& model : all()) names.push_back(model->name);
  for (const BrokenModel& model : broken()) names.push_back(model.entry.name);
  return names;
}

ModelHandle Registry::add(const PreparedModel& prepared) {
  const std::scoped_lock change(change_);
  if (const std::string fault = name_fault(prepared.name); !fault.empty()) throw InputError(fault);
  // Names that hold the content: an old file that is still named by the old registry is never overwritten.
  const int64_t now = utime_now();
  const Model model = load_model(prepared.model);
  const std::string stem =
      prepared.name + "-" + hex(model.view().header->checksum) + "-" + std::to_string(now);
  ManifestEntry entry{prepared.name, stem + ".model", prepared.plan.empty() ? "" : stem + ".plan.json",
                      prepared.mesh, prepared.active, now};
  ModelHandle added;
  try {
    fs::rename(prepared.model, folder_ / entry.file);
    if (!prepared.plan.empty()) fs::rename(prepared.plan, folder_ / entry.plan_file);
    added = load(entry);
    ModelList next = all();
    std::vector<BrokenModel> next_broken = broken();
    std::erase_if(next, [&](const ModelHandle& known) { return known->name == entry.name; });
    std::erase_if(next_broken, [&](const BrokenModel& known) { return known.entry.name == entry.name; });
    next.push_back(added);
    if (next.size() + next_broken.size() > kMaxModels)
      throw InputError::at("models", "at most " + std::to_string(kMaxModels), "one more",
                           "unregister another first");
    store(std::move(next), std::move(next_broken));
  } catch (const std::exception& error) {
    std::error_code ignored;
    for (const fs::path& file :
         {fs::path(prepared.model), prepared.plan, folder_ / entry.file, folder_ / entry.plan_file})
      if (fs::is_regular_file(file, ignored)) fs::remove(file, ignored);
    throw InputError(error.what());
  }
  return added;
}

bool Registry::remove(const std::string& name) {
  const std::scoped_lock change(change_);
  ModelList next = all();
  std::vector<BrokenModel> next_broken = broken();
  const size_t removed =
      std::erase_if(next, [&](const ModelHandle& known) { return known->name == name; }) +
      std::erase_if(next_broken, [&](const BrokenModel& known) { return known.entry.name == name; });
  if (removed == 0) return false;
  store(std::move(next), std::move(next_broken));
  return true;
}

ModelHandle Registry::activate(const std::string& name, bool active) {
  const std::scoped_lock change(change_);
  ModelList next = all();
  const auto known =
      std::find_if(next.begin(), next.end(), [&](const ModelHandle& model) { return model->name == name; });
  if (known == next.end()) return nullptr;
  auto changed = std::make_shared<RegisteredModel>(**known);
  changed->active = active;
  *known = changed;
  store(std::move(next), broken());
  return changed;
}

void Registry::load_all() {
  for (const ManifestEntry& entry : read_manifest(folder_ / "registry.json")) {
    try {
      models_.push_back(load(entry));
    } catch (const InputError& error) {
      broken_.push_back({entry, error.what()});
    }
  }
}

ModelHandle Registry::load(const ManifestEntry& entry) const {
  const fs::path plan_path = folder_ / entry.plan_file;
  RegisteredModel loaded{entry.name,
                         load_model(folder_ / entry.file),
                         0,
                         std::nullopt,
                         entry.active,
                         entry.mesh,
                         entry.file,
                         entry.plan_file,
                         entry.registered_utime};
  loaded.content_hash = static_cast<int64_t>(loaded.model.view().header->checksum);
  if (!entry.plan_file.empty()) {
    loaded.plan = read_drill_plan(plan_path);
    check_drill_plan(*loaded.plan, loaded.model.centre(), loaded.model.diameter(), plan_path.string());
  }
  return std::make_shared<const RegisteredModel>(std::move(loaded));
}

/// The disk first: what the registry says it knows survives a restart, and a power cut.
void Registry::store(ModelList next, std::vector<BrokenModel> next_broken) {
  std::vector<ManifestEntry> entries;
  for (const ModelHandle& model : next) entries.push_back(entry_of(*model));
  for (const BrokenModel& model : next_broken) entries.push_back(model.entry);
  write_manifest(folder_ / "registry.json", entries);
  flush_folder(folder_);
  {
    const std::scoped_lock lock(mutex_);
    models_ = std::move(next);
    broken_ = std::move(next_broken);
  }
  remove_orphans();
}

/// Files of models that are no longer registered, and of registrations that were cut off. Programs that have
/// them mapped keep them.
void Registry::remove_orphans() const {
  std::set<std::string> known;
  for (const ModelHandle& model : all()) known.insert({model->file, model->plan_file});
  for (const BrokenModel& model : broken()) known.insert({model.entry.file, model.entry.plan_file});
  // As add() names them: nothing else is touched, whatever folder this is.
  static const std::regex ours(".+-[0-9a-f]{16}-[0-9]+\\.(model|plan\\.json)");
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
    const std::string name = entry.path().filename().string();
    if (std::regex_match(name, ours) && !known.contains(name)) fs::remove(entry.path(), ignored);
  }
}

}  // namespace edgepose
