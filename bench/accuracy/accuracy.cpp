/// edgepose_accuracy: whether the matcher still finds what it found, over every test set of a folder.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <set>

#include "bench/accuracy/floor_file.h"
#include "common/atomic_file.h"
#include "common/command_line.h"
#include "common/error.h"
#include "common/output_target.h"
#include "evaluation/score.h"
#include "evaluation/table.h"
#include "files/bop_set.h"

namespace edgepose::bench {
namespace {

constexpr const char* kAccuracyExamples = R"(Examples:
  edgepose_accuracy data/                       # every BOP set in data/, beside bench/accuracy_floor.csv
  edgepose_accuracy data/ --sets range,spine    # only these
  edgepose_accuracy data/ --write-floor         # what there is now becomes the floor: for a matcher known to be better

Poses are counted as `edgepose eval` does, accepted or not. A set may lose one instance at each limit.
Exit code: 0 nothing lost, 1 a set lost more, is missing or has changed, 2 bad input (one line on stderr says what).)";

struct AccuracyCommand {
  std::filesystem::path data, floor = EDGEPOSE_SOURCE_DIR "/bench/accuracy_floor.csv";
  std::vector<std::string> sets;
  bool write = false;
  int threads = 0;

  void add_options(CLI::App& app);
  bool run() const;  ///< whether nothing was lost

 private:
  std::set<std::string> folders() const;
  SetCounts count(const std::set<std::string>& names) const;
  bool compare(const SetCounts& before, const SetCounts& now) const;
};

void AccuracyCommand::add_options(CLI::App& app) {
  app.add_option("DATA", data, "Folder with test sets, each a BOP folder")->required();
  app.add_option("--sets", sets, "Only these (names of folders)")->delimiter(',');
  app.add_option("--floor", floor, "What is to be kept (default: bench/accuracy_floor.csv)");
  app.add_flag("--write-floor", write, "Write that file instead, from what is found now");
  app.add_option("--threads", threads, "Threads; 0 = all cores; never changes the result")
      ->check(CLI::Range(0, 256));
  app.footer(kAccuracyExamples);
}

/// The sets there are, of those that are wanted.
std::set<std::string> AccuracyCommand::folders() const {
  std::error_code failure;
  std::set<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator(data, failure)) {
    const std::string name = entry.path().filename().string();
    const bool wanted = sets.empty() || std::find(sets.begin(), sets.end(), name) != sets.end();
    if (!wanted || !looks_like_bop(entry.path())) continue;
    if (name.find_first_of(",\"\r\n") != std::string::npos)
      throw InputError::at(data.string(), "names of sets that a CSV file can hold", one_line(name));
    found.insert(name);
  }
  if (failure) throw InputError::at(data.string(), "a folder with test sets", failure.message());
  for (const std::string& name : sets)
    if (!found.count(name)) throw InputError::at(data.string(), "the set " + name, "none of that name");
  if (found.empty()) throw InputError::at(data.string(), "test sets in the BOP format", "none");
  return found;
}

SetCounts AccuracyCommand::count(const std::set<std::string>& names) const {
  SetCounts counts;
  EvalOptions options;
  options.threads = threads;
  for (const std::string& name : names) {
    std::cerr << "evaluating " << one_line(name) << '\n';
    const TestSet set = read_test_set(data / name);
    const Evaluation evaluation = run_evaluation(set, train_models(set, options), options);
    const Recall recall = score_results(set, make_pose_errors(set), evaluation.rows).best_guesses;
    counts[name] = {recall.instances, {recall.correct[1], recall.correct[2]}};
  }
  return counts;
}

/// Prints the table; what is missing is in it, and on stderr.
bool AccuracyCommand::compare(const SetCounts& before, const SetCounts& now) const {
  bool passed = true;
  Table table({"set", "instances", "floor at 0.05 d", "now at 0.05 d", "floor at 0.10 d", "now at 0.10 d",
               "verdict"});
  for (const auto& [set, count] : now) {
    const auto floor_of = before.find(set);
    const bool known = floor_of != before.end();
    const Verdict verdict = known ? judge(floor_of->second, count) : Verdict{true, "NO FLOOR YET"};
    const auto floor_text = [&](size_t k) { return known ? count_text(floor_of->second.correct[k]) : "-"; };
    table.add({set, count_text(count.instances), floor_text(0), count_text(count.correct[0]), floor_text(1),
               count_text(count.correct[1]), verdict.text});
    passed = passed && verdict.passed;
  }
  for (const auto& [set, count] : before) {
    const bool wanted = sets.empty() || std::find(sets.begin(), sets.end(), set) != sets.end();
    if (!wanted || now.count(set)) continue;
    table.add({set, count_text(count.instances), count_text(count.correct[0]), "-",
               count_text(count.correct[1]), "-", "MISSING, NOT CHECKED"});
    std::cerr << "edgepose_accuracy: " << set << ": no such set in " << data.string() << ": NOT CHECKED\n";
    passed = false;
  }
  std::cout << table.markdown() << (passed ? "\nnothing lost\n" : "\nNOT ALL IS KEPT\n");
  return passed;
}

bool AccuracyCommand::run() const {
  const std::set<std::string> names = folders();
  if (write) {
    if (!sets.empty()) throw InputError::at("--write-floor", "all sets", "--sets");
    check_output(floor);
    const SetCounts now = count(names);
    write_file_atomically(floor, format_floor(now));
    std::cout << floor.string() << ": " << now.size() << " sets\n";
    return true;
  }
  const SetCounts before = read_floor(floor);
  return compare(before, count(names));
}

int refuse_accuracy(const std::string& message) {
  std::cerr << "edgepose_accuracy: " << one_line(message) << std::endl;
  return 2;
}

}  // namespace
}  // namespace edgepose::bench

int main(int argc, char** argv) {
  edgepose::bench::AccuracyCommand command;
  CLI::App app{"Checks that the matcher still finds what it found, over every test set of a folder."};
  app.name("edgepose_accuracy");
  command.add_options(app);
  edgepose::check_values(app);
  try {
    app.parse(argc, argv);
    const bool passed = command.run();
    if (!std::cout.flush()) return edgepose::bench::refuse_accuracy("standard output: cannot write");
    return passed ? 0 : 1;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help
    return edgepose::bench::refuse_accuracy(edgepose::command_line_fault(app, error));
  } catch (const std::exception& error) {
    return edgepose::bench::refuse_accuracy(error.what());
  }
}
