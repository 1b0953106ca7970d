#include "common/error.h"
#include "evaluation/study.h"
#include "evaluation/table.h"
#include "render/sensor_model.h"

namespace edgepose {
namespace {

constexpr const char* kFreeSpaceName = "free space (default)";
constexpr const char* kPaperName = "edge score S (paper)";
constexpr const char* kOverlapName = "surface overlap (Papazov, Burschka)";

EvalOptions with(EvalOptions options, Verification verification) {
  options.match.verification = verification;
  return options;
}

/// The same noise for every method; another for every image.
EvalOptions with_noise(EvalOptions options, double sigma) {
  if (sigma <= 0) return options;
  const uint64_t seed = options.match.seed;
  const int threads = options.threads.value_or(options.scene.threads);
  options.disturb = [sigma, seed, threads](const TestImage& image, const DepthImage& depth,
                                           const Camera& camera) {
    const uint64_t image_seed = seed * 1000003 + static_cast<uint64_t>(image.scene_id) * 100003 +
                                static_cast<uint64_t>(image.image_id);
    return add_gaussian_noise(depth, camera, sigma, image_seed, threads);
  };
  return options;
}

/// An experiment without its variants.
Experiment described(const char* key, const char* title, Experiment::Layout layout, const char* note) {
  Experiment experiment;
  experiment.key = key;
  experiment.title = title;
  experiment.layout = layout;
  experiment.note = note;
  return experiment;
}

Experiment noise(const EvalOptions& base) {
  Experiment experiment =
      described("noise", "Gaussian noise", Experiment::Layout::kBySetting,
                "Paper: table 'Results of our algorithm after interference by various noises'. Noise "
                "of this standard deviation is added along the viewing rays, to what the images "
                "already have.");
  experiment.setting_label = "standard deviation of the noise, mm";
  for (const auto& [name, verification] :
       {std::pair{kPaperName, Verification::kPaper}, std::pair{kFreeSpaceName, Verification::kFreeSpace}})
    for (double millimetres : {0.0, 0.5, 1.0, 1.5, 2.0})
      experiment.variants.push_back({name, fixed(millimetres, 1), millimetres,
                                     with_noise(with(base, verification), 1e-3 * millimetres)});
  return experiment;
}

Experiment sampling(const EvalOptions& base) {
  Experiment experiment =
      described("sampling", "Sampling with and without emphasis on edges", Experiment::Layout::kByObject,
                "Paper: table 'Validation of edge-based sampling method'.");
  for (const auto& [name, verification] :
       {std::pair{"S", Verification::kPaper}, std::pair{"free space", Verification::kFreeSpace}})
    for (bool edges : {false, true}) {
      Variant variant{edges ? "edges kept" : "normal clusters only", "", 0, with(base, verification)};
      variant.method.append(", verified by ").append(name);
      variant.options.match.sampling.keep_edges = edges;
      experiment.variants.push_back(std::move(variant));
    }
  return experiment;
}

Experiment verification(const EvalOptions& base) {
  Experiment experiment = described("verification", "Pose verification", Experiment::Layout::kByObject,
                                    "Paper: table 'Validation of our pose verification method'.");
  experiment.variants = {{kOverlapName, "", 0, with(base, Verification::kSurfaceOverlap)},
                         {kPaperName, "", 0, with(base, Verification::kPaper)},
                         {kFreeSpaceName, "", 0, with(base, Verification::kFreeSpace)}};
  return experiment;
}

Experiment early_exit(const EvalOptions& base) {
  Experiment experiment =
      described("early_exit", "Three ways of running the verification", Experiment::Layout::kByTime,
                "Paper: figure 'Comparison of time efficiency of three ways of using the pose "
                "verification functions'.");
  const auto add = [&](const char* name, bool two_classes, bool exit) {
    Variant variant{name, "", 0, with(base, Verification::kPaper)};
    variant.options.match.paper.two_classes = two_classes;
    variant.options.match.paper.early_exit = exit;
    experiment.variants.push_back(std::move(variant));
  };
  add("one class", false, false);
  add("two classes", true, false);
  add("two classes, early exit", true, true);
  return experiment;
}

/// Where the paper's parameter analysis starts from (caption of its figure).
EvalOptions sweep_start(const EvalOptions& base) {
  EvalOptions options = with(base, Verification::kPaper);
  options.train.distance_step = 0.025f;
  options.train.angle_step_deg = 5;
  options.match.paper.candidates = 10;
  options.match.paper.roi_scale = 1.5f;
  return options;
}

template <typename Set>
Experiment sweep(const EvalOptions& base, const std::string& key, const std::string& label,
                 const std::vector<double>& values, int decimals, Set&& set) {
  Experiment experiment =
      described("sweep_", "Sweep: ", Experiment::Layout::kSweep,
                "Paper: figure 'Parameter analysis'. The others stay at distance step 0.025 d, angle "
                "step 5 degrees, N = 10, s = 1.5; verified by S.");
  experiment.key.append(key);
  experiment.title.append(label);
  experiment.setting_label = label;
  for (double value : values) {
    Variant variant{"", fixed(value, decimals), value, sweep_start(base)};
    set(variant.options, value);
    experiment.variants.push_back(std::move(variant));
  }
  return experiment;
}

std::vector<Experiment> sweeps(const EvalOptions& base) {
  return {
      sweep(base, "distance_step", "distance step, diameters", {0.015, 0.02, 0.025, 0.03, 0.04, 0.05, 0.06},
            3, [](EvalOptions& o, double v) { o.train.distance_step = static_cast<float>(v); }),
      sweep(base, "angle_step", "angle step, degrees", {3, 4, 5, 6, 8, 10, 12, 15}, 0,
            [](EvalOptions& o, double v) { o.train.angle_step_deg = static_cast<float>(v); }),
      sweep(base, "candidates", "N, candidates of a class", {1, 3, 5, 7, 8, 9, 10, 12, 15}, 0,
            [](EvalOptions& o, double v) { o.match.paper.candidates = static_cast<int>(v); }),
      sweep(base, "roi_scale", "s, size of the region of interest",
            {1.0, 1.1, 1.2, 1.3, 1.4, 1.5, 1.6, 1.8, 2.0}, 1,
            [](EvalOptions& o, double v) { o.match.paper.roi_scale = static_cast<float>(v); })};
}

}  // namespace

const std::vector<std::string>& experiment_names() {
  static const std::vector<std::string> kNames = {"noise", "sampling", "verification", "early-exit", "sweep"};
  return kNames;
}

std::vector<Experiment> experiments(const std::string& name, const EvalOptions& base) {
  if (name == "noise") return {noise(base)};
  if (name == "sampling") return {sampling(base)};
  if (name == "verification") return {verification(base)};
  if (name == "early-exit") return {early_exit(base)};
  if (name == "sweep") return sweeps(base);
  throw InputError::at("experiment", "noise, sampling, verification, early-exit or sweep",
                       "'" + name.substr(0, 40) + "'");
}

}  // namespace edgepose
