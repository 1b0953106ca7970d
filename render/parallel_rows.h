#pragma once
#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace edgepose::internal {

/// Calls `work(row)` once for every row in [0, rows), spread over `threads` threads (0 = all cores).
/// `work` must not throw and must write only what belongs to its row: then the result is the same at any
/// number of threads.
template <typename Work>
void parallel_rows(int rows, int threads, const Work& work) {
  constexpr int kChunk = 8;  // rows taken at a time: few enough to balance, many enough to share cache lines
  const int cores = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  const int wanted = std::min(threads > 0 ? threads : cores, (rows + kChunk - 1) / kChunk);
  std::atomic<int> next{0};
  const auto run = [&] {
    for (int begin = next.fetch_add(kChunk); begin < rows; begin = next.fetch_add(kChunk)) {
      for (int row = begin; row < std::min(rows, begin + kChunk); ++row) work(row);
    }
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < wanted; ++i) others.emplace_back(run);
  run();
}

}  // namespace edgepose::internal
