#include "client/cli/calibrate_command.h"

#include <filesystem>
#include <iostream>
#include <memory>

#include "arm/rigid_motion.h"
#include "calibration/hand_eye_file.h"
#include "calibration/teach_file.h"
#include "calibration/utc_now.h"
#include "client/cli/option_checks.h"
#include "client/cli/text.h"
#include "common/error.h"
#include "common/output_target.h"

namespace edgepose {
namespace {

constexpr const char* kHandEyeExamples = R"(Examples:
  edgepose calibrate hand-eye samples.json -o hand_eye.json

SAMPLES is JSON, metres and radians: {"kind": "hand-eye-samples", "samples": [{"joints_rad": [6 angles] or
"base_T_flange": {...}, "camera_T_target": {"rotation_vector_rad": [x, y, z], "translation_m": [x, y, z]}}, ...]}.
The target stays in place; 15 to 20 samples, the wrist tilted in all directions. docs/servoing.md has more.)";

constexpr const char* kTeachExamples = R"(Examples:
  edgepose teach record.json -o taught.json
  edgepose teach record.json --references 1 -o taught.json    # fewer: less exact

RECORD is JSON, metres and radians: {"kind": "teach-record", "model": "l3", "references": [{"name": "left",
"model_T_tool": {...}, "camera_T_model": [30 or more poses measured while the tool was there]}, ...]}.
docs/servoing.md has more.)";

constexpr double kMillimetres = 1e3;

struct Files {
  std::filesystem::path in, out;
  int references = TeachingOptions().min_references;
};

/// What the solver refuses, led by the file it is about.
template <typename Work>
auto about(const std::filesystem::path& file, Work work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(file.string() + ": " + error.what());
  }
}

void print_transform(const char* name, const RigidTransform& transform) {
  const Eigen::Vector3d turn = rotation_vector(transform.linear()) * kDegrees;
  const Eigen::Vector3d place = transform.translation() * kMillimetres;
  std::cout << formatted("%-17s%9.3f %9.3f %9.3f mm, rotation vector %9.4f %9.4f %9.4f degrees\n", name,
                         place.x(), place.y(), place.z(), turn.x(), turn.y(), turn.z());
}

void calibrate_hand_eye(const Files& files) {
  check_output(files.out, {files.in});
  const std::vector<HandEyeSample> samples = read_hand_eye_samples(files.in, aubo_i5());
  const HandEye found = about(files.in, [&] { return solve_hand_eye(samples); });
  write_hand_eye(files.out, {utc_now(), found.method, found.flange_T_camera, static_cast<int>(samples.size()),
                             found.rms, found.worst});
  print_transform("flange_T_camera", found.flange_T_camera);
  std::cout << "method           " << found.method << '\n';
  for (size_t i = 0; i < found.residuals.size(); ++i)
    std::cout << formatted("sample %-10zu%9.3f mm %9.4f degrees\n", i + 1,
                           found.residuals[i].translation * kMillimetres,
                           found.residuals[i].rotation * kDegrees);
  std::cout << formatted("root mean square %9.3f mm %9.4f degrees\n", found.rms.translation * kMillimetres,
                         found.rms.rotation * kDegrees);
  std::cout << "written          " << files.out.string() << '\n';
}

void teach_tool(const Files& files) {
  check_output(files.out, {files.in});
  const TeachRecord record = read_teach_record(files.in);
  TeachingOptions options;
  options.min_references = files.references;
  const TaughtTool taught = about(files.in, [&] { return teach(record.references, options); });
  write_taught(files.out, {utc_now(), record.model, taught});
  print_transform("camera_T_tool", taught.camera_T_tool);
  std::cout << "reference            poses   residual mm       deg   noise mm       deg\n";
  for (const TaughtTool::Residual& residual : taught.residuals)
    std::cout << formatted("%-20s %5d %13.3f %9.4f %10.3f %9.4f\n", one_line(residual.name).c_str(),
                           residual.poses, residual.translation * kMillimetres, residual.rotation * kDegrees,
                           residual.noise.translation * kMillimetres, residual.noise.rotation * kDegrees);
  std::cout << "written              " << files.out.string() << '\n';
}

}  // namespace

void add_calibrate_command(CLI::App& app) {
  CLI::App* calibrate = app.add_subcommand("calibrate", "Calibrate what the arm is told of its equipment");
  calibrate->require_subcommand(1);
  CLI::App* hand_eye = calibrate->add_subcommand("hand-eye", "Find where the camera is on the arm's flange");
  auto files = std::make_shared<Files>();
  hand_eye->add_option("SAMPLES", files->in, "Poses of arm and target (JSON)")->required();
  add_output_option(*hand_eye, "-o,--output", files->out, "Calibration to write (JSON)")->required();
  hand_eye->footer(kHandEyeExamples);
  hand_eye->callback([files] { calibrate_hand_eye(*files); });
}

void add_teach_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("teach", "Learn where the camera sees the tool, from known places touched");
  auto files = std::make_shared<Files>();
  command->add_option("RECORD", files->in, "Poses measured at each reference (JSON)")->required();
  add_output_option(*command, "-o,--output", files->out, "What was learned (JSON)")->required();
  command->add_option("--references", files->references, "References that there must be at least")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command->footer(kTeachExamples);
  command->callback([files] { teach_tool(*files); });
}

}  // namespace edgepose
