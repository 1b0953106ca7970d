#include "bench/speed/samples.h"

#include "evaluation/statistics.h"

namespace edgepose::bench {

Samples::Samples(size_t variants, size_t questions)
    : seconds_(variants, std::vector<std::vector<double>>(questions)) {}

void Samples::add(size_t variant, size_t question, double seconds) {
  seconds_[variant][question].push_back(seconds);
}

std::vector<double> Samples::typical(size_t variant) const {
  std::vector<double> medians;
  for (const std::vector<double>& repeats : seconds_[variant])
    if (!repeats.empty()) medians.push_back(median(repeats));
  return medians;
}

std::vector<double> Samples::all(size_t variant) const {
  std::vector<double> every;
  for (const std::vector<double>& repeats : seconds_[variant])
    every.insert(every.end(), repeats.begin(), repeats.end());
  return every;
}

}  // namespace edgepose::bench
