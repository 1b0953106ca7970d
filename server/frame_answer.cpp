#include "server/frame_answer.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "matcher/stopwatch.h"

namespace edgepose {
namespace {

bool all_accepted(const MatchResult& result, size_t count) {
  return result.detections.size() == count && std::all_of(result.detections.begin(), result.detections.end(),
                                                          [](const Detection& d) { return d.accepted; });
}

bool any_accepted(const MatchResult& result) {
  return !result.detections.empty() && result.detections.front().accepted;
}

}  // namespace

/// The work on one frame.
class FrameAnswerer::Frame {
 public:
  Frame(Tracker& tracker, const DepthFrame& frame, const AnswerOptions& options)
      : tracker_(tracker),
        frame_(frame),
        mark_{frame.camera, frame.sequence, frame.capture_utime},
        options_(options) {}

  FrameAnswer take(const ModelList& models, size_t first) {
    for (const ModelHandle& model : models) answer_.models.push_back({model, AnswerMode::kSkipped, {}});
    follow();
    for (size_t i = 0; i < models.size(); ++i) {
      ModelAnswer& model = answer_.models[(first + i) % models.size()];
      if (must_detect(model)) detect(model);
    }
    resolve();
    for (const ModelAnswer& model : answer_.models)
      if (model.mode != AnswerMode::kSkipped)
        tracker_.remember(*model.model, mark_, model.result, model.mode == AnswerMode::kDetection);
    return std::move(answer_);
  }

 private:
  const Tracker::Memory* memory(const ModelAnswer& model) const {
    return tracker_.find(*model.model, mark_, options_.tracking);
  }

  /// Looks where the models were: in a part of the image, if that is all that has to be looked at.
  void follow() {
    ImageWindow window;
    bool everywhere = answer_.models.empty();
    for (const ModelAnswer& model : answer_.models) {
      const Tracker::Memory* known = memory(model);
      everywhere = everywhere || known == nullptr || Tracker::is_due(*known, options_.tracking);
      if (known == nullptr) continue;
      for (const TrackStart& start : known->instances)
        window =
            united(window, window_around(model.model->model, start.camera_T_model, frame_.intrinsics,
                                         frame_.image.width, frame_.image.height, options_.tracking.margin));
    }
    if (window.empty()) return;
    if (!everywhere) part_ = scene_of(cut_out(frame_.image, window), cut_out(frame_.intrinsics, window));
    const Scene* scene = everywhere ? whole() : part_ ? &*part_ : nullptr;
    if (scene == nullptr) return;
    for (ModelAnswer& model : answer_.models) {
      const Tracker::Memory* known = memory(model);
      if (known == nullptr) continue;
      model.result = track(*scene, model.model->model, known->instances, options_.match);
      model.mode = AnswerMode::kTracking;
      take_margins(*known, model);
      if (all_accepted(model.result, known->instances.size())) continue;
      ++answer_.tracks_lost;
      if (!any_accepted(model.result)) model.mode = AnswerMode::kSkipped;
    }
  }

  /// Following looks at no rivals: what was known of them when it was detected goes on to hold.
  static void take_margins(const Tracker::Memory& known, ModelAnswer& model) {
    const Eigen::Vector3d centre = model.model->model.centre();
    for (Detection& detection : model.result.detections) {
      const Eigen::Vector3d here = detection.camera_T_model * centre;
      double nearest = INFINITY;
      for (size_t i = 0; i < known.instances.size(); ++i) {
        const double away = (known.instances[i].camera_T_model * centre - here).norm();
        if (away < nearest) nearest = away, detection.margin = known.margins[i];
      }
    }
  }

  bool must_detect(const ModelAnswer& model) const {
    const Tracker::Memory* known = memory(model);
    if (known == nullptr || model.mode == AnswerMode::kSkipped) return true;
    return Tracker::is_due(*known, options_.tracking) || !all_accepted(model.result, known->instances.size());
  }

  /// Searches the whole image. What it does not find is gone, however well it could be followed, unless the
  /// time was over too early. The first model always gets half of the deadline.
  void detect(ModelAnswer& model) {
    if (options_.deadline > 0 && watch_.total() >= options_.deadline && searched_ > 0) {
      answer_.deadline_reached = true;
      if (model.mode == AnswerMode::kSkipped)
        model.result.reason = "the frame's time was over before its turn";
      return;
    }
    const Scene* scene = whole();
    if (scene == nullptr) {
      model.mode = AnswerMode::kDetection;
      model.result = {};
      model.result.reason = unusable_;
      return;
    }
    MatchOptions options = options_.match;
    if (options_.deadline > 0) {
      const double left =
          std::max(options_.deadline - watch_.total(), searched_ == 0 ? options_.deadline / 2 : 1e-3);
      options.max_seconds = options.max_seconds > 0 ? std::min(options.max_seconds, left) : left;
    }
    ++searched_;
    MatchResult found = match(*scene, model.model->model, options);
    answer_.deadline_reached = answer_.deadline_reached || found.cut_short;
    const bool was_followed = model.mode == AnswerMode::kTracking;
    if (was_followed && found.cut_short && !any_accepted(found)) return;
    answer_.tracks_corrected += was_followed && (!any_accepted(found) || differs(model, found));
    model.mode = AnswerMode::kDetection;
    model.result = std::move(found);
  }

  /// Whether the best instance has been somewhere else all the time.
  static bool differs(const ModelAnswer& model, const MatchResult& found) {
    const Eigen::Vector3d centre = model.model->model.centre();
    const Eigen::Vector3d here = found.detections.front().camera_T_model * centre;
    return std::none_of(
        model.result.detections.begin(), model.result.detections.end(), [&](const Detection& d) {
          return (d.camera_T_model * centre - here).norm() < 0.1 * model.model->model.diameter();
        });
  }

  /// Where two models claim the same part of the image, only one keeps it.
  void resolve() {
    const Scene* scene = whole_ ? &*whole_ : part_ ? &*part_ : nullptr;
    if (scene == nullptr || answer_.models.size() < 2) return;
    std::vector<const Model*> models;
    std::vector<MatchResult> results;
    for (ModelAnswer& model : answer_.models) {
      models.push_back(&model.model->model);
      results.push_back(std::move(model.result));
    }
    resolve_conflicts(*scene, models, options_.match, results);
    for (size_t i = 0; i < results.size(); ++i) answer_.models[i].result = std::move(results[i]);
  }

  const Scene* whole() {
    if (!whole_ && unusable_.empty()) whole_ = scene_of(frame_.image, frame_.intrinsics);
    return whole_ ? &*whole_ : nullptr;
  }

  /// Nothing, with the reason, where no pixel is in range.
  std::optional<Scene> scene_of(const DepthImage& image, const Camera& camera) {
    try {
      Scene scene = prepare_scene(image, camera, options_.scene);
      answer_.preprocessing_seconds += scene.preprocessing_seconds();
      return scene;
    } catch (const std::invalid_argument& error) {
      if (image.width == frame_.image.width && image.height == frame_.image.height) unusable_ = error.what();
      return std::nullopt;
    }
  }

  Tracker& tracker_;
  const DepthFrame& frame_;
  const FrameMark mark_;
  const AnswerOptions& options_;
  FrameAnswer answer_;
  std::optional<Scene> whole_, part_;
  int searched_ = 0;      ///< models
  std::string unusable_;  ///< why the image is no scene
  Stopwatch watch_;
};

FrameAnswer FrameAnswerer::answer(const DepthFrame& frame, const ModelList& models,
                                  const AnswerOptions& options) {
  const size_t first = models.empty() ? 0 : first_ % models.size();
  FrameAnswer answer = Frame(tracker_, frame, options).take(models, first);
  for (size_t i = 0; i < models.size(); ++i) {
    const size_t model = (first + i) % models.size();
    if (answer.models[model].mode != AnswerMode::kSkipped) continue;
    first_ = model;
    break;
  }
  return answer;
}

}  // namespace edgepose
