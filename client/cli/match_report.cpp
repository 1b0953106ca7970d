#include "client/cli/match_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <ostream>

#include "client/cli/text.h"
#include "planning/worst_sigma.h"

namespace edgepose {
namespace {

using nlohmann::json;

void print_detection(std::ostream& out, const std::string& name, const Detection& detection, double seconds) {
  const auto shown = [](double value) { return rounded(value, 2); };
  const Eigen::Vector3d t = (1e3 * detection.camera_T_model.translation()).unaryExpr(shown);
  const Eigen::AngleAxisd turn(detection.camera_T_model.linear());
  const Eigen::Vector3d r = (kDegrees * turn.angle() * turn.axis()).unaryExpr(shown);
  const std::string edge_score = detection.edge_score ? formatted("%.2f", *detection.edge_score) : "-";
  out << formatted("%-16.16s %-5s %8.2f %8.2f %8.2f  %7.2f %7.2f %7.2f  %5.2f %5.2f %5.2f %5s %6.2f  %7.1f\n",
                   name.c_str(), detection.accepted ? "yes" : "no", t.x(), t.y(), t.z(), r.x(), r.y(), r.z(),
                   detection.score, detection.coverage, detection.violations, edge_score.c_str(),
                   shown(detection.margin), 1e3 * seconds);
}

void print_certainty(std::ostream& out, const Detection& detection) {
  const double shift = 1e3 * worst_sigma(detection.covariance.bottomRightCorner<3, 3>());
  const double turn = kDegrees * worst_sigma(detection.covariance.topLeftCorner<3, 3>());
  if (shift > 0 || turn > 0) {
    out << formatted("%-16s one sigma, worst direction: %.3f mm at the centre, %.3f degrees\n", "", shift,
                     turn);
  }
  if (!detection.equivalent.empty()) {
    out << formatted("%-16s symmetric: %zu more %s the same (--json lists %s)\n", "",
                     detection.equivalent.size(),
                     detection.equivalent.size() == 1 ? "pose looks" : "poses look",
                     detection.equivalent.size() == 1 ? "it" : "them");
  }
}

}  // namespace

void print_json(std::ostream& out, const json& report) {
  out << report.dump(2, ' ', false, json::error_handler_t::replace) << '\n';
}

void print_table(std::ostream& out, const std::vector<NamedResult>& results, const std::string& frame,
                 double preprocessing_seconds) {
  out << formatted("%-16s %-5s %26s  %23s  %5s %5s %5s %5s %6s  %7s\n", "model", "found",
                   ("position in " + frame + " [mm]").c_str(), "rotation vector [deg]", "score", "cover",
                   "viol", "S", "margin", "ms");
  for (const NamedResult& named : results) {
    const MatchResult& result = named.result;
    for (const Detection& detection : result.detections) {
      print_detection(out, named.name, detection, result.times.total());
      print_certainty(out, detection);
    }
    if (result.cut_short) out << formatted("%-16s cut short: the time was over before the search was\n", "");
    if (!named.found()) out << formatted("%-16.16s not found: ", named.name.c_str()) << result.reason << '\n';
  }
  out << formatted("preprocessing %.1f ms, shared by %zu model%s\n", 1e3 * preprocessing_seconds,
                   results.size(), results.size() == 1 ? "" : "s");
}

}  // namespace edgepose
