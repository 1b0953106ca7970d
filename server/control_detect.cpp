/// The command `detect`: one image, between the frames.
#include <functional>
#include <memory>
#include <optional>
#include <set>

#include "common/error.h"
#include "common/naming.h"
#include "daemon/json_text.h"
#include "daemon/params.h"
#include "files/camera_file.h"
#include "files/depth_file.h"
#include "matcher/stopwatch.h"
#include "reporting/match_json.h"
#include "server/control.h"

namespace edgepose {
namespace {

using nlohmann::json;

constexpr double kMaxSeconds = 10;  // frames wait meanwhile

struct DetectOrder {
  std::string scene;  ///< file, or camera and number of the frame
  std::string intrinsics;
  std::optional<double> depth_scale;
  DepthImage image;
  Camera camera;
  ModelList models;
};

/// What the request names; without a scene it is the last frame that is meant.
DetectOrder order_of(const Params& params) {
  DetectOrder order;
  if (!params.has("depth")) {
    if (params.has("intrinsics") || params.has("depth_scale"))
      throw RpcError(RpcCode::kBadParams,
                     "params.depth: expected a path, as there are intrinsics, found none");
    return order;
  }
  order.scene = params.path("depth");
  order.intrinsics = params.text("intrinsics");
  if (params.has("depth_scale")) order.depth_scale = params.number("depth_scale", 0);
  return order;
}

/// Reads its image. Throws InputError.
void read_image(DetectOrder& order, int max_pixels) {
  const CameraFile camera = read_camera(order.intrinsics);
  order.camera = camera.camera;
  order.image = read_depth_png(order.scene, order.depth_scale.value_or(camera.depth_scale),
                               static_cast<uint64_t>(max_pixels));
}

/// At most kMaxSeconds for all models, and no longer than `goes_on`.
json match_all(const DetectOrder& order, const Settings& settings, const std::function<bool()>& goes_on) {
  return naming(order.scene, [&] {
    const Scene scene = prepare_scene(order.image, order.camera, settings.scene);
    std::vector<const Model*> models;
    std::vector<MatchResult> results;
    Stopwatch watch;
    for (const ModelHandle& model : order.models) {
      MatchOptions options = settings.match;
      options.max_seconds = kMaxSeconds - watch.total();
      if (options.max_seconds <= 0 || !goes_on())
        throw InputError::at(
            "detect", "all models within " + std::to_string(static_cast<int>(kMaxSeconds)) + " s",
            goes_on() ? "more to do" : "the daemon stopping", "ask for fewer models at once");
      models.push_back(&model->model);
      results.push_back(match(scene, model->model, options));
    }
    resolve_conflicts(scene, models, settings.match, results);
    json found = json::array();
    for (size_t i = 0; i < results.size(); ++i) {
      const RegisteredModel& model = *order.models[i];
      found.push_back(
          to_json(NamedResult{model.name, model.file, model.model.diameter(), model.model.centre(),
                              model.model.symmetries(), std::move(results[i])},
                  "camera"));
    }
    return json{{"edgepose", EDGEPOSE_VERSION},
                {"scene", order.scene},
                {"frame", "camera"},
                {"preprocessing_seconds", scene.preprocessing_seconds()},
                {"models", found}};
  });
}

void take_frame(DetectOrder& order, const DepthFrame* last) {
  if (last == nullptr) throw RpcError(RpcCode::kNoFrame, "detect: no frame has come yet");
  order.scene = last->camera + " " + std::to_string(last->sequence);
  order.image = last->image;
  order.camera = last->intrinsics;
}

}  // namespace

Control::Reply Control::detect(const Call& call) {
  const Params params(call.request.params, {"models", "depth", "intrinsics", "depth_scale"});
  auto order = std::make_shared<DetectOrder>(order_of(params));
  if (params.has("models")) {
    std::set<std::string> seen;
    for (const std::string& name : params.texts("models")) {
      if (!seen.insert(name).second)
        throw RpcError(RpcCode::kBadParams,
                       "params.models: expected each name once, found '" + name + "' again");
      order->models.push_back(parts_.registry.find(name));
      if (order->models.back() == nullptr) no_model(name);
    }
  } else {
    order->models = parts_.registry.active();
  }
  const auto work = [order, id = call.request.id, finish = call.finish, options = parts_.options.get(),
                     &worker = parts_.worker](const DepthFrame* last) {
    try {
      order->scene.empty() ? take_frame(*order, last) : read_image(*order, options->frames.max_pixels);
      finish(result_line(
          id, text_of(match_all(*order, options->matcher, [&worker] { return !worker.stopping(); }))));
    } catch (const RpcError& error) {
      finish(error_line(id, error.code, error.what()));
    } catch (const std::exception& error) {
      finish(error_line(id, RpcCode::kBadInput, error.what()));
    }
  };
  if (!parts_.worker.post(work)) throw RpcError(RpcCode::kBusy, "detect: too many wait; try again later");
  return std::nullopt;
}

}  // namespace edgepose
