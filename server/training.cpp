#include "server/training.h"

#include <cstring>

#include "common/error.h"
#include "daemon/clock.h"
#include "files/number_text.h"
#include "server/child_process.h"
#include "server/training_messages.h"

namespace edgepose {
namespace {

/// The last line, which is the child's verdict.
std::string last_line(std::string text) {
  while (!text.empty() && text.back() == '\n') text.pop_back();
  const size_t start = text.rfind('\n');
  return one_line(start == std::string::npos ? text : text.substr(start + 1)).substr(0, 1000);
}

/// What the child has written, finished or not.
void remove_all_of(const std::string& stem, const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().filename().string().find(stem) != std::string::npos)
      std::filesystem::remove(entry.path(), ignored);
}

void demand_success(const ChildEnd& end, const TrainingRequest& request, const TrainingLimits& limits) {
  const std::string what = request.mesh.empty() ? request.model : request.mesh;
  if (end.stopped) throw TrainingFailure(what + ": the daemon is stopping");
  if (end.timed_out)
    throw TrainingFailure(what + ": training took longer than " + number_text(limits.seconds) +
                          " s (training.seconds) and was ended");
  if (end.signal != 0)
    throw TrainingFailure(what + ": training crashed (" + strsignal(end.signal) + "); the daemon goes on");
  if (end.exit_code == kCouldNotStart)
    throw TrainingFailure(what + ": the process that trains could not be started");
  if (end.exit_code == kOutOfMemory)
    throw TrainingFailure(what + ": training needs more than " + std::to_string(limits.memory_mb) +
                          " MB (training.memory_mb)");
  if (end.exit_code != 0) throw InputError(end.err.empty() ? what + ": training failed" : last_line(end.err));
}

}  // namespace

TrainingResult train_in_child(const TrainingRequest& request, const std::filesystem::path& incoming,
                              const TrainOptions& options, const TrainingLimits& limits,
                              const std::atomic<bool>& stop) {
  const std::string stem = request.name + "-" + std::to_string(utime_now());
  TrainingOrder order{request, incoming / (stem + ".model"), incoming / (stem + ".plan.json"), options};
  order.options.threads = limits.threads;
  try {
    const ChildEnd end = run_self({kTrainingChild}, to_text(order),
                                  {static_cast<uint64_t>(limits.memory_mb) << 20, limits.seconds, &stop});
    demand_success(end, request, limits);
    const TrainingReport report = parse_report(end.out);
    return {{request.name, request.mesh.empty() ? request.model : request.mesh, order.model_out,
             report.has_plan ? order.plan_out : "", request.activate},
            report.seconds,
            report.notes};
  } catch (...) {
    remove_all_of(stem, incoming);
    throw;
  }
}

}  // namespace edgepose
