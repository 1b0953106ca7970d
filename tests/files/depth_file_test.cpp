#include "files/depth_file.h"

#include <gmock/gmock.h>
#include <png.h>
#include <sys/stat.h>

#include <cmath>

#include "tests/files/bad_input.h"
#include "tests/shared_data.h"

namespace edgepose {
namespace {

constexpr double kMillimetres = 0.001;

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

DepthImage small_image() {
  DepthImage image{7, 5, std::vector<float>(35)};
  for (size_t i = 0; i < image.depth.size(); ++i) image.depth[i] = static_cast<float>(i) * 0.031f;
  return image;
}

/// A PNG of any kind, all samples the same value, made by libpng.
std::string png_of(int width, int height, int bits, int colour, unsigned char sample,
                   bool interlaced = false) {
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep data, size_t count) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(data), count);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits, colour,
               interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (colour == PNG_COLOR_TYPE_PALETTE) {
    const png_color grey = {9, 9, 9};
    const std::vector<png_color> palette(256, grey);
    png_set_PLTE(png, info, palette.data(), 256);
  }
  png_write_info(png, info);
  std::vector<unsigned char> row(png_get_rowbytes(png, info), sample);
  const int passes = png_set_interlace_handling(png);
  for (int pass = 0; pass < passes; ++pass)
    for (int y = 0; y < height; ++y) png_write_row(png, row.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return out;
}

uint32_t crc(std::string_view data) {
  uint32_t value = 0xffffffffu;
  for (const char c : data) {
    value ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) value = value & 1 ? 0xedb88320u ^ (value >> 1) : value >> 1;
  }
  return ~value;
}

void put32(std::string& png, size_t at, uint32_t value) {
  for (size_t i = 0; i < 4; ++i) png[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

/// The header says width x height, with a valid checksum.
std::string with_size(std::string png, uint32_t width, uint32_t height) {
  put32(png, 16, width);
  put32(png, 20, height);
  put32(png, 29, crc(std::string_view(png).substr(12, 17)));
  return png;
}

TEST(DepthFile, WritesAndReadsBack) {
  const TemporaryFolder folder;
  const DepthImage image = small_image();
  write_depth_png(folder / "d.png", image, 0.0001);
  const DepthImage read = read_depth_png(folder / "d.png", 0.0001);
  EXPECT_EQ(read.width, 7);
  EXPECT_EQ(read.height, 5);
  ASSERT_EQ(read.depth.size(), image.depth.size());
  for (size_t i = 0; i < image.depth.size(); ++i) EXPECT_NEAR(read.depth[i], image.depth[i], 0.5001e-4) << i;
}

TEST(DepthFile, KeepsEvery16BitValue) {
  const TemporaryFolder folder;
  DepthImage image{256, 256, std::vector<float>(65536)};
  for (size_t i = 0; i < image.depth.size(); ++i)
    image.depth[i] = static_cast<float>(static_cast<double>(i) * kMillimetres);
  write_depth_png(folder / "d.png", image, kMillimetres);
  EXPECT_EQ(read_depth_png(folder / "d.png", kMillimetres).depth, image.depth);
}

TEST(DepthFile, ReadsInterlaced) {
  const std::string png = png_of(13, 9, 16, PNG_COLOR_TYPE_GRAY, 0x02, true);
  const DepthImage image = parse_depth_png(bytes_of(png), "i.png", kMillimetres);
  EXPECT_EQ(image.depth, std::vector<float>(13 * 9, static_cast<float>(0x0202 * kMillimetres)));
}

TEST(DepthFile, RefusesOtherPixelFormats) {
  const struct {
    int bits, colour;
    const char* found;
  } cases[] = {{8, PNG_COLOR_TYPE_GRAY, "8-bit grey"},
               {8, PNG_COLOR_TYPE_RGB, "8-bit RGB"},
               {16, PNG_COLOR_TYPE_RGB, "16-bit RGB"},
               {8, PNG_COLOR_TYPE_RGBA, "8-bit RGBA"},
               {8, PNG_COLOR_TYPE_PALETTE, "8-bit palette"},
               {1, PNG_COLOR_TYPE_GRAY, "1-bit grey"},
               {16, PNG_COLOR_TYPE_GRAY_ALPHA, "16-bit grey with alpha"}};
  for (const auto& test : cases) {
    const std::string png = png_of(4, 3, test.bits, test.colour, 1);
    expect_input_error([&] { parse_depth_png(bytes_of(png), "colour.png", kMillimetres); },
                       {"colour.png", "16-bit single-channel PNG", "4 x 3 pixels", test.found});
  }
}

TEST(DepthFile, RefusesOtherFileFormats) {
  const std::pair<std::string, const char*> cases[] = {{"\xff\xd8\xff\xe0 JFIF", "JPEG"},
                                                       {"ply\nformat ascii 1.0\n", "PLY"},
                                                       {"hello, world", "something else"},
                                                       {std::string("\x89PNG\n\x1a\n", 7), "text-mode"},
                                                       {std::string("\x89PNG\r\n\x1a\n", 8), "cut short"},
                                                       {"", "empty"}};
  for (const auto& [content, found] : cases)
    expect_input_error([&] { parse_depth_png(bytes_of(content), "x.png", kMillimetres); }, {"x.png", found});
}

TEST(DepthFile, RefusesFilesThatCannotBeRead) {
  const TemporaryFolder folder;
  expect_input_error([&] { read_depth_png(folder / "none.png", kMillimetres); },
                     {"none.png", "no such file"});
  expect_input_error([&] { read_depth_png(folder.path(), kMillimetres); }, {"a folder"});
  folder.write("empty.png", "");
  expect_input_error([&] { read_depth_png(folder / "empty.png", kMillimetres); },
                     {"empty.png", "empty file"});
  ASSERT_EQ(mkfifo((folder / "pipe.png").c_str(), 0600), 0);
  expect_input_error([&] { read_depth_png(folder / "pipe.png", kMillimetres); }, {"not a regular file"});
}

TEST(DepthFile, RefusesEveryTruncation) {
  const std::string png = png_of(40, 30, 16, PNG_COLOR_TYPE_GRAY, 3);
  for (size_t size = 0; size < png.size(); ++size)
    expect_input_error([&] { parse_depth_png(bytes_of(png).first(size), "cut.png", kMillimetres); },
                       {"cut.png"});
}

TEST(DepthFile, RefusesAFlippedBitAnywhere) {
  const std::string good = png_of(40, 30, 16, PNG_COLOR_TYPE_GRAY, 3);
  for (size_t at = 0; at < good.size(); ++at) {
    std::string png = good;
    png[at] = static_cast<char>(png[at] ^ 4);
    expect_input_error([&] { parse_depth_png(bytes_of(png), "bit.png", kMillimetres); }, {"bit.png"});
  }
}

TEST(DepthFile, RefusesAbsurdSizesBeforeAllocating) {
  const std::string png = png_of(4, 4, 16, PNG_COLOR_TYPE_GRAY, 3);
  for (const auto& [width, height] : std::vector<std::pair<uint32_t, uint32_t>>{
           {1000000000, 4}, {4, 1000000000}, {0x7fffffff, 0x7fffffff}, {16384, 16384}, {0, 4}, {4, 0}}) {
    const std::string lie = with_size(png, width, height);
    expect_input_error([&] { parse_depth_png(bytes_of(lie), "huge.png", kMillimetres); },
                       {"huge.png", std::to_string(width) + " x " + std::to_string(height), "64 megapixels"});
  }
  // Plausible for a camera, impossible for so short a file.
  const std::string lie = with_size(png, 8000, 8000);
  expect_input_error([&] { parse_depth_png(bytes_of(lie), "lie.png", kMillimetres); },
                     {"lie.png", "too few"});
  // And one that only the decoder can tell.
  const std::string taller = with_size(png, 4, 5);
  expect_input_error([&] { parse_depth_png(bytes_of(taller), "taller.png", kMillimetres); }, {"taller.png"});
}

TEST(DepthFile, RefusesAnImageWithoutMeasurements) {
  const std::string png = png_of(4, 3, 16, PNG_COLOR_TYPE_GRAY, 0);
  expect_input_error([&] { parse_depth_png(bytes_of(png), "dark.png", kMillimetres); },
                     {"dark.png", "0 (no measurement) in every pixel"});
}

TEST(DepthFile, RefusesUnsoundScales) {
  const std::string png = png_of(4, 3, 16, PNG_COLOR_TYPE_GRAY, 1);
  for (const double scale : std::vector<double>{0.0, -0.001, NAN, INFINITY, 1.0, 1e-300})
    expect_input_error([&] { parse_depth_png(bytes_of(png), "s.png", scale); }, {"s.png", "depth scale"});
}

TEST(DepthFile, DoesNotWriteWhatDoesNotFit) {
  const TemporaryFolder folder;
  for (const float depth : {70.0f, -0.5f, NAN, INFINITY}) {
    DepthImage image = small_image();
    image.depth[11] = depth;
    expect_input_error([&] { write_depth_png(folder / "w.png", image, kMillimetres); },
                       {"w.png", "65.535 m"});
  }
  DepthImage short_of_values = small_image();
  short_of_values.depth.pop_back();
  expect_input_error([&] { write_depth_png(folder / "w.png", short_of_values, kMillimetres); },
                     {"34 values"});
  expect_input_error([&] { write_depth_png(folder / "w.png", DepthImage{}, kMillimetres); }, {"0 x 0"});
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "something half-written stays";
  expect_input_error([&] { write_depth_png(folder / "no/where.png", small_image(), kMillimetres); },
                     {"where.png"});
}

TEST(DepthFile, SurvivesRandomDamage) {
  const std::string good = png_of(40, 30, 16, PNG_COLOR_TYPE_GRAY, 3);
  const int refused = survive_damage(good, 3000, [](const std::string& png) {
    const DepthImage image = parse_depth_png(bytes_of(png), "damaged.png", kMillimetres);
    EXPECT_EQ(image.depth.size(), static_cast<size_t>(image.width) * image.height);
  });
  EXPECT_GT(refused, 2900);  // every chunk has a checksum: only damage to skipped or trailing bytes passes
}

TEST(DepthFile, ReadsSharedSets) {
  EDGEPOSE_NEEDS_SHARED("range");
  const DepthImage image = read_depth_png(shared_data("range/test/000001/depth/000000.png"), 0.0001);
  EXPECT_EQ(image.width, 480);
  EXPECT_EQ(image.height, 400);
  float farthest = 0;
  for (const float depth : image.depth) farthest = std::max(farthest, depth);
  EXPECT_GT(farthest, 0.8f);
  EXPECT_LT(farthest, 2.0f);
}

}  // namespace
}  // namespace edgepose
