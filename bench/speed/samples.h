#pragma once
#include <cstddef>
#include <vector>

namespace edgepose::bench {

/// Wall times [s] of several variants over the same questions, each asked many times.
class Samples {
 public:
  Samples(size_t variants, size_t questions);
  void add(size_t variant, size_t question, double seconds);

  /// Of each question that was asked, the median over its repeats: what the machine does beside falls out.
  std::vector<double> typical(size_t variant) const;
  /// Every answer by itself, the machine's hiccups included.
  std::vector<double> all(size_t variant) const;

 private:
  std::vector<std::vector<std::vector<double>>> seconds_;  ///< [variant][question][repeat]
};

/// Asks every question in every variant `repeat` times, the variants in turns (A B C, B C A, ...), so that a
/// machine which is slow for a while is so for all alike. `ask(variant, question)` does what is to be done;
/// a first question in each variant, which is not counted, warms up.
template <class Ask, class Counted>
void take_turns(size_t variants, size_t questions, int repeat, Ask&& ask, Counted&& counted) {
  for (size_t v = 0; v < variants && questions > 0; ++v) ask(v, size_t{0});
  for (size_t r = 0; r < static_cast<size_t>(repeat); ++r)
    for (size_t q = 0; q < questions; ++q)
      for (size_t turn = 0; turn < variants; ++turn) {
        const size_t v = (turn + q + r) % variants;
        counted(v, q, ask(v, q));
      }
}

}  // namespace edgepose::bench
