#include "evaluation/selection.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "tests/evaluation/tiny_set.h"

namespace edgepose {
namespace {

TEST(Selection, ReadsImageNumbers) {
  const auto parsed = [](const std::string& text) {
    Selection selection;
    parse_images(text, selection);
    return std::pair(selection.first_image, selection.last_image);
  };
  EXPECT_EQ(parsed("3"), std::pair(3, std::optional(3)));
  EXPECT_EQ(parsed("3-7"), std::pair(3, std::optional(7)));
  EXPECT_EQ(parsed("3-"), std::pair(3, std::optional<int>()));
  EXPECT_EQ(parsed("-7"), std::pair(0, std::optional(7)));
}

TEST(Selection, RefusesWhatIsNoRange) {
  for (const char* text : {"", "-", "a", "3-b", "7-3", "3.5", "1-2-3", "99999999999999", " 3", "--3"}) {
    Selection selection;
    EXPECT_THROW(parse_images(text, selection), InputError) << text;
  }
}

TEST(Selection, KeepsTheWantedPart) {
  Selection selection;
  selection.objects = {"round"};
  const TestSet one = select(tiny_set(), selection);
  ASSERT_EQ(one.objects.size(), 1u);
  EXPECT_EQ(one.objects[0].id, 2);
  EXPECT_EQ(one.images.size(), 2u);
  EXPECT_EQ(one.images[0].truth.size(), 1u);
  EXPECT_TRUE(one.images[1].truth.empty());

  Selection by_number;
  by_number.objects = {"1"};
  by_number.first_image = 1;
  const TestSet other = select(tiny_set(), by_number);
  EXPECT_EQ(other.objects.at(0).name, "plain");
  ASSERT_EQ(other.images.size(), 1u);
  EXPECT_EQ(other.images[0].image_id, 1);
}

TEST(Selection, NamesWhatIsNotThere) {
  Selection unknown;
  unknown.objects = {"cone"};
  try {
    select(tiny_set(), unknown);
    FAIL() << "an unknown object was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("'cone'"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("plain, round"), std::string::npos) << error.what();
  }
  Selection empty;
  empty.first_image = 5;
  EXPECT_THROW(select(tiny_set(), empty), InputError);
}

}  // namespace
}  // namespace edgepose
