/// edgepose_speed: time of each stage on the project's own sample (Google Benchmark).
#include <benchmark/benchmark.h>

#include "files/camera_file.h"
#include "files/depth_file.h"
#include "files/mesh_file.h"
#include "matcher/match.h"
#include "matcher/scene_data.h"

namespace edgepose {
namespace {

std::string sample(const std::string& name) { return EDGEPOSE_SOURCE_DIR "/models/phantom/" + name; }

const Mesh& phantom() {
  static const Mesh mesh = read_mesh(sample("phantom.ply"));
  return mesh;
}

const DepthImage& depth() {
  static const DepthImage image =
      read_depth_png(sample("scene/depth.png"), read_camera(sample("scene/camera.json")).depth_scale);
  return image;
}

const Camera& camera() {
  static const Camera read = read_camera(sample("scene/camera.json")).camera;
  return read;
}

int threads(const benchmark::State& state) { return static_cast<int>(state.range(0)); }

void Train(benchmark::State& state) {
  TrainOptions options;
  options.threads = threads(state);
  for (auto _ : state) benchmark::DoNotOptimize(train_model(phantom(), "phantom", options));
}

void Preprocess(benchmark::State& state) {
  SceneOptions options;
  options.threads = threads(state);
  for (auto _ : state) benchmark::DoNotOptimize(prepare_scene(depth(), camera(), options));
}

/// The stages of match() as counters, in milliseconds.
void Match(benchmark::State& state) {
  static const Model model = train_model(phantom(), "phantom");
  static const Scene scene = prepare_scene(depth(), camera());
  MatchOptions options;
  options.threads = threads(state);
  StageTimes sum;
  for (auto _ : state) {
    const StageTimes times = match(scene, model, options).times;
    sum.sampling += times.sampling;
    sum.voting += times.voting;
    sum.clustering += times.clustering;
    sum.verification += times.verification;
    sum.refinement += times.refinement;
  }
  const auto mean_ms = [&](double seconds) {
    return benchmark::Counter(1e3 * seconds, benchmark::Counter::kAvgIterations);
  };
  state.counters["sampling_ms"] = mean_ms(sum.sampling);
  state.counters["voting_ms"] = mean_ms(sum.voting);
  state.counters["clustering_ms"] = mean_ms(sum.clustering);
  state.counters["verification_ms"] = mean_ms(sum.verification);
  state.counters["refinement_ms"] = mean_ms(sum.refinement);
}

BENCHMARK(Train)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(Preprocess)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
BENCHMARK(Match)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace
}  // namespace edgepose

BENCHMARK_MAIN();
