/// A session is recorded to an LCM log with the program's own tools, and replayed into the daemon: the same
/// bits at one and two threads, and right against the truth.
#include <signal.h>

#include "files/depth_file.h"
#include "tests/service/daemon_fixture.h"

namespace edgepose {
namespace {

using test::DaemonTest;
using test::eventually;
using test::Process;

class ReplayTest : public DaemonTest {
 protected:
  /// Runs `edgepose ARGUMENTS...` to its end.
  int edgepose(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), test::program("edgepose"));
    output_ = folder_ / ("output_" + std::to_string(++runs_));
    return Process(arguments, output_).wait(120).value_or(-99);
  }
  std::string output() const { return test::read_text(output_); }
  /// A daemon whose poses depend on nothing but the frames.
  void start_with_threads(int threads) {
    const std::string n = std::to_string(threads);
    start("[match]\nthreads = " + n + "\n[scene]\nthreads = " + n + "\n[service]\ndeadline = 0.0\n");
  }
  /// Sends what `arguments` say while `log` is recorded.
  void record_session(const std::filesystem::path& log, std::vector<std::string> arguments) {
    Process recorder({test::program("edgepose"), "record", log}, folder_ / "recorder");
    ASSERT_TRUE(eventually(
        [&] { return test::read_text(folder_ / "recorder").find("recording to") != std::string::npos; }));
    arguments.insert(arguments.begin(), "send");
    ASSERT_EQ(edgepose(arguments), 0) << output() << daemon_->log();
    recorder.signal(SIGTERM);
    EXPECT_EQ(recorder.wait(10), 0) << test::read_text(folder_ / "recorder");
  }
  void expect_same_bits_when_replayed(const std::filesystem::path& log) {
    for (const int threads : {1, 2}) {
      start_with_threads(threads);
      const std::filesystem::path again = folder_ / ("again_" + std::to_string(threads));
      ASSERT_EQ(edgepose({"replay", log, "--speed", "0", "--record", again, "--timeout", "60"}), 0)
          << output();
      EXPECT_EQ(edgepose({"compare", log, again}), 0) << threads << " threads: " << output();
    }
  }

 private:
  std::filesystem::path output_;
  int runs_ = 0;
};

TEST_F(ReplayTest, AMovingSceneGivesTheSameBits) {
  const std::filesystem::path frames = folder_ / "frames";
  std::filesystem::create_directory(frames);
  for (size_t i = 0; i < scene().size(); ++i)
    write_depth_png(frames / ("frame_00" + std::to_string(i) + ".png"), scene()[i].depth.image, 0.0001);
  start_with_threads(2);
  register_phantom();
  const std::filesystem::path log = folder_ / "session.lcmlog";
  record_session(log, {frames, "--intrinsics", "252,252,159.5,143.5", "--depth-scale", "0.1", "--wait"});
  EXPECT_GT(daemon_->counter("answers_by_tracking"), 0);
  expect_same_bits_when_replayed(log);
}

TEST_F(ReplayTest, ASessionIsRightAgainstTheTruth) {
  const std::string set = std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models/sample_set";
  start_with_threads(2);
  register_phantom("vertebra_phantom");
  const std::filesystem::path log = folder_ / "session.lcmlog";
  record_session(log, {set, "--wait", "--timeout", "60"});
  EXPECT_EQ(edgepose({"compare", log, "--truth", set}), 0) << output();
  expect_same_bits_when_replayed(log);
}

/// A comparison that cannot fail would be worth nothing.
TEST_F(ReplayTest, AnotherSeedIsNoticed) {
  const std::string set = std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models/sample_set";
  start_with_threads(2);
  register_phantom();
  const std::filesystem::path log = folder_ / "session.lcmlog", other = folder_ / "other.lcmlog";
  record_session(log, {set, "--wait", "--timeout", "60"});
  start("[match]\nseed = 7\n[service]\ndeadline = 0.0\n");
  ASSERT_EQ(edgepose({"replay", log, "--speed", "0", "--record", other, "--timeout", "60"}), 0) << output();
  EXPECT_EQ(edgepose({"compare", log, other}), 1) << output();
}

}  // namespace
}  // namespace edgepose
