#include "files/model_file.h"

#include <stdexcept>
#include <string>

#include "common/atomic_file.h"
#include "common/error.h"
#include "files/mapped_file.h"

namespace edgepose {

void save_model(const std::filesystem::path& path, const Model& model) {
  write_file_atomically(path, model.block());
}

Model load_model(const std::filesystem::path& path) {
  const MappedFile file = map_file(path, "a model file (made by edgepose train)");
  try {
    return Model::from_block(file.bytes, file.owner);
  } catch (const std::invalid_argument& error) {
    const std::string cause = error.what();
    const bool advised = cause.find("train") != std::string::npos;
    throw InputError(path.string() + ": " + cause +
                     (advised ? "" : "; train the model again (edgepose train)"));
  }
}

}  // namespace edgepose
