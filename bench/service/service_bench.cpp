/// Measures the real daemon over real LCM multicast, in a network of its own: the rows of docs/results.md.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <iostream>
#include <thread>

#include "common/error.h"
#include "files/depth_file.h"
#include "files/test_set.h"
#include "tests/messaging/network_namespace.h"
#include "tests/service/daemon.h"
#include "tests/service/peer.h"

namespace edgepose::test {
namespace {

struct Arguments {
  std::string set, mode = "detection", encoding = "rvl";
  double rate = 30, seconds = 60;
  int frames = 0, models = 20, images = 30;
  bool start = false;
};

std::vector<DepthFrame> read_frames(const Arguments& a, const TestSet& set) {
  std::vector<DepthFrame> frames;
  for (const TestImage& image : set.images) {
    if (static_cast<int>(frames.size()) == a.images) break;
    DepthFrame frame;
    frame.camera = "bench";
    frame.intrinsics = image.camera;
    frame.image = read_depth_png(image.depth, image.depth_scale);
    frames.push_back(std::move(frame));
  }
  return frames;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

void print_latencies(const Peer& peer, Daemon& daemon) {
  std::vector<double> all, late;
  int found = 0, tracked = 0;
  for (const auto& [sequence, answer] : peer.answers()) {
    all.push_back(std::chrono::duration<double>(answer.received - peer.sent_at(sequence)).count());
    const auto& models = answer.poses.answers;
    found += !models.empty() && !models[0].detections.empty() && models[0].detections[0].accepted;
    tracked += !models.empty() && models[0].mode == edgepose_lcm::model_answer_t::TRACKING;
  }
  std::printf("answers %zu, found %d, tracked %d; publish to receipt p50 %.1f ms, p99 %.1f ms, max %.1f ms\n",
              all.size(), found, tracked, 1e3 * quantile(all, 0.5), 1e3 * quantile(all, 0.99),
              1e3 * quantile(all, 1));
  const auto stats = daemon.result("stats");
  for (const auto& [stage, s] : stats["stages"].items())
    std::printf("  %-14s p50 %6.2f ms, p99 %6.2f ms\n", stage.c_str(), 1e3 * s["p50"].get<double>(),
                1e3 * s["p99"].get<double>());
  std::cout << "  counters " << stats["counters"].dump() << '\n';
}

/// Frames at a rate, whether or not the daemon keeps up: every one must be answered or counted.
void run_at_rate(const Arguments& a, Peer& peer, Daemon& daemon, const std::vector<DepthFrame>& frames) {
  const auto start = Peer::Clock::now();
  const auto count = static_cast<int64_t>(a.rate * a.seconds);
  int64_t last = 0;
  for (int64_t i = 0; i < count; ++i) {
    std::this_thread::sleep_until(start + std::chrono::duration<double>(static_cast<double>(i) / a.rate));
    last = peer.send(frames[static_cast<size_t>(i) % frames.size()],
                     a.encoding == "raw" ? DepthEncoding::kRaw16 : DepthEncoding::kRvl);
  }
  peer.answer_to(last, 5);
  print_latencies(peer, daemon);
  int64_t dropped = 0;
  for (const auto& [sequence, answer] : peer.answers())
    for (const auto& cause : answer.poses.dropped) dropped += cause.value;
  std::printf("sent %ld, answered %zu, reported as dropped %ld: unaccounted %ld\n", count,
              peer.answers().size(), dropped, count - static_cast<int64_t>(peer.answers().size()) - dropped);
}

/// One frame after the other, each as soon as the last is answered.
void run_in_step(const Arguments& a, Peer& peer, Daemon& daemon, const std::vector<DepthFrame>& frames) {
  double after_1000 = 0;
  int unanswered = 0;
  std::vector<double> all;
  for (int i = 0; i < a.frames; ++i) {
    const int64_t sequence = peer.send(frames[static_cast<size_t>(i) % frames.size()]);
    const auto answer = peer.answer_to(sequence, 5);
    unanswered += !answer;
    if (answer)
      all.push_back(std::chrono::duration<double>(answer->received - peer.sent_at(sequence)).count());
    peer.forget();
    const bool is_mark = i + 1 == 1000 || i + 1 == 3000 || (i + 1) % 10000 == 0;
    if (!is_mark) continue;
    const double bytes = daemon.result("stats")["memory_bytes"].get<double>();
    if (i + 1 == 1000) after_1000 = bytes;
    std::printf("%7d frames: memory %.2f MB (%+.2f %% since the first 1000), unanswered %d\n", i + 1,
                1e-6 * bytes, 100 * (bytes / after_1000 - 1), unanswered);
    std::fflush(stdout);
  }
  std::printf("in step: publish to receipt p50 %.1f ms, p99 %.1f ms\n", 1e3 * quantile(all, 0.5),
              1e3 * quantile(all, 0.99));
}

void measure_start(const Arguments& a, const TestSet& set) {
  const Folder folder;
  {
    Daemon daemon(folder / "");
    for (int i = 0; i < a.models; ++i) {
      const TestObject& object = set.objects[static_cast<size_t>(i) % set.objects.size()];
      daemon.result("models.register", {{"mesh", std::filesystem::absolute(object.mesh)},
                                        {"name", "model_" + std::to_string(i)}});
    }
  }
  std::vector<double> seconds;
  for (int i = 0; i < 11; ++i) seconds.push_back(Daemon(folder / "").ready_seconds());
  std::printf("start with %d models to READY: median %.3f s, worst of %zu %.3f s\n", a.models,
              quantile(seconds, 0.5), seconds.size(), quantile(seconds, 1));
}

void measure_frames(const Arguments& a, const TestSet& set) {
  const Folder folder;
  const std::vector<DepthFrame> frames = read_frames(a, set);
  Daemon daemon(folder / "", a.mode == "tracking" ? "" : "[tracking]\nenabled = false\n");
  daemon.result("models.register", {{"mesh", std::filesystem::absolute(set.objects.front().mesh)}});
  Peer peer;
  for (int i = 0; i < 10; ++i) peer.answer_to(peer.send(frames[static_cast<size_t>(i) % frames.size()]), 5);
  peer.forget();
  std::printf("%s, %dx%d, %zu images\n", a.mode.c_str(), frames[0].image.width, frames[0].image.height,
              frames.size());
  a.frames > 0 ? run_in_step(a, peer, daemon, frames) : run_at_rate(a, peer, daemon, frames);
}

int run(int argc, char** argv) {
  Arguments a;
  CLI::App app{"edgepose_service_bench: latency, losses, memory and start of the daemon, over LCM"};
  app.add_option("SET", a.set, "BOP set (or UWA) with depth images")->required();
  app.add_option("--mode", a.mode)->check(CLI::IsMember({"detection", "tracking"}))->capture_default_str();
  app.add_option("--rate", a.rate, "Frames a second")->capture_default_str();
  app.add_option("--seconds", a.seconds)->capture_default_str();
  app.add_option("--frames", a.frames, "Instead of a rate: so many, each when the last is answered");
  app.add_option("--images", a.images, "Of the set, in turn; 1 for a still scene")->capture_default_str();
  app.add_option("--encoding", a.encoding)->check(CLI::IsMember({"rvl", "raw"}))->capture_default_str();
  app.add_flag("--start", a.start, "Measure the start instead");
  app.add_option("--models", a.models, "Registered for --start")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (!enter_own_network())
    throw InputError("needs root or user namespaces, and ip (iproute2), for its own network");
  const TestSet set = read_test_set(a.set);
  a.start ? measure_start(a, set) : measure_frames(a, set);
  return 0;
}

}  // namespace
}  // namespace edgepose::test

int main(int argc, char** argv) {
  try {
    return edgepose::test::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "edgepose_service_bench: " << error.what() << '\n';
    return 2;
  }
}
