/// The child process that trains: here it is this program, started anew (main() below).
#include "server/training.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <fstream>
#include <iostream>
#include <thread>

#include "common/error.h"
#include "files/model_file.h"
#include "server/child_process.h"
#include "server/training_messages.h"
#include "tests/service/daemon.h"

namespace edgepose {
namespace {

namespace fs = std::filesystem;

const fs::path kPhantom = fs::path(EDGEPOSE_SOURCE_DIR) / "models/phantom";

class Training : public testing::Test {
 protected:
  TrainingRequest request(const fs::path& mesh) const {
    TrainingRequest r;
    r.name = "a";
    r.mesh = mesh;
    return r;
  }
  TrainingResult train(const TrainingRequest& r, const TrainingLimits& limits = {}) const {
    return train_in_child(r, folder_ / "", options_, limits, stop_);
  }
  std::string failure(const TrainingRequest& r, const TrainingLimits& limits = {}) const {
    try {
      train(r, limits);
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }
  bool is_empty() const { return fs::is_empty(folder_ / ""); }

  test::Folder folder_;
  TrainOptions options_;
  std::atomic<bool> stop_ = false;
};

TEST_F(Training, MakesAModelThatLoads) {
  TrainingRequest r = request(kPhantom / "phantom.ply");
  r.plan = kPhantom / "drill_plan.json";
  const TrainingResult result = train(r);
  EXPECT_EQ(load_model(result.prepared.model).name(), "a");
  EXPECT_TRUE(fs::exists(result.prepared.plan));
  EXPECT_GT(result.seconds, 0);
}

TEST_F(Training, TakesATrainedModelToo) {
  const TrainingResult first = train(request(kPhantom / "phantom.ply"));
  TrainingRequest r;
  r.name = "b";
  r.model = first.prepared.model;
  EXPECT_EQ(load_model(train(r).prepared.model).point_count(),
            load_model(first.prepared.model).point_count());
}

TEST_F(Training, BadInputIsTheChildsOneLine) {
  const test::Folder other;
  EXPECT_THAT(failure(request(other / "missing.ply")), testing::HasSubstr("missing.ply"));
  std::ofstream(other / "bad.ply") << "ply\nformat ascii 1.0\n";
  EXPECT_THAT(failure(request(other / "bad.ply")), testing::HasSubstr("bad.ply"));
  TrainingRequest r = request(kPhantom / "phantom.ply");
  r.unit = "m";
  EXPECT_THAT(failure(r), testing::HasSubstr("phantom.ply")) << "read in metres it is 90 m large";
  r = request(kPhantom / "phantom.ply");
  r.plan = kPhantom / "phantom.ply";
  EXPECT_THAT(failure(r), testing::HasSubstr("phantom.ply"));
  EXPECT_TRUE(is_empty());
}

TEST_F(Training, MemoryIsLimited) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "sanitizers reserve terabytes of address space";
#endif
  TrainingLimits limits;
  limits.memory_mb = 64;
  options_.sampling_step = 0.02f;
  EXPECT_THAT(failure(request(kPhantom / "phantom.ply"), limits), testing::HasSubstr("64 MB"));
  EXPECT_TRUE(is_empty());
}

TEST_F(Training, TimeIsLimited) {
  TrainingLimits limits;
  limits.seconds = 0.1;
  EXPECT_THAT(failure(request(kPhantom / "phantom.ply"), limits), testing::HasSubstr("0.1 s"));
  EXPECT_TRUE(is_empty());
}

TEST_F(Training, EndsAtOnceWhenToldTo) {
  std::thread teller([this] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    stop_ = true;
  });
  const auto start = std::chrono::steady_clock::now();
  const ChildEnd end = run_self({"--sleep"}, "", {0, 60, &stop_});
  teller.join();
  EXPECT_TRUE(end.stopped);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(ChildProcess, TellsHowItEnded) {
  EXPECT_EQ(run_self({"--exit", "7"}, "", {0, 20}).exit_code, 7);
  const ChildEnd crash = run_self({"--crash"}, "", {0, 20});
  EXPECT_EQ(crash.exit_code, -1);
  EXPECT_EQ(crash.signal, SIGKILL) << "what the child did to itself";
  EXPECT_TRUE(run_self({"--sleep"}, "", {0, 0.2}).timed_out);
}

TEST(ChildProcess, ReadsAllAndPrintsSo) {
  const std::string input(1'000'000, 'x');
  const ChildEnd end = run_self({"--count"}, input, {0, 20});
  EXPECT_EQ(end.out, "1000000");
  EXPECT_EQ(end.err, "10") << "its priority";
}

TEST(ChildProcess, EndlessOutputIsBounded) {
  const ChildEnd end = run_self({"--flood"}, "", {0, 20});
  EXPECT_EQ(end.exit_code, 0);
  EXPECT_EQ(end.out.size(), size_t{256} << 10);
}

TEST(ChildProcess, InheritsNothingOpen) {
  const int mine = dup(0);
  const ChildEnd end = run_self({"--open-files"}, "", {0, 20});
  close(mine);
  EXPECT_EQ(end.out, "3");
}

TEST(TrainingMessages, AreReadAsWritten) {
  TrainingOrder order;
  order.request = {"n", "/m.ply", "", "m", "/p.json", true, false};
  order.model_out = "/out";
  order.options.sampling_step = 0.03f;
  order.options.seed = 18446744073709551615u;
  const TrainingOrder back = parse_order(to_text(order));
  EXPECT_EQ(back.request.mesh, "/m.ply");
  EXPECT_TRUE(back.request.any_size);
  EXPECT_EQ(back.options.sampling_step, 0.03f);
  EXPECT_EQ(back.options.seed, order.options.seed);
  EXPECT_THROW(parse_order("{}"), InputError);
  EXPECT_THROW(parse_report("nonsense"), InputError);
}

int play_child(int argc, char** argv) {
  const std::string role = argv[1];
  if (role == kTrainingChild) return run_training_child();
  if (role == "--exit") return std::atoi(argv[2]);
  if (role == "--crash") kill(getpid(), SIGKILL);
  if (role == "--sleep") std::this_thread::sleep_for(std::chrono::seconds(60));
  if (role == "--count") {
    const std::string all{std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
    std::cout << all.size();
    std::cerr << getpriority(PRIO_PROCESS, 0);
  }
  if (role == "--flood")
    for (int i = 0; i < 1000; ++i) std::cout << std::string(1000, 'x');
  if (role == "--open-files") {
    int count = 0;
    for (int fd = 0; fd < 1000; ++fd) count += fcntl(fd, F_GETFD) >= 0;
    std::cout << count;
  }
  (void)argc;
  return 0;
}

}  // namespace
}  // namespace edgepose

int main(int argc, char** argv) {
  if (argc > 1 && std::strncmp(argv[1], "--gtest", 7) != 0) return edgepose::play_child(argc, argv);
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
