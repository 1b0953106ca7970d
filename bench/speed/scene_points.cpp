#include "bench/speed/parts.h"
#include "bench/speed/samples.h"
#include "evaluation/statistics.h"
#include "evaluation/table.h"

namespace edgepose::bench {
namespace {

/// One way to have fewer or more scene points.
struct SceneVariant {
  std::string name, curve;  ///< for people; of CurvePoint::variant
  float margin = -1;        ///< [d] of the image around the object; negative = all of it
  SamplingOptions sampling = {};
};

std::vector<SceneVariant> scene_variants() {
  std::vector<SceneVariant> variants;
  for (const float margin : {0.f, 0.25f, 0.5f, 1.f, 2.f})
    variants.push_back({"the image within " + fixed(static_cast<double>(margin), 2) + " d of the object",
                        "cropped", margin});
  variants.push_back({"the whole image", "cropped"});
  for (const float theta : {90.f, 60.f, 30.f, 20.f, 15.f, 10.f}) {
    SceneVariant variant{"fine_theta_deg = " + fixed(static_cast<double>(theta), 0), "thinned"};
    variant.sampling.fine_theta_deg = theta;
    variant.sampling.enough_points = 1;  // always the coarsest grid, so that only theta makes the difference
    variants.push_back(variant);
  }
  return variants;
}

}  // namespace

std::string time_scene_points(SpeedRun& run) {
  const std::vector<SceneVariant> variants = scene_variants();
  Samples matching(variants.size(), run.questions.size());
  std::vector<std::vector<double>> points(variants.size());
  std::vector<std::vector<EvalRow>> rows(variants.size());
  take_turns(
      variants.size(), run.questions.size(), run.repeat,
      [&](size_t v, size_t q) {
        const Question& question = run.questions[q];
        Asking asking{{}, run.threads, 0};
        asking.match.sampling = variants[v].sampling;
        const Model& model = run.models[question.model].model;
        if (variants[v].margin < 0) return ask(run.images[question.image], model, asking);
        return ask(cropped(run, question, question.camera_T_model, variants[v].margin), model, asking);
      },
      [&](size_t v, size_t q, const Answer& answer) {
        matching.add(v, q, answer.matching);
        points[v].push_back(static_cast<double>(answer.result.scene_points));
        if (rows[v].size() < run.questions.size()) rows[v].push_back(row_of(run, run.questions[q], answer));
      });

  Table table({"scene", "points, median", "median, ms", "p99, ms", "correct at 0.05 d, %"});
  for (size_t v = 0; v < variants.size(); ++v) {
    const std::vector<double> seconds = matching.typical(v);
    const Recall recall = recall_of(run, rows[v]);
    CurvePoint point{.curve = "scene_points", .variant = variants[v].curve, .x = median(points[v])};
    point.median = median(seconds);
    point.p99 = percentile(seconds, 0.99);
    point.correct_005 = recall.rate(1);
    point.correct_010 = recall.rate(2);
    table.add({variants[v].name, fixed(point.x, 0), milliseconds(point.median), milliseconds(point.p99),
               percent(point.correct_005)});
    run.curves.add(point);
  }
  return "## Cost over scene points\n\n" + table.markdown() +
         "\nmatch() without preprocessing. Cropped: less of the scene around the object. fine_theta_deg: "
         "the whole image, thinned more or less (match.sampling; 30 degrees is the default).\n";
}

}  // namespace edgepose::bench
