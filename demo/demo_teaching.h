#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "calibration/teach_file.h"
#include "demo/demo_options.h"
#include "simulator/told.h"

namespace edgepose {

/// The goal of the demonstration as a file for the controller. kTaught: the tool is taught at five places in
/// simulated time, in this process, by the simulator's camera (which claims the intrinsics that are `told`)
/// and the service's own code with the service's own model `model_file`; as somebody would do who leads the
/// arm there by hand. kExact: the truth, under the same kind. `note` is called now and then; what it throws
/// ends it. Throws InputError if the model is not found often enough.
TaughtFile make_goal(const WorkCell& cell, const ToldEquipment& told, const DemoOptions& options,
                     const std::filesystem::path& model_file,
                     const std::function<void(const std::string& progress)>& note);

}  // namespace edgepose
