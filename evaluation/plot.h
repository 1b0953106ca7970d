#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "common/atomic_file.h"

namespace edgepose {

/// One line, or one group of bars, of a plot.
struct Series {
  std::string name;
  std::vector<double> x;  ///< centres of equal bins for a histogram; empty for bars: then
                          ///< value i stands over label i
  std::vector<double> y;
  bool bold = false;   ///< thick and black: the sum of the others
  bool marks = false;  ///< large dots instead of a line
};

struct Plot {
  enum class Kind { kLines, kSteps, kPoints, kHistogram, kBars, kStackedBars };
  Kind kind = Kind::kLines;
  std::string file;  ///< without folder and ending
  std::string title, x_label, y_label;
  std::vector<std::string> labels = {};  ///< of the bars
  std::vector<Series> series = {};
  bool y_percent = false;  ///< y runs from 0 to 105 %
  bool log_x = false, log_y = false;
  bool y_any = false;     ///< y runs over the values; else from 0, or, if logarithmic, over whole decades
  bool to_scale = false;  ///< a unit of x is as long as one of y
};

/// Several curves' plots in one picture, row by row. `file` and `title` are the picture's; of the panels only
/// the titles count.
struct Figure {
  std::string file, title;
  std::vector<Plot> panels;
  int columns = 1;
  int width = 960, height = 600;  ///< [pixels]
};

/// Is gnuplot on the PATH?
bool gnuplot_available();

/// Draws FOLDER/FILE.png with gnuplot and adds it to `files`, with FOLDER/FILE.gp, the script with its data,
/// so that the plot can be redrawn in another style. Throws InputError if gnuplot fails.
void draw(const Plot& plot, const std::filesystem::path& folder, FileGroup& files);
void draw(const Figure& figure, const std::filesystem::path& folder, FileGroup& files);

/// `text` without what Markdown tables or gnuplot would take for syntax. Names come from foreign files, and
/// gnuplot runs what stands between backquotes.
std::string harmless_text(const std::string& text);

}  // namespace edgepose
