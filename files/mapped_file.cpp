#include "files/mapped_file.h"

#include <sys/mman.h>

#include "common/error.h"
#include "files/regular_file.h"

namespace edgepose {

MappedFile map_file(const std::filesystem::path& path, const std::string& what) {
  const RegularFile file(path, what);
  const size_t size = file.size();
  void* address = mmap(nullptr, size, PROT_READ, MAP_SHARED, file.descriptor(), 0);
  if (address == MAP_FAILED) throw InputError::at(path.string(), what, RegularFile::last_error());
  std::shared_ptr<const void> owner(address, [size](void* mapped) { munmap(mapped, size); });
  return {{static_cast<const std::byte*>(address), size}, std::move(owner)};
}

}  // namespace edgepose
