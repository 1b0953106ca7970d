/// What is wrong with the controller's input: one clear line, exit code 2, no motion.
#include <fstream>

#include "tests/arm_process/arm_processes.h"

namespace edgepose::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const char* const kHandEye =
    R"({"kind": "hand-eye", "made": "2026-11-23T09:30:00Z", "method": "park", "samples": 9,
 "flange_T_camera": {"rotation": [[1,0,0],[0,1,0],[0,0,1]], "translation_m": [0.1, 0, 0]},
 "residual_rms": {"translation_m": 0, "rotation_rad": 0}, "residual_worst": {"translation_m": 0, "rotation_rad": 0}})";
const char* const kTool = R"({"kind": "tool", "made": "2026-11-23T09:30:00Z", "name": "drill",
 "flange_T_tool": {"rotation": [[1,0,0],[0,1,0],[0,0,1]], "translation_m": [0, 0, 0.3]}})";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, what.size(), by);
}

struct BadInput : testing::Test {
  Folder folder;
  std::string hand_eye = kHandEye, tool = kTool, bus = "unix:" + (folder / "no_bus").string();
  std::vector<std::string> more;
  int runs = 0;

  std::string write(const std::string& name, const std::string& text) {
    std::ofstream(folder / name) << text;
    return folder / name;
  }
  /// Runs it; its one line. It must end with 2.
  std::string line() {
    std::vector<std::string> command = {program("edgepose-servo"),
                                        "run",
                                        "--bus",
                                        bus,
                                        "--model",
                                        "vertebra_phantom",
                                        "--hand-eye",
                                        write("hand-eye.json", hand_eye),
                                        "--tool",
                                        write("tool.json", tool),
                                        "--socket",
                                        folder / "servo.sock"};
    command.insert(command.end(), more.begin(), more.end());
    const std::string log = "log" + std::to_string(++runs);
    Process process(command, folder / log);
    EXPECT_EQ(process.wait(20), 2);
    std::string text = read_text(folder / log);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    return text;
  }
};

TEST_F(BadInput, ValuesThatNobodyMeans) {
  const auto line_of = [&](const std::vector<std::string>& command) {
    const std::string log = "log" + std::to_string(++runs);
    EXPECT_EQ(Process(command, folder / log).wait(20), 2);
    return read_text(folder / log);
  };
  EXPECT_THAT(
      line_of({program("edgepose-servo"), "demo", "-o", folder / "demo", "--seed", "-1"}),
      HasSubstr("--seed: expected a whole number, not negative, found '-1' (edgepose-servo demo --help"));
  EXPECT_THAT(line_of({program("edgepose-servo"), "demo", "-o", folder / "demo", "--goal", "hole"}),
              HasSubstr("--goal: expected calibrations|exact|taught, found 'hole'"));
  EXPECT_THAT(line_of({program("edgepose-sim"), "--model", "m", "--plan", "p", "--seed", "-1"}),
              HasSubstr("--seed: expected a whole number"));
  EXPECT_THAT(line_of({program("edgeposed"), "--state", ""}), HasSubstr("--state: expected a value"));
  more = {"--key", ""};  // else every message would count
  EXPECT_THAT(line(), HasSubstr("--key: expected a value"));
}

TEST_F(BadInput, ABusThatDoesNotExist) {
  EXPECT_THAT(line(), AllOf(HasSubstr("no_bus"), HasSubstr("expected"), HasSubstr("found")));
  bus = "can17";
  EXPECT_THAT(line(), AllOf(HasSubstr("can17"), HasSubstr("expected")));
}

TEST_F(BadInput, AMatrixThatIsNoRotation) {
  hand_eye = replaced(kHandEye, "[1,0,0]", "[1.1,0,0]");
  EXPECT_THAT(line(), AllOf(HasSubstr("hand-eye.json"), HasSubstr("flange_T_camera"), HasSubstr("rotation")));
}

TEST_F(BadInput, AToolTenMetresLong) {
  tool = replaced(kTool, "0.3", "10");
  EXPECT_THAT(line(), AllOf(HasSubstr("tool.json"), HasSubstr("flange_T_tool"), HasSubstr("10")));
}

TEST_F(BadInput, DegreesForRadians) {
  tool = replaced(kTool, R"("rotation": [[1,0,0],[0,1,0],[0,0,1]])", R"("rotation_vector_rad": [0, 90, 0])");
  EXPECT_THAT(line(), AllOf(HasSubstr("rotation_vector_rad"), HasSubstr("degrees")));
}

TEST_F(BadInput, ToolTaughtOnAnotherModel) {
  const std::string residual =
      R"({"name": "a", "poses": 30, "residual_m": 0, "residual_rad": 0, "noise_m": 0, "noise_rad": 0})";
  more = {"--taught",
          write("taught.json", R"({"kind": "taught-tool", "made": "2026-11-23T09:30:00Z", "model": "l4",
    "camera_T_tool": {"rotation": [[1,0,0],[0,1,0],[0,0,1]], "translation_m": [0, 0, 0.3]}, "references": [)" +
                                   residual + "]}")};
  EXPECT_THAT(line(), AllOf(HasSubstr("taught.json"), HasSubstr("'vertebra_phantom'"), HasSubstr("'l4'")));
}

TEST_F(BadInput, MissingOptionsAndWrongOnes) {
  more = {"--config", write("servo.toml", "[gate]\nmax_jmp = 0.1\n")};
  EXPECT_THAT(line(), AllOf(HasSubstr("servo.toml:2"), HasSubstr("max_jump")));
  more = {"--config", write("servo.toml", "[approach]\nstandoff = 40\n")};
  EXPECT_THAT(line(), AllOf(HasSubstr("approach.standoff"), HasSubstr("0.03 to 0.05")));
  more = {"--lcm-url", "tcp://a"};
  EXPECT_THAT(line(), HasSubstr("lcm_url"));
}

class BadTarget : public testing::Test {
 protected:
  void SetUp() override {
    if (!enter_own_network()) GTEST_SKIP() << "no network of its own on this machine";
  }
  static std::string refusal(ArmProcesses& arm, const std::string& method,
                             const nlohmann::json& params = nlohmann::json::object()) {
    try {
      arm.servo(method, params);
      return "";
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  }
};

TEST_F(BadTarget, AnUnknownTargetOrAPlanForAnotherModel) {
  ArmProcesses arm(1);
  arm.servo("arm");
  eventually([&] { return arm.servo("status")["poses_taken"] >= 3; });
  EXPECT_THAT(refusal(arm, "go", {{"target", "left_pedicle"}}),
              AllOf(HasSubstr("left_pedicle"), HasSubstr("did you mean left_pedicle_screw")));
  EXPECT_EQ(arm.state(), "armed");

  ArmProcesses other(1, {}, {"--model", "l4"});
  other.servo("arm");
  EXPECT_TRUE(
      eventually([&] { return other.servo("status")["messages"].contains("frames_without_the_model"); }));
  EXPECT_THAT(refusal(other, "go", {{"target", kHole}}), HasSubstr("'l4'"));
}

TEST_F(BadTarget, ANodeThatDoesNotAnswerIsNamed) {
  ArmProcesses arm(1, {"--absent-node", "3"});
  EXPECT_THAT(refusal(arm, "arm"),
              AllOf(HasSubstr("node 3"), HasSubstr("expected"), HasSubstr("ms"), Not(HasSubstr("node 4"))));
  EXPECT_EQ(arm.state(), "fault");
}

}  // namespace
}  // namespace edgepose::test
