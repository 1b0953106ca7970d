#include "common/command_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace edgepose {
namespace {

enum class Goal : uint8_t { kTaught, kExact };

/// A program with one command, as ours are made.
struct Program {
  CLI::App app;
  std::string shard, set;
  int threads = 0;
  uint64_t seed = 0;
  double shift = 0;
  std::optional<double> rate;
  std::vector<std::string> objects;
  Goal goal = Goal::kTaught;
  bool noise = true, all = false;

  Program() {
    app.name("program");
    app.require_subcommand(1);
    CLI::App* run = app.add_subcommand("run");
    run->add_option("SET", set);
    run->add_option("--shard", shard);
    run->add_option("--threads", threads)->check(CLI::Range(0, 256));
    run->add_option("--seed", seed);
    run->add_option("--shift-mm", shift)->check(CLI::Range(0.0, 1000.0));
    run->add_option("--rate", rate);
    run->add_option("--objects", objects)->delimiter(',');
    run->add_flag("--all", all);
    run->add_option("--only", shard)->check(CLI::IsMember({"stages", "points"}));
    choose<Goal>(run->add_option("--goal", goal), {{"taught", Goal::kTaught}, {"exact", Goal::kExact}});
    choose<bool>(run->add_option("--noise", noise), {{"paper", true}, {"none", false}});
    check_values(app);
  }
  /// What is said of `program run ARGUMENTS...`; nothing if all is well.
  std::string fault(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "run");
    std::reverse(arguments.begin(), arguments.end());
    try {
      app.parse(arguments);
      return "";
    } catch (const CLI::ParseError& error) {
      return command_line_fault(app, error);
    }
  }
};

const std::string kHint = " (program run --help shows the options)";

TEST(CommandLine, WhatIsMeantIsTaken) {
  Program program;
  EXPECT_EQ(program.fault({"data/a", "--shard", "1/2", "--threads", "8", "--seed", "18446744073709551615",
                           "--shift-mm", "1e2", "--rate", "-0.5", "--objects", "a,b", "--goal", "Exact",
                           "--noise", "none", "--all"}),
            "");
  EXPECT_EQ(program.seed, 18446744073709551615u);
  EXPECT_EQ(program.shift, 100);
  EXPECT_EQ(program.rate, -0.5);
  EXPECT_EQ(program.objects.size(), 2u);
  EXPECT_EQ(program.goal, Goal::kExact);
  EXPECT_FALSE(program.noise);
  EXPECT_TRUE(program.all);
}

TEST(CommandLine, NoValueMayBeEmpty) {
  for (const std::string option : {"--shard", "--threads", "--seed", "--objects", "--only"})
    EXPECT_EQ(Program().fault({option, ""}), option + ": expected a value, found an empty one" + kHint);
  EXPECT_EQ(Program().fault({"--rate", ""}), "--rate: expected a value, found an empty one" + kHint);
  EXPECT_EQ(Program().fault({"--shard="}), "--shard: expected a value, found none" + kHint);
  EXPECT_EQ(Program().fault({""}), "SET: expected a value, found an empty one" + kHint);
  EXPECT_EQ(Program().fault({"--goal", ""}), "--goal: expected a value, found an empty one" + kHint);
  EXPECT_EQ(Program().fault({"--shard"}), "--shard: expected a value, found none" + kHint);
}

TEST(CommandLine, NumbersAreNumbers) {
  EXPECT_EQ(Program().fault({"--seed", "-1"}),
            "--seed: expected a whole number, not negative, found '-1'" + kHint);
  EXPECT_EQ(Program().fault({"--seed", "18446744073709551616"}),
            "--seed: expected a whole number, not negative, found '18446744073709551616'" + kHint);
  EXPECT_EQ(Program().fault({"--threads", "abc"}), "--threads: expected a whole number, found 'abc'" + kHint);
  EXPECT_EQ(Program().fault({"--threads", "-1"}),
            "--threads: expected a number from 0 to 256, found '-1'" + kHint);
  EXPECT_EQ(Program().fault({"--shift-mm", "nan"}),
            "--shift-mm: expected a finite number, found 'nan'" + kHint);
  EXPECT_EQ(Program().fault({"--rate", "inf"}), "--rate: expected a finite number, found 'inf'" + kHint);
  EXPECT_EQ(Program().fault({"--shift-mm", "x to 3"}),
            "--shift-mm: expected a number from 0 to 1000, found 'x to 3'" + kHint);
  EXPECT_LT(Program().fault({"--seed", std::string(100'000, '9')}).size(), 300u);
}

TEST(CommandLine, ChoicesAreNamed) {
  EXPECT_EQ(Program().fault({"--goal", "hole"}), "--goal: expected exact|taught, found 'hole'" + kHint);
  EXPECT_EQ(Program().fault({"--goal", "1"}), "--goal: expected exact|taught, found '1'" + kHint);
  EXPECT_EQ(Program().fault({"--only", "all"}),
            "--only: expected one of stages, points, found 'all'" + kHint);
}

TEST(CommandLine, WhatIsUnknownIsNamedInOrderAndWithTheHelpOfItsCommand) {
  EXPECT_EQ(Program().fault({"--shart", "1/2"}),
            "no option is called '--shart'; did you mean --shard?" + kHint);
  EXPECT_EQ(Program().fault({"--deadline-ms=0"}), "no option is called '--deadline-ms'" + kHint);
  EXPECT_EQ(Program().fault({"a", "b", "c"}), "unexpected argument 'b'" + kHint);
  Program program;
  try {
    program.app.parse(std::vector<std::string>{});
    FAIL();
  } catch (const CLI::ParseError& error) {
    EXPECT_EQ(command_line_fault(program.app, error),
              "A subcommand is required (program --help shows the commands)");
  }
}

}  // namespace
}  // namespace edgepose
