#include "evaluation/plot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>

#include "common/error.h"
#include "evaluation/plot_script.h"

extern char** environ;

namespace edgepose {
namespace {

constexpr int kNotFound = 127;  // what a shell says when there is no such program

/// Runs `gnuplot argument` without a shell and returns its exit code; `output` takes what it prints.
int run_gnuplot(const std::string& argument, std::string& output) {
  int pipe_ends[2];
  if (pipe(pipe_ends) != 0) return kNotFound;
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_addclose(&actions, pipe_ends[0]);
  posix_spawn_file_actions_addclose(&actions, pipe_ends[1]);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  std::string program = "gnuplot", copy = argument;
  char* arguments[] = {program.data(), copy.data(), nullptr};
  pid_t child = 0;
  const int spawned = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  close(pipe_ends[1]);
  if (spawned == 0) {
    char buffer[65536];
    for (ssize_t n; (n = read(pipe_ends[0], buffer, sizeof buffer)) != 0;) {
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) break;
      output.append(buffer, static_cast<size_t>(n));
    }
  }
  close(pipe_ends[0]);
  if (spawned != 0) return kNotFound;
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : kNotFound;
}

void draw_script(const std::string& text, const std::string& name, const std::filesystem::path& folder,
                 FileGroup& files) {
  const std::filesystem::path picture = folder / (name + ".png");
  const std::filesystem::path script = files.add(folder / (name + ".gp"), text);
  std::string png;
  const int code = run_gnuplot(std::filesystem::absolute(script).string(), png);
  if (code != 0 || !png.starts_with("\x89PNG"))
    throw InputError::at(picture.string(), "gnuplot to draw it", "exit code " + std::to_string(code),
                         "install gnuplot-nox");
  files.add(picture, png);
}

}  // namespace

std::string harmless_text(const std::string& text) {
  std::string clean;
  for (char c : text.substr(0, 120)) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    clean += plain || std::string(" _-.,:;()[]/+=<>%").find(c) != std::string::npos ? c : '?';
  }
  return clean;
}

bool gnuplot_available() {
  std::string version;
  return run_gnuplot("--version", version) == 0;
}

void draw(const Plot& plot, const std::filesystem::path& folder, FileGroup& files) {
  draw_script(plot_script(plot), plot.file, folder, files);
}

void draw(const Figure& figure, const std::filesystem::path& folder, FileGroup& files) {
  draw_script(plot_script(figure), figure.file, folder, files);
}

}  // namespace edgepose
