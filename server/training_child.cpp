/// What happens in the child process: the only place where foreign meshes, model files and plans are read.
#include <iostream>
#include <iterator>
#include <new>

#include "common/error.h"
#include "common/naming.h"
#include "files/drill_plan.h"
#include "files/model_file.h"
#include "files/sound_mesh.h"
#include "matcher/stopwatch.h"
#include "server/training.h"
#include "server/training_messages.h"

namespace edgepose {
namespace {

Model make_model(const TrainingOrder& order, TrainingReport& report) {
  const TrainingRequest& request = order.request;
  if (!request.model.empty()) return load_model(request.model);
  const LengthUnit unit = request.unit == "m" ? LengthUnit::kMetre : LengthUnit::kMillimetre;
  SoundMesh sound = read_sound_mesh(request.mesh, unit, request.any_size ? kAnySize : MeshLimits{});
  report.notes = sound.health.mended;
  report.notes.insert(report.notes.end(), sound.health.warnings.begin(), sound.health.warnings.end());
  return naming(request.mesh, [&] { return train_model(sound.mesh, request.name, order.options); });
}

void train(const TrainingOrder& order, TrainingReport& report) {
  Stopwatch watch;
  const Model model = make_model(order, report);
  if (!order.request.plan.empty()) {
    const DrillPlan plan = read_drill_plan(order.request.plan);
    check_drill_plan(plan, model.centre(), model.diameter(), order.request.plan);
    write_drill_plan(order.plan_out, plan);
    report.has_plan = true;
  }
  save_model(order.model_out, model);
  report.seconds = watch.total();
}

}  // namespace

int run_training_child() {
  try {
    const std::string text{std::istreambuf_iterator<char>(std::cin), std::istreambuf_iterator<char>()};
    TrainingReport report;
    train(parse_order(text), report);
    std::cout << to_text(report) << std::flush;
    return std::cout.good() ? 0 : 2;
  } catch (const std::bad_alloc&) {
    return kOutOfMemory;
  } catch (const std::exception& error) {
    std::cerr << one_line(error.what()) << '\n';
  }
  return 2;
}

}  // namespace edgepose
