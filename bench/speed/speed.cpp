/// edgepose_speed: what detection and tracking cost, and what that depends on, as Markdown tables and curves.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>
#include <numbers>

#include "bench/speed/parts.h"
#include "common/atomic_file.h"
#include "common/command_line.h"
#include "common/error.h"
#include "common/output_target.h"
#include "evaluation/selection.h"

namespace edgepose::bench {
namespace {

constexpr const char* kSpeedExamples = R"(Examples:
  edgepose_speed                                             # the project's own sample: six images of the phantom
  edgepose_speed data/range --images 0-9 --csv range.csv     # everything; bench/plot_speed.sh draws the curves
  edgepose_speed data/spine --only stages,tracking --repeat 5
  edgepose_speed data/industrial --only deadline --csv industrial.csv
  edgepose_speed data/range --only models --max-models 100 --images 0-3

Times are medians over --repeat, variants asked in turns; questions are the objects that the ground truth lists.
Exit code: 0 done, 2 bad input (one line on stderr says what).)";

struct Part {
  const char* name;
  std::string (*run)(SpeedRun&);
};
constexpr std::array<Part, 8> kParts = {{{"stages", time_stages},
                                         {"tracking", time_tracking},
                                         {"points", time_scene_points},
                                         {"points", time_model_points},
                                         {"models", time_models},
                                         {"threads", time_threads},
                                         {"memory", list_memory},
                                         {"deadline", time_deadlines}}};

struct SpeedCommand {
  std::filesystem::path set = EDGEPOSE_SOURCE_DIR "/models/sample_set", csv;
  std::string images;
  std::vector<std::string> objects, only;
  int repeat = 3, threads = 0, max_threads = 0, max_models = 50;
  double shift_mm = 2, turn_deg = 2;
  uint64_t seed = 1;

  void add_options(CLI::App& app);
  void run() const;

 private:
  TestSet read() const;
  bool wanted(const std::string& part) const {
    return only.empty() || std::find(only.begin(), only.end(), part) != only.end();
  }
};

void SpeedCommand::add_options(CLI::App& app) {
  std::vector<std::string> names;
  for (const Part& part : kParts)
    if (names.empty() || names.back() != part.name) names.emplace_back(part.name);
  app.add_option("SET", set, "Test set: a BOP folder (default: the project's own sample)");
  app.add_option("--images", images, "Only these image numbers: 3, 3-7, 3- or -7");
  app.add_option("--objects", objects, "Only these objects (names or numbers)")->delimiter(',');
  app.add_option("--only", only,
                 "Only these parts: stages, tracking, points, models, threads, memory, deadline")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  app.add_option("--repeat", repeat, "How often each question is asked (default 3)")
      ->check(CLI::Range(1, 1000));
  app.add_option("--threads", threads, "Threads of all parts but `threads`; 0 = all cores")
      ->check(CLI::Range(0, 256));
  app.add_option("--max-threads", max_threads, "Most threads of the part `threads`; 0 = as many as cores")
      ->check(CLI::Range(0, 256));
  app.add_option("--max-models", max_models, "Most models of the part `models` (default 50)")
      ->check(CLI::Range(1, 1000));
  app.add_option("--shift-mm", shift_mm, "How far tracking starts off the truth (default 2)")
      ->check(CLI::Range(0.0, 1000.0));
  app.add_option("--turn-deg", turn_deg, "... and turned by how much (default 2)")
      ->check(CLI::Range(0.0, 180.0));
  app.add_option("--seed", seed, "Of the directions in which (default 1)");
  app.add_option("--csv", csv, "File for the curves, for bench/plot_speed.sh");
  app.footer(kSpeedExamples);
}

TestSet SpeedCommand::read() const {
  Selection selection;
  selection.objects = objects;
  if (!images.empty()) parse_images(images, selection);
  return select(read_test_set(set), selection);
}

void SpeedCommand::run() const {
  TestSet read_set = read();
  if (!csv.empty()) check_output(csv, read_set.descriptions);
  SpeedRun run = prepare_run(std::move(read_set), threads);
  run.repeat = repeat;
  run.max_threads = max_threads;
  run.max_models = max_models;
  run.shift = 1e-3 * shift_mm;
  run.turn = turn_deg * std::numbers::pi / 180;
  run.seed = seed;
  std::cout << "# " << one_line(run.set.name) << ": " << run.images.size() << " images, "
            << run.questions.size() << " questions, each asked " << repeat << " times, "
            << (threads > 0 ? std::to_string(threads) + " thread(s)" : std::string("all cores")) << '\n';
  for (const Part& part : kParts)
    if (wanted(part.name)) std::cout << '\n' << part.run(run) << std::flush;
  if (!csv.empty()) write_file_atomically(csv, run.curves.csv());
}

int refuse(const std::string& message) {
  std::cerr << "edgepose_speed: " << one_line(message) << std::endl;
  return 2;
}

}  // namespace
}  // namespace edgepose::bench

int main(int argc, char** argv) {
  edgepose::bench::SpeedCommand command;
  CLI::App app{"Times the stages of detection and tracking over a test set, and what they depend on."};
  app.name("edgepose_speed");
  command.add_options(app);
  edgepose::check_values(app);
  try {
    app.parse(argc, argv);
    command.run();
    return std::cout.flush() ? 0 : edgepose::bench::refuse("standard output: cannot write");
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return edgepose::bench::refuse(edgepose::command_line_fault(app, error));
  } catch (const std::exception& error) {
    return edgepose::bench::refuse(error.what());
  }
}
