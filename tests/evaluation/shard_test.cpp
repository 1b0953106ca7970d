#include "evaluation/shard.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <random>

#include "common/error.h"
#include "tests/temporary_folder.h"

namespace edgepose {
namespace {

std::string fault_of(const std::function<void()>& work) {
  try {
    work();
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TestSet set_of(int images) {
  TestSet set;
  set.objects.resize(2);
  set.objects[0].id = 1, set.objects[1].id = 2;
  for (int i = 0; i < images; ++i) {
    TestImage image;
    image.scene_id = i / 5, image.image_id = i % 5;
    image.truth.resize(1);
    image.truth[0].object_id = 1 + i % 2;
    set.images.push_back(image);
  }
  return set;
}

/// Answers to what is asked in these images, with numbers that no few digits hold.
Evaluation answers_for(const TestSet& set) {
  Evaluation evaluation;
  for (const TestImage& image : set.images) {
    std::mt19937_64 random(static_cast<uint64_t>(100 * image.scene_id + image.image_id));
    std::normal_distribution<double> normal;
    EvalRow row;
    row.scene_id = image.scene_id, row.image_id = image.image_id;
    row.object_id = image.truth[0].object_id;
    row.found = row.accepted = image.image_id % 3 != 0;
    row.cut_short = image.image_id % 2 != 0;
    row.score = std::abs(normal(random));
    row.camera_T_model.linear() =
        Eigen::AngleAxisd(normal(random), Eigen::Vector3d(1, 2, normal(random)).normalized())
            .toRotationMatrix();
    row.camera_T_model.translation() = Eigen::Vector3d(normal(random), normal(random), 1 / 3.0);
    row.seconds = 0.1, row.preprocessing = 0.05;
    row.stages.voting = 1 / 7.0;
    row.reason = "because \"of\"\n\xff that";
    evaluation.rows.push_back(row);
  }
  evaluation.wall_seconds = 1, evaluation.cpu_seconds = 2, evaluation.peak_memory_megabytes = 3;
  return evaluation;
}

ShardRun part_of(const TestSet& set, const Shard& shard) {
  ShardRun run;
  run.shard = shard;
  run.made_with = "edgepose, a set";
  run.set_checksum = checksum_of(set);
  run.folder = "sets/a";
  run.objects = {"1", "2"};
  run.models = {{1, 0.1, 100, 1000, 10000, 0.5}};
  run.evaluation = answers_for(take_shard(set, shard));
  return run;
}

TEST(Shard, IsReadAndRefused) {
  EXPECT_EQ(parse_shard("2/8").index, 2);
  EXPECT_EQ(parse_shard("2/8").count, 8);
  for (const char* wrong :
       {"", "2", "/8", "2/", "0/8", "9/8", "-1/8", "2/8x", " 2/8", "2/1000000", "2//8", "1.5/8"})
    EXPECT_THAT(fault_of([&] { parse_shard(wrong); }), testing::HasSubstr("--shard")) << wrong;
}

TEST(Shard, EveryImageIsInOnePartForAnyNumberOfParts) {
  for (int count = 1; count <= 15; ++count) {
    std::vector<int> seen(12);
    for (int index = 1; index <= count; ++index)
      for (const TestImage& image : take_shard(set_of(12), {index, count}).images)
        ++seen[static_cast<size_t>(5 * image.scene_id + image.image_id)];
    EXPECT_THAT(seen, testing::Each(1)) << count;
  }
}

TEST(Shard, IsWrittenAndReadAsTheSameBits) {
  const ShardRun run = part_of(set_of(7), {2, 3});
  const std::string text = format_shard(run);
  const ShardRun read = parse_shard_file(text, "a");
  EXPECT_EQ(format_shard(read), text);
  EXPECT_EQ(read.evaluation.rows[1].camera_T_model.matrix(), run.evaluation.rows[1].camera_T_model.matrix());
  EXPECT_EQ(read.evaluation.rows[1].score, run.evaluation.rows[1].score);
}

TEST(Shard, MergedInAnyOrderIsTheWholeRun) {
  const TestSet set = set_of(13);
  const std::string whole = format_shard(part_of(set, {1, 1}));
  for (int count : {1, 2, 3, 5, 20}) {
    std::vector<ShardRun> parts;
    std::vector<std::string> names;
    for (int index = count; index >= 1; --index) {
      parts.push_back(part_of(set, {index, count}));
      names.push_back("part " + std::to_string(index));
    }
    ShardRun merged = merge_shards(parts, names, set);
    EXPECT_EQ(merged.evaluation.wall_seconds, count);
    merged.evaluation.wall_seconds = 1, merged.evaluation.cpu_seconds = 2;
    EXPECT_EQ(format_shard(merged), whole) << count;
  }
}

TEST(Shard, PartsThatDoNotBelongTogetherAreNamed) {
  const TestSet set = set_of(6);
  const std::vector<ShardRun> parts = {part_of(set, {1, 2}), part_of(set, {2, 2})};
  const auto fault = [&](std::vector<ShardRun> some, const TestSet& of) {
    return fault_of([&] { merge_shards(some, std::vector<std::string>{"a", "b", "c"}, of); });
  };
  EXPECT_EQ(fault(parts, set), "");
  EXPECT_THAT(fault({parts[0]}, set), testing::HasSubstr("no part 2;"));
  EXPECT_THAT(fault({part_of(set, {3, 9})}, set),
              testing::HasSubstr("found no parts 1, 2, 4, 5, 6 and 3 more; edgepose eval ... --shard 1/9"));
  EXPECT_THAT(
      fault({parts[0], parts[0]}, set),
      testing::AllOf(testing::HasSubstr("b"), testing::HasSubstr("part 1"), testing::HasSubstr("leave one")));
  EXPECT_THAT(fault({parts[0], part_of(set, {2, 3})}, set), testing::HasSubstr("one of 3"));
  std::vector<ShardRun> other = parts;
  other[1].made_with = "something else";
  EXPECT_THAT(fault(other, set), testing::HasSubstr("something else"));
  other = parts;
  other[1].evaluation.rows.pop_back();
  EXPECT_THAT(fault(other, set), testing::HasSubstr("an answer for object"));
  EXPECT_THAT(fault(parts, set_of(5)), testing::HasSubstr("test set"));
  other = parts;
  other[1].set_checksum = "12345678";
  EXPECT_THAT(fault(other, set), testing::AllOf(testing::HasSubstr("b: expected a part of the test set of a"),
                                                testing::HasSubstr("12345678")));
}

TEST(Shard, OnlyWhatDiffersBetweenRunsIsNamed) {
  const TestSet set = set_of(6);
  std::vector<ShardRun> parts = {part_of(set, {1, 2}), part_of(set, {2, 2})};
  const auto fault = [&] {
    return fault_of([&] { merge_shards(parts, std::vector<std::string>{"a", "b"}, set); });
  };
  const std::string same = "edgepose 1, 6 images of spine, drill; match.accept=0.5";
  parts[0].made_with = same + "; match.step=0.05; scene.max=[1, 2]";
  parts[1].made_with = same + "; match.step=0.06; scene.max=[1, 2]";
  EXPECT_EQ(
      fault(),
      "b: expected match.step=0.05, as a, found match.step=0.06; all parts need the same program, set and "
      "options");
  parts[1].made_with = "edgepose 1, 6 images of spine, drill, all models" + parts[0].made_with.substr(36);
  EXPECT_THAT(fault(), testing::HasSubstr("b: expected nothing else, as a, found all models;"));
  for (int i = 0; i < 90; ++i) parts[1].made_with += "; option." + std::to_string(i) + "=1";
  EXPECT_THAT(fault(), testing::HasSubstr("and 86 more"));
  EXPECT_LT(fault().size(), 300u);
}

TEST(Shard, TheSetIsKnownByItsFilesWhereverTheyAre) {
  const TemporaryFolder folder;
  const auto set_in = [&](const std::string& name, const std::string& truth, const std::string& image) {
    std::filesystem::create_directories(folder / name);
    TestSet set = set_of(1);
    set.descriptions = {folder / name / "truth.json"};
    set.images[0].depth = folder / name / "depth.png";
    std::ofstream(set.descriptions[0]) << truth;
    std::ofstream(set.images[0].depth) << image;
    return checksum_of(set);
  };
  const std::string one = set_in("a", "{1}", "depth");
  EXPECT_EQ(set_in("b", "{1}", "depth"), one);
  EXPECT_NE(set_in("b", "{2}", "depth"), one);
  EXPECT_NE(set_in("b", "{1}", "deep"), one);
}

TEST(Shard, ADamagedFileIsNamedWithItsLine) {
  const std::string text = format_shard(part_of(set_of(4), {1, 1}));
  const auto fault = [](const std::string& damaged) {
    return fault_of([&] { parse_shard_file(damaged, "f"); });
  };
  EXPECT_EQ(fault(text), "");
  EXPECT_THAT(fault(""), testing::HasSubstr("empty"));
  EXPECT_THAT(fault("{}\n"), testing::HasSubstr("f, line 1"));
  EXPECT_THAT(fault("scene_id,im_id,obj_id\n1,2,3\n"),
              testing::HasSubstr("f: expected a shard of edgepose eval --shard"));
  EXPECT_THAT(fault(text.substr(0, text.size() - 5)), testing::HasSubstr("line 6"));
  const std::string unsummed = text.substr(0, text.rfind('\n', text.size() - 2) + 1);
  EXPECT_THAT(fault(unsummed), testing::HasSubstr("f, line 5: expected the checksum"));
  EXPECT_EQ(with_checksum(unsummed), text);
  EXPECT_THAT(fault(unsummed.substr(0, unsummed.find('\n') + 1)), testing::HasSubstr("the end is missing"));
  EXPECT_THAT(fault(with_checksum(unsummed.substr(0, unsummed.rfind('\n', unsummed.size() - 2) + 1))),
              testing::HasSubstr("4 answers"));
  for (size_t i = text.find('\n') + 1; i < text.size(); i += 7) {
    std::string altered = text;
    altered[i] = altered[i] == '1' ? '2' : '1';
    EXPECT_NE(fault(altered), "") << i;
  }
  std::string raised = text;
  raised.replace(raised.find("\"score\":") + 8, 3, "0.9");
  EXPECT_THAT(fault(raised),
              testing::AllOf(testing::HasSubstr("f: expected the checksum"), testing::HasSubstr("changed")));
  std::string scaled = unsummed;
  const size_t rotation = scaled.find("\"rotation\":[") + 12;
  scaled.replace(rotation, scaled.find(',', rotation) - rotation, "9.0");
  EXPECT_THAT(fault(with_checksum(scaled)), testing::HasSubstr("f, line 2"));
}

}  // namespace
}  // namespace edgepose
