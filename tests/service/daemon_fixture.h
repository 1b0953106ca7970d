#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files/mesh_file.h"
#include "files/model_file.h"
#include "tests/messaging/network_namespace.h"
#include "tests/service/daemon.h"
#include "tests/service/moving_scene.h"
#include "tests/service/peer.h"

namespace edgepose::test {

/// A daemon, and a camera and listener beside it, in a network of the test's own.
class DaemonTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!enter_own_network())
      GTEST_SKIP() << "needs root or user namespaces, and ip (iproute2), for a network of its own";
    peer_ = std::make_unique<Peer>();
  }
  void start(const std::string& config = "") {
    daemon_.reset();
    daemon_ = std::make_unique<Daemon>(folder_ / "", config);
    ASSERT_TRUE(daemon_->ready()) << daemon_->log();
  }
  /// Trained once for all tests: training beside other work takes its time.
  void register_phantom(const std::string& name = "phantom", bool with_plan = true) {
    nlohmann::json params = {{"model", trained_phantom()}, {"name", name}};
    if (with_plan) params["plan"] = phantom_file("drill_plan.json");
    daemon_->result("models.register", params);
  }
  static const std::vector<TrueFrame>& scene() {
    static const auto frames = moving_phantom(10);
    return frames;
  }
  /// The first model's best detection in an answer, if it is accepted.
  static std::optional<RigidTransform> pose_in(const std::optional<Peer::Answer>& answer);

  static std::filesystem::path trained_phantom() {
    static const Folder folder;
    static const std::filesystem::path file = [] {
      save_model(folder / "phantom.model", train_model(read_mesh(phantom_file("phantom.ply")), "phantom"));
      return folder / "phantom.model";
    }();
    return file;
  }

  Folder folder_;
  std::unique_ptr<Peer> peer_;
  std::unique_ptr<Daemon> daemon_;
};

}  // namespace edgepose::test

#include "messaging/transform_message.h"

inline std::optional<edgepose::RigidTransform> edgepose::test::DaemonTest::pose_in(
    const std::optional<Peer::Answer>& answer) {
  if (!answer || answer->poses.answers.empty()) return std::nullopt;
  const auto& detections = answer->poses.answers[0].detections;
  if (detections.empty() || !detections[0].accepted) return std::nullopt;
  return from_message(detections[0].camera_T_model);
}
