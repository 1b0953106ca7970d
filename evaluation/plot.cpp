#include "evaluation/plot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "common/error.h"

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

std::string number(double value) {
  if (!std::isfinite(value)) return "NaN";  // gnuplot leaves such points out
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

/// The data as a gnuplot data block: x or label, then one column for every series.
void write_bars(std::ostream& out, const Plot& plot) {
  out << "$data << END\n";
  for (size_t i = 0; i < plot.labels.size(); ++i) {
    out << '"' << harmless_text(plot.labels[i]) << '"';
    for (const Series& s : plot.series) out << ' ' << (i < s.y.size() ? number(s.y[i]) : "NaN");
    out << '\n';
  }
  out << "END\nset style data histograms\nset style fill solid 0.85 border -1\nset boxwidth 0.9\n"
      << (plot.kind == Plot::Kind::kStackedBars ? "set style histogram rowstacked\n"
                                                : "set style histogram clustered gap 1\n");
  size_t longest = 0;
  for (const std::string& label : plot.labels) longest = std::max(longest, label.size());
  if (longest * plot.labels.size() > 80) out << "set xtics rotate by -30\n";
  out << "plot ";
  for (size_t i = 0; i < plot.series.size(); ++i) {
    out << (i ? ", " : "") << "$data using " << i + 2 << ":xtic(1) ";
    if (plot.series[i].name.empty())
      out << "notitle";
    else
      out << "title '" << harmless_text(plot.series[i].name) << "'";
  }
  out << '\n';
}

void write_curves(std::ostream& out, const Plot& plot) {
  for (size_t k = 0; k < plot.series.size(); ++k) {
    const Series& s = plot.series[k];
    out << "$data" << k << " << END\n";
    for (size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i)
      out << number(s.x[i]) << ' ' << number(s.y[i]) << '\n';
    out << "END\n";
  }
  const char* style = plot.kind == Plot::Kind::kSteps       ? "steps"
                      : plot.kind == Plot::Kind::kPoints    ? "linespoints"
                      : plot.kind == Plot::Kind::kHistogram ? "boxes"
                                                            : "lines";
  if (plot.kind == Plot::Kind::kHistogram && plot.series[0].x.size() > 1)
    out << "set style fill solid 0.85 border -1\nset xrange [0:*]\nset boxwidth "
        << number(plot.series[0].x[1] - plot.series[0].x[0]) << '\n';
  out << "plot ";
  for (size_t k = 0; k < plot.series.size(); ++k) {
    out << (k ? ", " : "") << "$data" << k << " using 1:2 with " << style
        << (plot.series[k].bold ? " lw 4 lc rgb '#000000'" : " lw 2");
    if (plot.series[k].name.empty())
      out << " notitle";
    else
      out << " title '" << harmless_text(plot.series[k].name) << "'";
  }
  out << '\n';
}

/// Ten that can be told apart; further curves repeat them dashed.
std::string colours() {
  constexpr const char* kColours[] = {"#1f6fb4", "#e08214", "#2b8a3e", "#b5292a", "#7a4fa3",
                                      "#17a2b8", "#d6539b", "#8a6d3b", "#7f7f7f", "#a5b800"};
  constexpr int kCount = static_cast<int>(std::size(kColours));
  std::string text;
  for (int i = 0; i < 2 * kCount; ++i) {
    text.append("set linetype ")
        .append(std::to_string(i + 1))
        .append(" lc rgb '")
        .append(kColours[i % kCount]);
    text.append(i < kCount ? "' dt 1\n" : "' dt 2\n");
  }
  return text;
}

std::string script_of(const Plot& plot) {
  std::ostringstream out;
  out << "# gnuplot " << harmless_text(plot.file) << ".gp > " << harmless_text(plot.file) << ".png\n"
      << "set terminal pngcairo noenhanced size 960,600 font 'Sans,13' background '#ffffff'\n"
      << "set title '" << harmless_text(plot.title) << "'\nset xlabel '" << harmless_text(plot.x_label)
      << "'\nset ylabel '" << harmless_text(plot.y_label) << "'\n"
      << "set grid ytics lt 1 lw 1 lc rgb '#d8d8d8'\nset border 3\n"
      << "set tics nomirror\nset key above\n"
      << colours() << (plot.y_percent ? "set yrange [0:105]\nset ytics 10\n" : "set yrange [0:*]\n")
      << (plot.log_x ? "set logscale x\n" : "");
  const bool bars = plot.kind == Plot::Kind::kBars || plot.kind == Plot::Kind::kStackedBars;
  bars ? write_bars(out, plot) : write_curves(out, plot);
  return out.str();
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
  const std::filesystem::path picture = folder / (plot.file + ".png");
  const std::filesystem::path script = files.add(folder / (plot.file + ".gp"), script_of(plot));
  std::string png;
  const int code = run_gnuplot(std::filesystem::absolute(script).string(), png);
  if (code != 0 || !png.starts_with("\x89PNG"))
    throw InputError::at(picture.string(), "gnuplot to draw it", "exit code " + std::to_string(code),
                         "install gnuplot-nox");
  files.add(picture, png);
}

}  // namespace edgepose
