#include "demo/run_track.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "demo/csv_table.h"

namespace edgepose {
namespace {

constexpr double kSpacing = 0.02;  // [s]

/// Columns NAME1 to NAME6 of a row.
std::array<double, 6> six(const CsvTable& table, size_t row, const std::string& name) {
  std::array<double, 6> values{};
  const size_t first = table.column(name + "1");
  for (size_t i = 0; i < 6; ++i) values[i] = table.number(row, first + i);
  if (table.column(name + "6") != first + 5)
    throw InputError("log: the columns " + name + " are not in order");
  return values;
}

/// Rows from `begin_ns` to `end_ns`, about kSpacing apart, and the last of them.
std::vector<size_t> chosen_rows(const CsvTable& table, double begin_ns, double end_ns) {
  const size_t time = table.column("time_ns");
  std::vector<size_t> rows;
  double next = begin_ns;
  size_t last = table.rows();
  for (size_t row = 0; row < table.rows(); ++row) {
    const double now = table.number(row, time);
    if (!(now >= begin_ns && now <= end_ns)) continue;
    last = row;
    if (now < next) continue;
    rows.push_back(row);
    next = now + 1e9 * kSpacing;
  }
  if (last < table.rows() && rows.back() != last) rows.push_back(last);
  return rows;
}

double set_out_ns(const CsvTable& control, const std::string& file) {
  const size_t state = control.column("state"), time = control.column("time_ns");
  for (size_t row = 0; row < control.rows(); ++row)
    if (control.text(row, state) == "approaching") return control.number(row, time);
  throw InputError::at(file, "an arm that set out", "none");
}

template <class Point>
const Point& nearest(const std::vector<Point>& points, double time) {
  const auto after = std::lower_bound(points.begin(), points.end(), time,
                                      [](const Point& point, double t) { return point.time < t; });
  if (after == points.end()) return points.back();
  if (after == points.begin()) return *after;
  const auto before = std::prev(after);
  return time - before->time < after->time - time ? *before : *after;
}

}  // namespace

double TruthPoint::distance() const { return std::hypot(along, across); }

const ControlPoint& RunTrack::control_at(double time) const { return nearest(control, time); }
const TruthPoint& RunTrack::truth_at(double time) const { return nearest(truth, time); }

double RunTrack::seen_last() const {
  const auto found = std::find_if(control.rbegin(), control.rend(),
                                  [](const ControlPoint& point) { return point.goal_seen; });
  return found == control.rend() ? end() : found->time;
}

double RunTrack::converged() const {
  const auto found = std::find_if(control.begin(), control.end(),
                                  [](const ControlPoint& point) { return point.state == "converged"; });
  return found == control.end() ? -1 : found->time;
}

RunTrack read_track(const std::filesystem::path& control_log, const std::filesystem::path& truth_log,
                    int64_t end_ns) {
  const CsvTable control(control_log), truth(truth_log);
  const double begin = set_out_ns(control, control_log.filename()), end = static_cast<double>(end_ns);
  const auto seconds = [&](const CsvTable& table, size_t row) {
    return 1e-9 * (table.number(row, table.column("time_ns")) - begin);
  };
  RunTrack track;
  for (const size_t row : chosen_rows(control, begin, end)) {
    const auto value = [&](const char* name) { return control.number(row, control.column(name)); };
    track.control.push_back({seconds(control, row), std::string(control.text(row, control.column("state"))),
                             value("goal_seen") != 0, value("tool_error_m"), value("tool_angle_rad"),
                             value("standoff_m"), six(control, row, "feature"),
                             six(control, row, "camera_velocity")});
  }
  for (const size_t row : chosen_rows(truth, begin, end)) {
    const auto value = [&](const char* name) { return truth.number(row, truth.column(name)); };
    const std::array<double, 6> q = six(truth, row, "q");
    track.truth.push_back({seconds(truth, row), JointVector(q.data()), value("along_m"), value("across_m"),
                           value("angle_rad")});
  }
  if (track.control.empty() || track.truth.empty())
    throw InputError::at(truth_log.filename(), "the arm's way", "nothing of that time");
  return track;
}

}  // namespace edgepose
