/// Models come and go while frames are answered.
#include <signal.h>

#include <fstream>
#include <set>
#include <thread>

#include "tests/service/daemon_fixture.h"

namespace edgepose {
namespace {

using nlohmann::json;
using test::DaemonTest;
using test::eventually;
using test::phantom_file;

TEST_F(DaemonTest, ModelsAreRegisteredShownAndRemoved) {
  start();
  const json added = daemon_->result(
      "models.register", {{"mesh", phantom_file("phantom.ply")}, {"plan", phantom_file("drill_plan.json")}});
  EXPECT_EQ(added["name"], "phantom");
  EXPECT_EQ(added["plan_targets"].size(), 3u);
  EXPECT_EQ(daemon_->result("models.get", {{"name", "phantom"}})["content_hash"], added["content_hash"]);
  EXPECT_EQ(daemon_->call("models.register", {{"mesh", phantom_file("phantom.ply")}})["error"]["code"], 3);
  daemon_->result("models.register", {{"model", trained_phantom()}, {"replace", true}});
  EXPECT_TRUE(daemon_->result("models.get", {{"name", "phantom"}})["plan"].is_null())
      << "replaced without one";
  EXPECT_FALSE(daemon_->result("models.activate", {{"name", "phantom"}, {"active", false}})["active"]);
  EXPECT_EQ(daemon_->result("models.unregister", {{"name", "phantom"}})["name"], "phantom");
  const json missing = daemon_->call("models.get", {{"name", "phantom"}})["error"];
  EXPECT_EQ(missing["code"], 2);
}

TEST_F(DaemonTest, BadModelsAreRefusedWithOneLine) {
  start();
  const auto error_of = [&](const json& params) {
    const json error = daemon_->call("models.register", params)["error"];
    EXPECT_TRUE(error.is_object()) << params;
    const std::string text = error.value("message", "");
    EXPECT_EQ(text.find('\n'), std::string::npos);
    return text;
  };
  const auto write = [&](const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  };
  const std::string plan = test::read_text(phantom_file("drill_plan.json"));
  const auto spoiled = [&](const std::string& name, const std::string& key, const std::string& value) {
    json changed = json::parse(plan);
    changed["targets"][0][key] = json::parse(value);
    return write(name, changed.dump());
  };
  const std::string mesh = phantom_file("phantom.ply");
  EXPECT_THAT(error_of({{"mesh", (folder_ / "missing.ply").string()}}), testing::HasSubstr("missing.ply"));
  EXPECT_THAT(error_of({{"mesh", write("bad.ply", "no mesh")}}), testing::HasSubstr("bad.ply"));
  EXPECT_THAT(error_of({{"mesh", mesh}, {"plan", spoiled("zero.json", "axis", "[0,0,0]")}}),
              testing::HasSubstr("axis"));
  EXPECT_THAT(error_of({{"mesh", mesh}, {"plan", spoiled("far.json", "entry_mm", "[5000,0,0]")}}),
              testing::HasSubstr("far.json"));
  EXPECT_THAT(error_of({{"mesh", mesh}, {"name", "../escape"}}), testing::HasSubstr("name"));
  EXPECT_THAT(error_of({{"mesh", "relative.ply"}}), testing::HasSubstr("absolute"));
  EXPECT_THAT(error_of({{"mesh", mesh}, {"unti", "mm"}}), testing::HasSubstr("unit"));
  EXPECT_THAT(error_of({{"mesh", "/dev/zero"}}), testing::HasSubstr("/dev/zero"));
  EXPECT_TRUE(daemon_->result("models.list").empty());
  EXPECT_EQ(daemon_->counter("registrations"), 0);
  EXPECT_EQ(daemon_->counter("registrations_failed"), 5);
}

TEST_F(DaemonTest, UnknownNamesAreAnsweredWithTheNearest) {
  start();
  register_phantom();
  const auto message = [&](const std::string& method, const json& params) {
    return daemon_->call(method, params)["error"].value("message", "");
  };
  EXPECT_THAT(message("models.get", {{"name", "phantm"}}), testing::HasSubstr("did you mean phantom"));
  EXPECT_THAT(message("models.activate", {{"name", "phantm"}}), testing::HasSubstr("phantom"));
  EXPECT_THAT(message("models.unregister", {{"name", "phantm"}}), testing::HasSubstr("phantom"));
  EXPECT_THAT(message("detect", {{"models", json::array({"phantm"})}}), testing::HasSubstr("phantom"));
}

/// Under load: whatever happens to the list of models, each answer names models that were active then, with
/// their content, and where they truly are.
TEST_F(DaemonTest, NoFrameIsAnsweredWronglyWhileModelsComeAndGo) {
  start();
  register_phantom("first");
  std::atomic<bool> over = false;
  std::thread camera([&] {
    for (size_t i = 0; !over; ++i) {
      peer_->send(scene()[i % 2].depth);
      std::this_thread::sleep_for(std::chrono::milliseconds(33));
    }
  });
  std::set<int64_t> hashes = {daemon_->result("models.list")[0]["content_hash"].get<int64_t>()};
  for (int round = 0; round < 3 || (peer_->answers().size() < 30 && round < 1000); ++round) {
    const json added = daemon_->result("models.register", {{"model", trained_phantom()}, {"name", "second"}});
    hashes.insert(added["content_hash"].get<int64_t>());
    daemon_->result("models.activate", {{"name", "first"}, {"active", false}});
    daemon_->result("models.unregister", {{"name", "second"}});
    daemon_->result("models.activate", {{"name", "first"}});
  }
  over = true;
  camera.join();
  const Eigen::Vector3d centre(0.0022, 0.0254, -0.0019);
  size_t found = 0;
  for (const auto& [sequence, answer] : peer_->answers()) {
    std::set<std::string> names;
    for (const auto& model : answer.poses.answers) {
      EXPECT_TRUE(names.insert(model.model).second);
      EXPECT_TRUE(model.model == "first" || model.model == "second") << model.model;
      EXPECT_TRUE(hashes.contains(model.content_hash));
      for (const auto& detection : model.detections) {
        if (!detection.accepted) continue;
        ++found;
        const auto pose = from_message(detection.camera_T_model);
        ASSERT_TRUE(pose);
        const double off = std::min(test::distance(*pose, scene()[0].camera_T_model, centre),
                                    test::distance(*pose, scene()[1].camera_T_model, centre));
        EXPECT_LT(off, 0.002) << model.model;
      }
    }
  }
  EXPECT_GT(found, 10u);
}

TEST_F(DaemonTest, AnActiveModelWithoutFileLeavesTheOthers) {
  start();
  register_phantom("good");
  register_phantom("bad", false);
  const std::string file = daemon_->result("models.get", {{"name", "bad"}})["file"];
  daemon_->process().signal(SIGKILL);
  daemon_->process().wait(5);
  std::filesystem::remove(folder_ / "state" / file);
  start();
  EXPECT_THAT(daemon_->log(), testing::HasSubstr("event=model_broken model=bad"));
  EXPECT_EQ(daemon_->result("status")["broken_models"], 1);
  EXPECT_TRUE(pose_in(peer_->answer_to(peer_->send(scene()[0].depth))));
}

}  // namespace
}  // namespace edgepose
