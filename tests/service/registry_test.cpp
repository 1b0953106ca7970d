#include "server/registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/error.h"
#include "files/mesh_file.h"
#include "files/model_file.h"
#include "tests/service/daemon.h"
#include "tests/service/moving_scene.h"

namespace edgepose {
namespace {

namespace fs = std::filesystem;

const Model& trained_phantom() {
  static const Model model = train_model(read_mesh(test::phantom_file("phantom.ply")), "phantom");
  return model;
}

class RegistryFolder : public testing::Test {
 protected:
  PreparedModel prepared(const std::string& name, const Registry& registry, bool with_plan = false) const {
    PreparedModel p{name, "/somewhere/mesh.ply", registry.incoming() / (name + ".model"), "", true};
    save_model(p.model, trained_phantom());
    if (with_plan) {
      p.plan = registry.incoming() / (name + ".plan.json");
      fs::copy_file(test::phantom_file("drill_plan.json"), p.plan);
    }
    return p;
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / "")) names.push_back(entry.path().filename());
    return names;
  }
  test::Folder folder_;
};

TEST_F(RegistryFolder, WhatIsAddedIsThereAfterARestart) {
  int64_t hash = 0;
  {
    Registry registry(folder_ / "");
    const ModelHandle added = registry.add(prepared("a", registry, true));
    registry.add(prepared("b", registry));
    registry.activate("b", false);
    hash = added->content_hash;
    EXPECT_THAT(registry.names(), testing::ElementsAre("a", "b"));
  }
  const Registry registry(folder_ / "");
  EXPECT_THAT(registry.names(), testing::ElementsAre("a", "b"));
  ASSERT_EQ(registry.active().size(), 1u);
  EXPECT_EQ(registry.find("a")->content_hash, hash);
  EXPECT_EQ(registry.find("a")->plan->targets.size(), 3u);
  EXPECT_EQ(registry.find("a")->mesh, "/somewhere/mesh.ply");
  EXPECT_FALSE(registry.find("b")->active);
}

TEST_F(RegistryFolder, ReplacingAndRemovingLeaveNoFiles) {
  Registry registry(folder_ / "");
  registry.add(prepared("a", registry, true));
  const ModelHandle old = registry.find("a");
  registry.add(prepared("a", registry));
  EXPECT_EQ(registry.all().size(), 1u);
  EXPECT_FALSE(registry.find("a")->plan);
  EXPECT_GT(old->model.point_count(), 0u) << "whoever holds it may go on using it";
  EXPECT_TRUE(registry.remove("a"));
  EXPECT_FALSE(registry.remove("a"));
  EXPECT_THAT(files(), testing::UnorderedElementsAre("registry.json", "lock", "incoming"));
}

TEST_F(RegistryFolder, OtherFilesAreNeverTouched) {
  std::ofstream(folder_ / "mine.model") << "x";
  std::ofstream(folder_ / "notes.plan.json") << "x";
  Registry registry(folder_ / "");
  registry.add(prepared("a", registry));
  registry.remove("a");
  EXPECT_THAT(files(), testing::IsSupersetOf({"mine.model", "notes.plan.json"}));
}

TEST_F(RegistryFolder, OnlyOneAtATime) {
  const Registry registry(folder_ / "");
  try {
    const Registry second(folder_ / "");
    FAIL() << "two registries in one folder";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("another edgeposed"));
  }
}

TEST_F(RegistryFolder, ADamagedModelCostsOnlyItself) {
  std::string file;
  {
    Registry registry(folder_ / "");
    registry.add(prepared("a", registry));
    file = registry.add(prepared("b", registry))->file;
  }
  std::fstream(folder_ / file, std::ios::in | std::ios::out | std::ios::binary)
      .seekp(5000)
      .write("damage", 6);
  Registry registry(folder_ / "");
  ASSERT_EQ(registry.all().size(), 1u);
  EXPECT_THAT(registry.names(), testing::ElementsAre("a", "b")) << "the name stays taken";
  ASSERT_EQ(registry.broken().size(), 1u);
  EXPECT_EQ(registry.broken()[0].entry.name, "b");
  EXPECT_THAT(registry.broken()[0].fault, testing::HasSubstr(file));
  registry.activate("a", false);
  EXPECT_TRUE(fs::exists(folder_ / file)) << "kept until somebody decides";
  EXPECT_TRUE(registry.remove("b"));
  EXPECT_FALSE(fs::exists(folder_ / file));
}

TEST_F(RegistryFolder, AnUnfinishedRegistrationLeavesNothing) {
  {
    const Registry registry(folder_ / "");
    prepared("half", registry);  // as after a kill between training and registering
    std::ofstream(folder_ / "gone-0123456789abcdef-17.model") << "renamed, but not yet in registry.json";
  }
  const Registry registry(folder_ / "");
  EXPECT_TRUE(registry.all().empty());
  EXPECT_TRUE(fs::is_empty(registry.incoming()));
  EXPECT_FALSE(fs::exists(folder_ / "gone-0123456789abcdef-17.model"));
}

TEST_F(RegistryFolder, APlanForAnotherModelIsRefused) {
  Registry registry(folder_ / "");
  PreparedModel p = prepared("a", registry, true);
  std::string text = test::read_text(p.plan);
  text.replace(text.find("\"model_diameter_mm\""), 19, "\"model_diameter_mm\": 500, \"x\"");
  std::ofstream(p.plan) << text;
  EXPECT_THROW(registry.add(p), InputError);
  EXPECT_TRUE(registry.all().empty());
}

/// What cannot be written down is not registered, nor unregistered, and nothing of it stays.
TEST_F(RegistryFolder, WhatCannotBeWrittenDoesNotHappen) {
  Registry registry(folder_ / "");
  registry.add(prepared("a", registry, true));
  const std::vector<std::string> before = files();
  fs::remove(folder_ / "registry.json");
  fs::create_directories(folder_ / "registry.json/in the way");
  EXPECT_THROW(registry.add(prepared("b", registry)), InputError);
  EXPECT_THROW(registry.remove("a"), InputError);
  EXPECT_THAT(registry.names(), testing::ElementsAre("a"));
  EXPECT_THAT(files(), testing::UnorderedElementsAreArray(before));
  EXPECT_TRUE(fs::is_empty(registry.incoming()));
  fs::remove_all(folder_ / "registry.json");
  registry.add(prepared("b", registry));
  EXPECT_THAT(registry.names(), testing::ElementsAre("a", "b"));
}

TEST(Manifest, OnlyItsOwnKindIsRead) {
  const auto fault = [](const std::string& text) {
    try {
      parse_manifest(text, "registry.json");
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  const std::string entry =
      R"({"name":"a","file":"a.model","plan_file":"","mesh":"m","active":true,"registered_utime":1})";
  EXPECT_EQ(fault(R"({"version":1,"models":[)" + entry + "]}"), "");
  EXPECT_THAT(fault(R"({"version":1,"models":[)" + entry + "," + entry + "]}"), testing::HasSubstr("twice"));
  EXPECT_THAT(fault(R"({"version":2,"models":[]})"), testing::HasSubstr("version"));
  EXPECT_THAT(fault("{"), testing::HasSubstr("registry.json"));
  EXPECT_THAT(fault("[]"), testing::HasSubstr("registry.json"));
  EXPECT_THAT(
      fault(R"({"version":1,"models":[{"name":"a","file":"../../etc/passwd","plan_file":"","mesh":"",)"
            R"("active":true,"registered_utime":1}]})"),
      testing::HasSubstr("another path"));
}

TEST(Manifest, NamesAreFileNames) {
  for (const std::string good : {"a", "L4_vertebra", "bolt-M8.v2"}) EXPECT_EQ(name_fault(good), "");
  for (const std::string bad : {"", ".hidden", "a/b", "a b", "..", "ä"})
    EXPECT_NE(name_fault(bad), "") << bad;
  EXPECT_NE(name_fault(std::string(101, 'a')), "");
}

}  // namespace
}  // namespace edgepose
