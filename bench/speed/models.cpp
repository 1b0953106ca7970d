#include <algorithm>
#include <cstring>
#include <memory>
#include <new>

#include "bench/speed/parts.h"
#include "bench/speed/samples.h"
#include "common/naming.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"
#include "matcher/stopwatch.h"

namespace edgepose::bench {
namespace {

std::vector<size_t> model_counts(int most) {
  std::vector<size_t> counts;
  for (const size_t count : {1, 2, 5, 10, 20, 50, 100, 200, 500})
    if (count < static_cast<size_t>(most)) counts.push_back(count);
  counts.push_back(static_cast<size_t>(most));
  return counts;
}

/// The same model in memory of its own, as another one would be: nothing of it is in the caches already.
Model copy_of(const Model& model) {
  const size_t size = model.block().size();
  const std::shared_ptr<std::byte> bytes(
      static_cast<std::byte*>(::operator new[](size, std::align_val_t{64})),
      [](std::byte* block) { ::operator delete[](block, std::align_val_t{64}); });
  std::memcpy(bytes.get(), model.block().data(), size);
  return Model::from_block({bytes.get(), size}, bytes);
}

/// The models for one image: first those that are in it, then the set's others, then all of them again.
std::vector<const Model*> order_for(const TestImage& image, const SpeedRun& run,
                                    const std::vector<Model>& models) {
  std::vector<const Model*> order;
  for (size_t round = 0; round * run.models.size() < models.size(); ++round)
    for (const bool present : {true, false})
      for (size_t m = 0; m < run.models.size(); ++m) {
        const size_t i = round * run.models.size() + m;
        if (i < models.size() && is_asked(image, run.models[m].object_id, false) == present)
          order.push_back(&models[i]);
      }
  return order;
}

/// [s] wall time: preprocessing, every model, and the conflicts between them.
double seconds_for(const ImageInput& image, const std::vector<const Model*>& models, int threads) {
  Stopwatch watch;
  const Scene scene = prepare(image, threads);
  MatchOptions options;
  options.threads = threads;
  std::vector<MatchResult> results;
  for (const Model* model : models) results.push_back(match(scene, *model, options));
  resolve_conflicts(scene, models, options, results);
  return watch.total();
}

}  // namespace

std::string time_models(SpeedRun& run) {
  const std::vector<size_t> counts = model_counts(run.max_models);
  std::vector<Model> models;
  for (size_t i = 0; i < std::max(counts.back(), run.models.size()); ++i)
    models.push_back(copy_of(run.models[i % run.models.size()].model));
  Samples samples(counts.size(), run.images.size());
  take_turns(
      counts.size(), run.images.size(), run.repeat,
      [&](size_t v, size_t i) {
        std::vector<const Model*> asked = order_for(run.set.images[i], run, models);
        asked.resize(counts[v]);
        return naming(run.images[i].file, [&] { return seconds_for(run.images[i], asked, run.threads); });
      },
      [&](size_t v, size_t i, double seconds) { samples.add(v, i, seconds); });

  Table table({"models", "all, median, ms", "p99, ms", "a further model, ms"});
  const double first = median(samples.typical(0));
  for (size_t v = 0; v < counts.size(); ++v) {
    const std::vector<double> seconds = samples.typical(v);
    CurvePoint point{.curve = "models", .variant = "", .x = static_cast<double>(counts[v])};
    point.median = median(seconds);
    point.p99 = percentile(seconds, 0.99);
    if (v > 0) point.further = (point.median - first) / static_cast<double>(counts[v] - 1);
    table.add({count_text(counts[v]), milliseconds(point.median), milliseconds(point.p99),
               v > 0 ? milliseconds(point.further) : "-"});
    run.curves.add(point);
  }
  return "## Cost over models in one image\n\n" + table.markdown() +
         "\nPreprocessing once, then every model, one after the other. First those that are in the image, "
         "then "
         "the set's others (" +
         count_text(run.models.size()) +
         " in all), then copies of these in memory of their own. A further model: mean of all after the "
         "first. Models of like size share the scene's samples, so the copies have them for nothing.\n";
}

}  // namespace edgepose::bench
