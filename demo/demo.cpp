#include "demo/demo.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "bus/steady_clock.h"
#include "common/error.h"
#include "common/output_target.h"
#include "demo/demo_processes.h"
#include "demo/demo_report.h"
#include "demo/demo_teaching.h"

namespace edgepose {
namespace {

using nlohmann::json;

constexpr double kLook = 0.1;      // [s] between looks at the controller
constexpr double kStep = 2;        // [s] between lines of progress
constexpr double kStay = 1;        // [s] at the goal, for the last picture
constexpr size_t kMostFaults = 3;  // after which it goes again
constexpr int kPosesBeforeGo = 5;  // that the controller must have taken

std::string formatted_step(double time, const json& controller, const json& truth) {
  const double tip =
      std::hypot(truth.at("tip_along_m").get<double>(), truth.at("tip_across_m").get<double>());
  char text[160];
  std::snprintf(text, sizeof(text), "%6.1f s  %-11.20s  tip %7.2f mm from the entry, axis %6.2f degrees off",
                time, controller.at("state").get<std::string>().c_str(), 1e3 * tip,
                180 / std::numbers::pi * truth.at("axis_angle_rad").get<double>());
  return text;
}

/// The options with everything found and made absolute.
DemoOptions completed(DemoOptions options) {
  if (options.cell.model.empty() && options.cell.plan.empty())
    if (const std::filesystem::path phantom = phantom_folder(); !phantom.empty()) {
      options.cell.model = phantom / "phantom.ply";
      options.cell.plan = phantom / "drill_plan.json";
    }
  if (const std::string fault = options.check(); !fault.empty()) throw InputError("demo: " + fault);
  for (std::filesystem::path* path : {&options.cell.model, &options.cell.plan, &options.output})
    *path = std::filesystem::absolute(*path);
  return options;
}

class Demo {
 public:
  Demo(DemoOptions options, std::string command, const std::stop_token& stop,
       std::function<void(const std::string&)> say)
      : options_(completed(std::move(options))),
        command_(std::move(command)),
        say_(std::move(say)),
        cell_(make_work_cell(options_.cell)),
        told_(draw_told(cell_, options_.noise ? ToldNoise{} : ToldNoise::none(), options_.seed)),
        lcm_url_(private_lcm_url()),
        recorder_(parse_udpm_url(lcm_url_), cell_.plan.model),
        processes_(options_, folder_, lcm_url_, stop) {
    check_output_folder(options_.output);
    options_.cell.target = cell_.target;
  }

  DemoEnd run() {
    const std::filesystem::path model = train();
    std::optional<TaughtFile> goal;
    if (options_.goal != DemoGoal::kCalibrations) {
      goal = make_goal(cell_, told_, options_, model, [this](const std::string& progress) {
        processes_.check();
        if (!progress.empty()) say_(progress);
      });
      write_taught(folder_ / "taught.json", *goal);
    }
    say_("edgepose-sim and edgepose-servo start");
    processes_.start_simulator();
    processes_.start_controller(cell_.plan.model, goal.has_value());
    set_out();
    const json last = watch();
    const int64_t end_ns = steady_ns();
    processes_.end();
    DemoRun run{options_,
                cell_,
                told_,
                last.at("state"),
                last.at("fault"),
                goal,
                read_track(folder_ / "arm.csv", folder_ / "truth.csv", end_ns),
                recorder_.first(),
                recorder_.newest(),
                recorder_.frames(),
                recorder_.answers(),
                recorder_.found(),
                faults_,
                last,
                processes_.versions(),
                command_};
    const std::string warning = write_demo_report(run, folder_ / "");
    return {run.converged(), verdict(run), warning};
  }

 private:
  /// The service learns the model. Returns the file in which it keeps it.
  std::filesystem::path train() {
    say_("edgeposed starts, and learns " + cell_.plan.model);
    processes_.start_service();
    const json model = processes_.service(
        "models.register",
        {{"name", cell_.plan.model}, {"mesh", options_.cell.model}, {"plan", options_.cell.plan}});
    char text[64];
    std::snprintf(text, sizeof(text), "trained in %.1f s", model.at("training_seconds").get<double>());
    say_(text);
    return folder_ / "state" / model.at("file").get<std::string>();
  }

  void set_out() {
    processes_.controller("arm");
    say_("armed; waits for poses of the service");
    go();
  }

  /// As soon as the controller has seen the model and obeys.
  void go() {
    const int64_t last = steady_ns() + static_cast<int64_t>(1e9 * options_.start_seconds);
    for (json status; true; processes_.pause(kLook)) {
      status = processes_.controller("status");
      if (status.at("state") == "fault") arm_again(status.at("fault"));
      const bool late = steady_ns() > last;
      try {
        if (late || status.at("poses_taken").get<int64_t>() >= kPosesBeforeGo) {
          processes_.controller("go", {{"target", cell_.target}});
          break;
        }
      } catch (const InputError&) {
        if (late) throw;  // until then the next frame may please it better
      }
    }
    say_("on the way to " + cell_.target);
  }

  /// A machine that is too busy for a moment stops the drives, as it must: then the arm is set going again,
  /// as its operator would. The report tells of each time.
  void arm_again(const std::string& fault) {
    if (faults_.size() >= kMostFaults)
      throw InputError("edgepose-servo: fault after fault, the last: " + fault);
    faults_.push_back(one_line(fault));
    say_("fault: " + faults_.back() + "; reset, and armed again");
    processes_.controller("reset");
    processes_.controller("arm");
  }

  /// Until the arm is there, has failed, or its time is over. The controller's last status.
  json watch() {
    const int64_t begin = steady_ns();
    const auto now = [&] { return 1e-9 * static_cast<double>(steady_ns() - begin); };
    json status = processes_.controller("status");
    const auto is_over = [&] {
      const std::string state = status.at("state");
      return state == "converged" || (state == "fault" && faults_.size() >= kMostFaults) ||
             state == "stopped" || now() > options_.seconds;
    };
    for (double next = 0; !is_over(); processes_.pause(kLook)) {
      if (status.at("state") == "fault") {
        arm_again(status.at("fault"));
        go();
      }
      if (now() >= next) {
        say_(formatted_step(now(), status, processes_.simulator("status")));
        next += kStep;
      }
      status = processes_.controller("status");
    }
    processes_.pause(kStay);
    status = processes_.controller("status");
    say_(formatted_step(now(), status, processes_.simulator("status")));
    return status;
  }

  DemoOptions options_;
  const std::string command_;
  const std::function<void(const std::string&)> say_;
  const WorkCell cell_;
  const ToldEquipment told_;
  const PrivateFolder folder_{"edgepose-demo-"};
  const std::string lcm_url_;
  FrameRecorder recorder_;
  std::vector<std::string> faults_;  ///< after which the arm was set going again
  DemoProcesses processes_;          // last: ends before the folder goes
};

}  // namespace

DemoEnd run_demo(DemoOptions options, const std::string& command, const std::stop_token& stop,
                 const std::function<void(const std::string&)>& say) {
  return Demo(std::move(options), command, stop, say).run();
}

}  // namespace edgepose
