#include "evaluation/plot_script.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace edgepose {
namespace {

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

void write_curves(std::ostream& out, const Plot& plot, const std::string& block) {
  for (size_t k = 0; k < plot.series.size(); ++k) {
    const Series& s = plot.series[k];
    out << block << k << " << END\n";
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
    out << (k ? ", " : "") << block << k << " using 1:2 with "
        << (plot.series[k].marks ? "points pt 7 ps 2" : style)
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

std::string size_text(int width, int height) {
  return "set terminal pngcairo noenhanced size " + std::to_string(width) + "," + std::to_string(height) +
         " font 'Sans,13' background '#ffffff'\n";
}

std::string y_range(const Plot& plot) {
  if (plot.y_percent) return "set yrange [0:105]\nset ytics 10\n";
  if (plot.log_y) return "set logscale y\nset format y '%g'\nset yrange [*:*]\n";
  return plot.y_any ? "set yrange [*:*]\n" : "set yrange [0:*]\n";
}

/// Both axes as long as the values of the longer one, and a tenth more.
std::string square_ranges(const Plot& plot) {
  std::array<double, 2> least{INFINITY, INFINITY}, most{-INFINITY, -INFINITY};
  const auto extend = [&](size_t axis, const std::vector<double>& values) {
    for (const double value : values) {
      least[axis] = std::min(least[axis], value);
      most[axis] = std::max(most[axis], value);
    }
  };
  for (const Series& series : plot.series) extend(0, series.x), extend(1, series.y);
  const double half = 0.55 * std::max(most[0] - least[0], most[1] - least[1]);
  if (!(half > 0 && std::isfinite(half))) return "";
  const auto range = [&](const char* axis, size_t i) {
    const double middle = (least[i] + most[i]) / 2;
    return std::string("set ") + axis + "range [" + number(middle - half) + ":" + number(middle + half) +
           "]\n";
  };
  return range("x", 0) + range("y", 1);
}

/// Title, axes and range of one plot, in the order in which gnuplot wants them.
void write_axes(std::ostream& out, const Plot& plot) {
  out << "set title '" << harmless_text(plot.title) << "'\nset xlabel '" << harmless_text(plot.x_label)
      << "'\nset ylabel '" << harmless_text(plot.y_label) << "'\n"
      << "set grid ytics lt 1 lw 1 lc rgb '#d8d8d8'\nset border 3\n"
      << "set tics nomirror\nset key above\n"
      << colours() << y_range(plot) << (plot.log_x ? "set logscale x\n" : "");
  if (plot.to_scale)
    out << square_ranges(plot) << "set size ratio -1\nset grid xtics lt 1 lw 1 lc rgb '#d8d8d8'\n";
}

}  // namespace

std::string plot_script(const Plot& plot) {
  std::ostringstream out;
  out << "# gnuplot " << harmless_text(plot.file) << ".gp > " << harmless_text(plot.file) << ".png\n"
      << size_text(960, 600);
  write_axes(out, plot);
  const bool bars = plot.kind == Plot::Kind::kBars || plot.kind == Plot::Kind::kStackedBars;
  bars ? write_bars(out, plot) : write_curves(out, plot, "$data");
  return out.str();
}

std::string plot_script(const Figure& figure) {
  std::ostringstream out;
  const auto columns = static_cast<size_t>(std::max(1, figure.columns));
  const size_t rows = (figure.panels.size() + columns - 1) / columns;
  out << "# gnuplot " << harmless_text(figure.file) << ".gp > " << harmless_text(figure.file) << ".png\n"
      << size_text(figure.width, figure.height) << "set multiplot layout " << rows << "," << columns
      << " title \"" << harmless_text(figure.title) << "\\n\"\n";  // an empty line below
  for (size_t i = 0; i < figure.panels.size(); ++i) {
    out << "unset logscale\nunset format\n";
    write_axes(out, figure.panels[i]);
    write_curves(out, figure.panels[i], "$data" + std::to_string(i) + "_");
  }
  out << "unset multiplot\n";
  return out.str();
}

}  // namespace edgepose
