#pragma once
#include <string>

#include "bench/speed/speed_run.h"

/// The parts of edgepose_speed. Each asks its questions and returns Markdown; those with a curve add its
/// points to the run's.
namespace edgepose::bench {

/// Where the time of a detection goes, stage by stage.
std::string time_stages(SpeedRun& run);
/// A step of tracking, and preprocessing by itself: of the image, and of the window that the service cuts
/// out.
std::string time_tracking(SpeedRun& run);
/// Cost over scene points: less of the scene around the object, and the same scene thinned more or less.
std::string time_scene_points(SpeedRun& run);
/// Cost over model points: TrainOptions::sampling_step.
std::string time_model_points(SpeedRun& run);
/// Cost over the number of models asked for in one image.
std::string time_models(SpeedRun& run);
/// Cost over threads.
std::string time_threads(SpeedRun& run);
/// What each trained model takes in memory.
std::string list_memory(SpeedRun& run);
/// Recall and real time over the deadline.
std::string time_deadlines(SpeedRun& run);

}  // namespace edgepose::bench
