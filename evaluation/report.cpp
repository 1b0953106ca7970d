#include "evaluation/report.h"

#include "common/atomic_file.h"
#include "common/error.h"

namespace edgepose {

void make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (!std::filesystem::is_directory(folder, failure))
    throw InputError::at(folder.string(), "a folder for the report that can be made", "none",
                         "name another with --report");
}

std::string draw_all(const std::vector<Plot>& plots, const std::filesystem::path& folder,
                     std::string& warning) {
  make_folder(folder);
  if (!gnuplot_available()) {
    warning = "report: no plots, because the program gnuplot is missing; install gnuplot-nox to get them";
    return "No plots: the program gnuplot is missing.\n";
  }
  std::string markdown;
  for (const Plot& plot : plots) {
    draw(plot, folder);
    markdown += "![" + harmless_text(plot.title) + "](" + plot.file + ".png)\n\n";
  }
  return markdown;
}

std::string write_report(const EvalReport& report, const std::filesystem::path& folder) {
  std::string warning;
  const std::string pictures = draw_all(result_plots(report), folder, warning);
  write_file_atomically(folder / "report.md", "# Evaluation\n\n    " + report.command + "\n\n" +
                                                  result_tables(report) + "\n## Plots\n\n" + pictures);
  return warning;
}

}  // namespace edgepose
