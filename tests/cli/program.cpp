#include "tests/cli/program.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <sstream>

extern char** environ;

namespace edgepose::test {
namespace {

std::filesystem::path fresh_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "edgepose_cli_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
  return name;
}

/// The eight corners and twelve triangles of a box, appended.
void add_box(const std::array<double, 3>& low, const std::array<double, 3>& high,
             std::ostringstream& vertices, std::ostringstream& faces, int first) {
  for (int corner = 0; corner < 8; ++corner) {
    for (size_t axis = 0; axis < 3; ++axis) {
      vertices << ((corner >> axis & 1) != 0 ? high[axis] : low[axis]) << (axis == 2 ? '\n' : ' ');
    }
  }
  constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& f : kFaces) {
    faces << "3 " << first + f[0] << ' ' << first + f[1] << ' ' << first + f[2] << '\n';
    faces << "3 " << first + f[0] << ' ' << first + f[2] << ' ' << first + f[3] << '\n';
  }
}

}  // namespace

Finished edgepose(const std::vector<std::string>& arguments, const std::string& output) {
  const Folder folder;
  const std::string out = folder / "out", err = folder / "err";
  std::string program = std::string(EDGEPOSE_PROGRAM_DIR) + "/edgepose";
  std::vector<std::string> copies = arguments;
  std::vector<char*> argv = {program.data()};
  for (std::string& argument : copies) argv.push_back(argument.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  if (output.empty())
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT, 0600);
  else
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT, 0600);
  pid_t child = 0;
  const int failed = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) {
    ADD_FAILURE() << "cannot run " << program << ": build the target edgepose first";
    return {};
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(out), read_file(err)};
}

void expect_refused(const Finished& run, const std::vector<std::string>& words) {
  EXPECT_EQ(run.code, 2) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, testing::StartsWith("edgepose: "));
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  for (const std::string& word : words) EXPECT_THAT(run.err, testing::HasSubstr(word));
}

Folder::Folder() : path_(fresh_folder()) {}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string Folder::write(const std::string& name, const std::string& content) const {
  std::ofstream(path_ / name, std::ios::binary) << content;
  return *this / name;
}

std::vector<std::string> Folder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

std::string read_file(const std::filesystem::path& path) {
  std::ostringstream content;
  content << std::ifstream(path, std::ios::binary).rdbuf();
  return content.str();
}

std::string bracket_ply(double size) {
  std::ostringstream vertices, faces;
  add_box({0, 0, 0}, {size, 0.5 * size, 0.2 * size}, vertices, faces, 0);
  add_box({0, 0, 0.2 * size}, {0.2 * size, 0.35 * size, 0.7 * size}, vertices, faces, 8);
  return "ply\nformat ascii 1.0\nelement vertex 16\nproperty float x\nproperty float y\nproperty float z\n"
         "element face 24\nproperty list uchar int vertex_indices\nend_header\n" +
         vertices.str() + faces.str();
}

const std::string& phantom_model() {
  static const Folder folder;
  static const std::string path = [] {
    std::string model = folder / "phantom.model";
    const Finished run =
        edgepose({"train", phantom_file("phantom.ply"), "-o", model, "--name", "vertebra_phantom"});
    EXPECT_EQ(run.code, 0) << run.err;
    return model;
  }();
  return path;
}

std::string phantom_file(const std::string& name) {
  return (std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models" / "phantom" / name).string();
}

}  // namespace edgepose::test
