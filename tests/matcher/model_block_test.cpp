#include "matcher/model_block.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <stdexcept>

#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

using fixtures::bracket_model;
using Bytes = std::vector<std::byte>;

Bytes good_block() {
  const auto block = bracket_model().block();
  return {block.begin(), block.end()};
}

/// What from_block says about it; empty if it takes it.
std::string refusal(const Bytes& bytes) {
  try {
    Model::from_block(bytes, nullptr);
    return "";
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
}

ModelHeader header_of(const Bytes& bytes) {
  ModelHeader header;
  std::memcpy(&header, bytes.data(), sizeof(header));
  return header;
}

/// What a model is made of, to be made again with changes.
ModelParts parts_of(const Model& model) {
  const Model::View& view = model.view();
  ModelParts parts;
  const auto copy = [](const auto& from, auto& to) { to.assign(from.begin(), from.end()); };
  parts.header = *view.header;
  copy(view.points, parts.points);
  copy(view.dense_points, parts.dense_points);
  copy(view.support_normals, parts.support_normals);
  copy(view.offsets, parts.offsets);
  copy(view.entries, parts.entries);
  copy(view.view_directions, parts.view_directions);
  copy(view.visible, parts.visible);
  copy(view.contour_offsets, parts.contour_offsets);
  copy(view.contours, parts.contours);
  parts.name = view.name;
  return parts;
}

/// Writes the checksum that docs/model_file.md asks for: an attacker can do that too.
void sign(Bytes& bytes) {
  uint64_t hash = 0xcbf29ce484222325;
  for (size_t i = 0; i + 8 <= bytes.size(); i += 8) {
    if (i == offsetof(ModelHeader, checksum)) continue;
    uint64_t word;
    std::memcpy(&word, bytes.data() + i, 8);
    hash = (hash ^ word) * 0x100000001b3;
    hash ^= hash >> 29;
  }
  std::memcpy(bytes.data() + offsetof(ModelHeader, checksum), &hash, 8);
}

TEST(TrainModel, DescribesTheBracket) {
  const Model& model = bracket_model();
  EXPECT_NEAR(model.diameter(), std::sqrt(0.08 * 0.08 + 0.05 * 0.05 + 0.04 * 0.04), 0.002);
  EXPECT_LT((model.centre() - Eigen::Vector3d(0.04, 0.025, 0.02)).norm(), 0.001);
  EXPECT_EQ(model.name(), "bracket");
  EXPECT_TRUE(model.symmetries().empty());
  EXPECT_GT(model.point_count(), 200u);
  EXPECT_GT(model.pair_count(), 1000u);
  EXPECT_EQ(model.view().view_directions.size(), 60u);
}

TEST(TrainModel, SameBlockAtAnyThreadCount) {
  const Model one = train_model(fixtures::bracket(), "bracket", fixtures::quick_training(1)),
              three = train_model(fixtures::bracket(), "bracket", fixtures::quick_training(3));
  ASSERT_EQ(one.block().size(), three.block().size());
  EXPECT_EQ(std::memcmp(one.block().data(), three.block().data(), one.block().size()), 0);
}

TEST(TrainModel, NamesCanBePrinted) {
  const Model model =
      train_model(fixtures::bracket(), "a\x1b[31m\nb" + std::string(300, 'c'), fixtures::quick_training());
  EXPECT_EQ(model.name(), "a [31m b" + std::string(247, 'c'));
}

TEST(TrainModel, RefusesAMeshWithoutSurface) {
  EXPECT_THROW(train_model({}, "empty"), std::invalid_argument);
}

TEST(FromBlock, TakesAGoodBlock) {
  Bytes bytes = good_block();
  EXPECT_EQ(refusal(bytes), "");
  sign(bytes);
  EXPECT_EQ(bytes, good_block()) << "sign() of this test is wrong";
}

TEST(FromBlock, RefusesTruncatedBlocks) {
  const Bytes whole = good_block();
  fixtures::Random random(1);
  std::vector<size_t> sizes = {0,
                               1,
                               7,
                               8,
                               63,
                               sizeof(ModelHeader) - 1,
                               sizeof(ModelHeader),
                               sizeof(ModelHeader) + 1,
                               whole.size() - 1,
                               whole.size() - 64};
  for (int i = 0; i < 50; ++i) sizes.push_back(random.below(whole.size()));
  for (size_t size : sizes) {
    Bytes cut(whole.begin(), whole.begin() + static_cast<long>(size));
    EXPECT_THAT(refusal(cut), testing::HasSubstr("expected")) << size;
    if (size < sizeof(ModelHeader)) continue;
    cut.resize(size / 64 * 64);
    if (cut.size() < sizeof(ModelHeader)) continue;
    const uint64_t claimed = cut.size();  // even if the header owns up to it
    std::memcpy(cut.data() + offsetof(ModelHeader, size), &claimed, 8);
    sign(cut);
    EXPECT_THAT(refusal(cut), testing::HasSubstr("expected")) << size;
  }
  Bytes longer = whole;
  longer.resize(whole.size() + 64);
  EXPECT_NE(refusal(longer), "");
}

TEST(FromBlock, RefusesAnyFlippedBit) {
  Bytes bytes = good_block();
  fixtures::Random random(2);
  std::vector<size_t> places;
  for (size_t i = 0; i < sizeof(ModelHeader); ++i) places.push_back(i);
  for (int i = 0; i < 100; ++i) places.push_back(random.below(bytes.size()));
  places.push_back(bytes.size() - 1);
  for (size_t at : places) {
    const auto bit = static_cast<std::byte>(1u << random.below(8));
    bytes[at] ^= bit;
    EXPECT_THAT(refusal(bytes), testing::HasSubstr("expected")) << "byte " << at;
    bytes[at] ^= bit;
  }
  EXPECT_EQ(refusal(bytes), "");
}

TEST(FromBlock, RefusesOtherVersionsAndFiles) {
  Bytes bytes = good_block();
  for (uint32_t version : {0u, kModelVersion + 1, 0xffffffffu}) {
    std::memcpy(bytes.data() + offsetof(ModelHeader, version), &version, 4);
    sign(bytes);
    EXPECT_THAT(refusal(bytes), testing::HasSubstr("version " + std::to_string(version)));
  }
  bytes = good_block();
  bytes[0] = std::byte{'E'};
  EXPECT_THAT(refusal(bytes), testing::HasSubstr("magic"));
}

TEST(FromBlock, RefusesASymmetryThatIsNoRigidMotion) {
  ModelParts parts = parts_of(bracket_model());
  const std::vector<double> half_turn = {-1, 0, 0, 0.08, 0, -1, 0, 0.05, 0, 0, 1, 0, 0, 0, 0, 1};
  parts.discrete = half_turn;
  EXPECT_NO_THROW(make_model(parts));
  for (size_t i = 0; i < half_turn.size(); ++i)
    for (const double nonsense : {std::nan(""), std::numeric_limits<double>::infinity(), 1e5}) {
      parts.discrete = half_turn;
      parts.discrete[i] = nonsense;
      EXPECT_THROW(make_model(parts), std::invalid_argument) << i << " = " << nonsense;
    }
  parts.discrete.clear();
  for (size_t i = 0; i < 6; ++i)
    for (const double nonsense : {std::nan(""), std::numeric_limits<double>::infinity(), 1e5}) {
      parts.continuous = {0, 0, 0, 0, 0, 1};
      parts.continuous[i] = nonsense;
      EXPECT_THROW(make_model(parts), std::invalid_argument) << i << " = " << nonsense;
    }
}

TEST(FromBlock, RefusesSignedNonsense) {
  const ModelHeader header = header_of(good_block());
  const auto refuses = [](size_t at, const auto& value) {
    Bytes bytes = good_block();
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    sign(bytes);
    return !refusal(bytes).empty();
  };
  const auto start = [&](Section s) { return header.sections[static_cast<size_t>(s)].offset; };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refuses(start(Section::kPoints), nan));
  EXPECT_TRUE(refuses(start(Section::kDensePoints) + 12, nan));
  EXPECT_TRUE(refuses(start(Section::kSupportNormals), nan));
  EXPECT_TRUE(refuses(start(Section::kEntries), PairEntry{65535, 0}));
  EXPECT_TRUE(refuses(start(Section::kOffsets) + 4, uint32_t{0xffffffff}));
  EXPECT_TRUE(refuses(start(Section::kContourOffsets) + 4, uint32_t{0xffffffff}));
  EXPECT_TRUE(refuses(start(Section::kName) + 2, '\0')) << "it is printed";
  EXPECT_TRUE(refuses(start(Section::kName), '\x1b'));
  EXPECT_TRUE(refuses(offsetof(ModelHeader, diameter), -1.0));
  EXPECT_TRUE(refuses(offsetof(ModelHeader, angle_bins), uint32_t{0}));
  for (size_t s = 0; s < header.sections.size(); ++s) {
    const size_t at = offsetof(ModelHeader, sections) + s * sizeof(ModelHeader::Extent);
    { EXPECT_TRUE(refuses(at, uint64_t{0xffffffffffffffc0})) << "offset of section " << s; }
    EXPECT_TRUE(refuses(at + 8, uint64_t{0xffffffffffffffff})) << "count of section " << s;
    EXPECT_TRUE(refuses(at + 8, uint64_t{1} << 62)) << "count of section " << s;
  }
}

}  // namespace
}  // namespace edgepose
