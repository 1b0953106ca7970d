#include "evaluation/report.h"

namespace edgepose {

std::string draw_all(const std::vector<Plot>& plots, const std::filesystem::path& folder, FileGroup& files,
                     std::string& warning) {
  files.make_folder(folder);
  if (!gnuplot_available()) {
    warning = "report: no plots, because the program gnuplot is missing; install gnuplot-nox to get them";
    return "No plots: the program gnuplot is missing.\n";
  }
  std::string markdown;
  for (const Plot& plot : plots) {
    draw(plot, folder, files);
    markdown += "![" + harmless_text(plot.title) + "](" + plot.file + ".png)\n\n";
  }
  return markdown;
}

std::string write_report(const EvalReport& report, const std::filesystem::path& folder) {
  std::string warning;
  FileGroup files;
  const std::string pictures = draw_all(result_plots(report), folder, files, warning);
  files.add(folder / "report.md", "# Evaluation\n\n    " + report.command + "\n\n" + result_tables(report) +
                                      "\n## Plots\n\n" + pictures);
  files.commit();
  return warning;
}

}  // namespace edgepose
