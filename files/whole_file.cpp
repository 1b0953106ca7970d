#include "files/whole_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "common/error.h"
#include "files/regular_file.h"

namespace edgepose {

std::string read_whole_file(const std::filesystem::path& path, const std::string& what, size_t max_bytes) {
  const RegularFile file(path, what);
  if (file.size() > max_bytes)
    throw InputError::at(path.string(), what + " of at most " + std::to_string(max_bytes) + " bytes",
                         std::to_string(file.size()) + " bytes");
  std::string bytes(file.size(), '\0');
  size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t count = read(file.descriptor(), bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw InputError::at(path.string(), what, RegularFile::last_error());
    if (count == 0) break;  // somebody shortens the file while we read it: the parser sees a truncated one
    done += static_cast<size_t>(count);
  }
  bytes.resize(done);
  return bytes;
}

}  // namespace edgepose
