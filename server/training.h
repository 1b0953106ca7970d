#pragma once
#include <atomic>
#include <stdexcept>

#include "server/training_request.h"

namespace edgepose {

/// Training ended without a model: crash, memory, time.
class TrainingFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Trains in a child process (this program, started anew) with limits on memory and time and at a low
/// priority; files are read there only, so that what is wrong with them costs no more than the child. Returns
/// when it is done. Throws InputError for what the child says is bad input, TrainingFailure if it did not end
/// by itself (`stop`: it is killed). The files are in `incoming`, or nowhere.
TrainingResult train_in_child(const TrainingRequest& request, const std::filesystem::path& incoming,
                              const TrainOptions& options, const TrainingLimits& limits,
                              const std::atomic<bool>& stop);

/// The child's part: reads the request from standard input, prints the result. Exit code 0, or 2 with a line
/// on stderr.
int run_training_child();

/// Its exit code when memory ran out.
inline constexpr int kOutOfMemory = 3;

/// The argument that makes this program a training child.
inline constexpr const char* kTrainingChild = "--training-child";

}  // namespace edgepose
