/// The command `detect`: one image, between the frames.
#include <memory>

#include "common/error.h"
#include "common/naming.h"
#include "files/camera_file.h"
#include "files/depth_file.h"
#include "reporting/match_json.h"
#include "server/control.h"
#include "server/json_text.h"
#include "server/params.h"

namespace edgepose {
namespace {

using nlohmann::json;

struct DetectOrder {
  std::string scene;  ///< file, or camera and number of the frame
  DepthImage image;
  Camera camera;
  ModelList models;
};

/// The image that the request names; empty if it is the last frame that is meant.
DetectOrder read_order(const Params& params) {
  DetectOrder order;
  if (!params.has("depth")) {
    if (params.has("intrinsics") || params.has("depth_scale"))
      throw RpcError(RpcCode::kBadParams,
                     "params.depth: expected a path, as there are intrinsics, found none");
    return order;
  }
  order.scene = params.path("depth");
  const CameraFile camera = read_camera(params.text("intrinsics"));
  order.camera = camera.camera;
  order.image = read_depth_png(order.scene, params.number("depth_scale", camera.depth_scale));
  return order;
}

json match_all(const DetectOrder& order, const Settings& settings) {
  return naming(order.scene, [&] {
    const Scene scene = prepare_scene(order.image, order.camera, settings.scene);
    std::vector<const Model*> models;
    std::vector<MatchResult> results;
    for (const ModelHandle& model : order.models) {
      models.push_back(&model->model);
      results.push_back(match(scene, model->model, settings.match));
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
  if (!order.scene.empty()) return;
  if (last == nullptr) throw RpcError(RpcCode::kNoFrame, "detect: no frame has come yet");
  order.scene = last->camera + " " + std::to_string(last->sequence);
  order.image = last->image;
  order.camera = last->intrinsics;
}

}  // namespace

Control::Reply Control::detect(const Call& call) {
  const Params params(call.request.params, {"models", "depth", "intrinsics", "depth_scale"});
  auto order = std::make_shared<DetectOrder>(read_order(params));
  if (params.has("models")) {
    for (const std::string& name : params.texts("models")) {
      order->models.push_back(parts_.registry.find(name));
      if (order->models.back() == nullptr) no_model(name);
    }
  } else {
    order->models = parts_.registry.active();
  }
  const auto work = [order, id = call.request.id, finish = call.finish,
                     options = parts_.options.get()](const DepthFrame* last) {
    try {
      take_frame(*order, last);
      finish(result_line(id, text_of(match_all(*order, options->matcher))));
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
