#pragma once
#include <string>

#include "evaluation/plot.h"

namespace edgepose {

/// What gnuplot is to draw, data included. Prints a PNG.
std::string plot_script(const Plot& plot);
std::string plot_script(const Figure& figure);

}  // namespace edgepose
