#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <sstream>

#include "common/error.h"
#include "controller/controller_options.h"

namespace edgepose::test {
namespace {

std::string servo_sample() {
  std::ostringstream text;
  text << std::ifstream(std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "config/edgepose-servo.toml").rdbuf();
  return text.str();
}

TEST(ControllerConfig, TheSampleHoldsEveryKeyWithItsDefault) {
  ControllerOptions defaults, read;
  const std::string text = std::regex_replace(servo_sample(), std::regex("(^|\n)# ([a-z_]+ = )"), "$1$2");
  apply_toml(text, "config/edgepose-servo.toml", controller_keys(read));
  const auto expected = controller_keys(defaults), found = controller_keys(read);
  for (size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(to_toml(found[i]), to_toml(expected[i])) << expected[i].path;
  for (const SettingKey& key : expected) {
    const std::string name = key.path.substr(key.path.find('.') + 1);
    EXPECT_THAT(servo_sample(), testing::HasSubstr("\n# " + name + " = ")) << key.path;
  }
}

TEST(ControllerConfig, AsItIsItChangesNothing) {
  ControllerOptions defaults, read;
  apply_toml(servo_sample(), "config/edgepose-servo.toml", controller_keys(read));
  const auto expected = controller_keys(defaults), found = controller_keys(read);
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(to_toml(found[i]), to_toml(expected[i]));
}

TEST(ControllerConfig, NamesWhatIsWrong) {
  const auto fault_of = [](const std::string& text) -> std::string {
    try {
      ControllerOptions options;
      options.model = options.hand_eye = options.tool = "x";
      apply_toml(text, "s.toml", controller_keys(options));
      options.check("s.toml");
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(fault_of(""), "");
  EXPECT_THAT(fault_of("[motion]\njerk = -1.0"), testing::HasSubstr("jerk"));
  EXPECT_THAT(fault_of("[controller]\nrt_priority = 100"),
              testing::HasSubstr("rt_priority: expected 0 to 99"));
  EXPECT_THAT(fault_of("[drives]\ncounts_per_turn = 1.0"),
              testing::HasSubstr("drives.scale.counts_per_turn"));
  EXPECT_THAT(fault_of("[controller]\nmodel = \"\""), testing::HasSubstr("controller.model"));
  EXPECT_THAT(fault_of("[controller]\nbus = 3"), testing::HasSubstr("s.toml:2"));
}

}  // namespace
}  // namespace edgepose::test
