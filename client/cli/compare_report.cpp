#include "client/cli/compare_report.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <ostream>

#include "client/cli/text.h"
#include "common/error.h"
#include "evaluation/statistics.h"

namespace edgepose {
namespace {

using nlohmann::json;

double largest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::max_element(values.begin(), values.end());
}

json spread(const std::vector<double>& values) {
  return {{"median", median(values)}, {"max", largest(values)}};
}

double share(size_t count, size_t of) {
  return of == 0 ? 0 : static_cast<double>(count) / static_cast<double>(of);
}

}  // namespace

void print_table(std::ostream& out, const Comparison& comparison) {
  out << formatted("%-20s %7s %6s %9s %6s %6s  %10s %10s  %10s %10s\n", "model", "answers", "found",
                   "bit-equal", "only A", "only B", "median mm", "max mm", "median deg", "max deg");
  for (const auto& [name, m] : comparison.models)
    out << formatted("%-20.20s %7zu %6zu %9zu %6zu %6zu  %10.6f %10.6f  %10.6f %10.6f\n",
                     one_line(name).c_str(), m.answers, m.poses, m.bit_equal, m.only_a, m.only_b,
                     1e3 * median(m.translation), 1e3 * largest(m.translation), kDegrees * median(m.rotation),
                     kDegrees * largest(m.rotation));
  out << "answers: " << comparison.answers << " in both, " << comparison.only_a << " only in A, "
      << comparison.only_b << " only in B\n";
  if (comparison.cut_short_a + comparison.cut_short_b > 0)
    out << "cut short by the daemon's deadline: " << comparison.cut_short_a << " in A, "
        << comparison.cut_short_b << " in B; such answers depend on how fast it was\n";
}

void print_table(std::ostream& out, const TruthComparison& comparison) {
  out << formatted("%-20s %9s %6s %6s %9s %9s  %9s %9s  %9s %9s  %10s %10s\n", "model", "instances", "found",
                   "extra", "in 0.05 d", "in 0.1 d", "median mm", "max mm", "med. deg", "max deg",
                   "median ADD", "max ADD mm");
  for (const auto& [name, m] : comparison.models)
    out << formatted("%-20.20s %9zu %6zu %6zu %7.1f %% %7.1f %%  %9.3f %9.3f  %9.3f %9.3f  %10.3f %10.3f%s\n",
                     one_line(name).c_str(), m.instances, m.error.size(), m.extra,
                     100 * share(m.within(0.05), m.instances), 100 * share(m.within(0.1), m.instances),
                     1e3 * median(m.translation), 1e3 * largest(m.translation), kDegrees * median(m.rotation),
                     kDegrees * largest(m.rotation), 1e3 * median(m.error), 1e3 * largest(m.error),
                     m.symmetric ? "  (ADI': symmetric)" : "");
  out << "answers: " << comparison.answers << ", frames without one: " << comparison.unanswered << '\n';
}

json to_json(const Comparison& comparison) {
  json models = json::object();
  for (const auto& [name, m] : comparison.models)
    models[name] = {{"answers", m.answers},
                    {"found_in_both", m.poses},
                    {"bit_equal", m.bit_equal},
                    {"only_a", m.only_a},
                    {"only_b", m.only_b},
                    {"translation_m", spread(m.translation)},
                    {"rotation_rad", spread(m.rotation)}};
  return {{"answers", comparison.answers},
          {"only_a", comparison.only_a},
          {"only_b", comparison.only_b},
          {"cut_short_a", comparison.cut_short_a},
          {"cut_short_b", comparison.cut_short_b},
          {"bit_equal", comparison.is_bit_equal()},
          {"models", models}};
}

json to_json(const TruthComparison& comparison) {
  json models = json::object();
  for (const auto& [name, m] : comparison.models)
    models[name] = {{"diameter_m", m.diameter},
                    {"symmetric", m.symmetric},
                    {"instances", m.instances},
                    {"found", m.error.size()},
                    {"extra", m.extra},
                    {"recall_0.05d", share(m.within(0.05), m.instances)},
                    {"recall_0.1d", share(m.within(0.1), m.instances)},
                    {"translation_m", spread(m.translation)},
                    {"rotation_rad", spread(m.rotation)},
                    {"add_m", spread(m.error)}};
  return {{"answers", comparison.answers}, {"unanswered", comparison.unanswered}, {"models", models}};
}

}  // namespace edgepose
