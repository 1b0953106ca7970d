#pragma once
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <exception>
#include <functional>
#include <string>

namespace edgepose {

/// Runs `session`, which leaves by how much [ns] the machine was late at most. What fails while that was
/// `limit_ns` or more proves nothing: then `prepare` and again, up to twelve times. Any other failure, also
/// what it throws, is one of the test.
inline void in_real_time(const std::string& what, int64_t limit_ns,
                         const std::function<void(int64_t& late_ns)>& session,
                         const std::function<void()>& prepare) {
  for (int attempt = 1; !testing::Test::IsSkipped(); ++attempt) {
    testing::TestPartResultArray results;
    int64_t late = 0;
    std::string thrown;
    {
      using Reporter = testing::ScopedFakeTestPartResultReporter;
      Reporter reporter(Reporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
      try {
        session(late);
      } catch (const std::exception& error) {
        thrown = error.what();
      }
    }
    std::printf("[measured] %s: at most %.1f ms late\n", what.c_str(), static_cast<double>(late) * 1e-6);
    bool failed = !thrown.empty();
    for (int i = 0; i < results.size(); ++i) failed = failed || results.GetTestPartResult(i).failed();
    if (failed && late >= limit_ns && attempt < 12) {
      std::printf("[repeated] %s: the machine was too busy for real time: %s\n", what.c_str(),
                  results.size() > 0 ? results.GetTestPartResult(0).message() : thrown.c_str());
      sleep(1);
      prepare();
      continue;
    }
    for (int i = 0; i < results.size(); ++i) {
      const testing::TestPartResult& one = results.GetTestPartResult(i);
      if (one.failed()) ADD_FAILURE_AT(one.file_name(), one.line_number()) << one.message();
    }
    if (!thrown.empty()) ADD_FAILURE() << thrown;
    return;
  }
}

}  // namespace edgepose
