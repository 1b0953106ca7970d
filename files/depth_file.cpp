#include "files/depth_file.h"

#include <cmath>

#include "common/atomic_file.h"
#include "common/error.h"
#include "files/number_text.h"
#include "files/png_codec.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr size_t kMaxDepthBytes = 512u << 20;
// Deflate packs at most 1032 bytes into one; a file that claims more lies about its size.
constexpr uint64_t kMaxPackingRatio = 1040;
constexpr const char* kExpectedDepth = "a depth image (16-bit single-channel PNG)";
constexpr const char* kRawDepth = "give the raw depth image, not a colour or preview image";

png::Header checked_header(std::span<const std::byte> bytes, const std::string& name, uint64_t max_pixels) {
  if (bytes.empty()) throw InputError::at(name, kExpectedDepth, "an empty file");
  const std::string foreign = png::foreign_format(bytes);
  if (!foreign.empty()) throw InputError::at(name, kExpectedDepth, foreign, kRawDepth);
  png::Header header;
  if (!png::read_header(bytes, header))
    throw InputError::at(name, kExpectedDepth, "a PNG cut short or damaged");
  if (header.bits != 16 || header.colour != 0)
    throw InputError::at(name, kExpectedDepth, png::describe(header), kRawDepth);
  const uint64_t pixels = uint64_t{header.width} * header.height;
  if (header.width == 0 || header.height == 0 || header.width > kMaxDepthSide ||
      header.height > kMaxDepthSide || pixels > std::min(max_pixels, kMaxDepthPixels))
    throw InputError::at(
        name,
        "a depth image of 1 to 16384 pixels a side and at most " +
            number_text(1e-6 * static_cast<double>(std::min(max_pixels, kMaxDepthPixels)), 3) + " megapixels",
        png::describe(header));
  if (2 * pixels > kMaxPackingRatio * bytes.size())
    throw InputError::at(name, png::describe(header),
                         "only " + std::to_string(bytes.size()) + " bytes, too few to hold them",
                         "the file is cut short or its header is damaged");
  return header;
}

void check_scale(const std::string& name, double depth_scale) {
  if (!(depth_scale >= kMinDepthScale && depth_scale <= kMaxDepthScale))
    throw InputError::at(name, "a depth scale of 1e-7 to 0.1 metres per unit", number_text(depth_scale),
                         "it is 0.001 if the file holds millimetres");
}

/// In units of the file. Throws if it does not fit 16 bits.
uint16_t quantised(float depth, double depth_scale, const std::string& name) {
  constexpr double kMost = 65535;
  const double units = std::round(static_cast<double>(depth) / depth_scale);
  if (!(depth >= 0) || !(units <= kMost))
    throw InputError::at(name,
                         "depths from 0 to " + number_text(kMost * depth_scale, 6) + " m at this depth scale",
                         number_text(depth, 6) + " m", "use a coarser depth scale or cut the depth range");
  return static_cast<uint16_t>(units);
}

}  // namespace

DepthImage parse_depth_png(std::span<const std::byte> bytes, const std::string& name, double depth_scale,
                           uint64_t max_pixels) {
  check_scale(name, depth_scale);
  const png::Header header = checked_header(bytes, name, max_pixels);
  std::vector<uint8_t> pixels(size_t{2} * header.width * header.height);
  const std::string complaint = png::decode_grey16(bytes, header, pixels);
  if (!complaint.empty())
    throw InputError::at(name, png::describe(header), "a damaged or truncated PNG (" + complaint + ")",
                         "copy or record the file again");

  DepthImage image{static_cast<int>(header.width), static_cast<int>(header.height), {}};
  image.depth.resize(pixels.size() / 2);
  bool measured = false;
  for (size_t i = 0; i < image.depth.size(); ++i) {
    const int units = pixels[2 * i] << 8 | pixels[2 * i + 1];
    image.depth[i] = static_cast<float>(units * depth_scale);
    measured |= units != 0;
  }
  if (!measured)
    throw InputError::at(name, "measurements", "0 (no measurement) in every pixel",
                         "check that the sensor was on and the right file is given");
  return image;
}

DepthImage read_depth_png(const std::filesystem::path& path, double depth_scale, uint64_t max_pixels) {
  const std::string bytes = read_whole_file(path, kExpectedDepth, kMaxDepthBytes);
  return parse_depth_png(std::as_bytes(std::span(bytes)), path.string(), depth_scale, max_pixels);
}

void write_depth_png(const std::filesystem::path& path, const DepthImage& image, double depth_scale) {
  write_file_atomically(path, encode_depth_png(image, path.string(), depth_scale));
}

std::vector<std::byte> encode_depth_png(const DepthImage& image, const std::string& name,
                                        double depth_scale) {
  check_scale(name, depth_scale);
  if (image.width <= 0 || image.height <= 0 || image.depth.size() != size_t(image.width) * image.height)
    throw InputError::at(name, "a depth image to write",
                         std::to_string(image.width) + " x " + std::to_string(image.height) +
                             " pixels with " + std::to_string(image.depth.size()) + " values");
  std::vector<uint8_t> pixels(2 * image.depth.size());
  for (size_t i = 0; i < image.depth.size(); ++i) {
    const uint16_t units = quantised(image.depth[i], depth_scale, name);
    pixels[2 * i] = static_cast<uint8_t>(units >> 8);
    pixels[2 * i + 1] = static_cast<uint8_t>(units & 0xff);
  }
  return png::encode_grey16(pixels, static_cast<uint32_t>(image.width), static_cast<uint32_t>(image.height));
}

}  // namespace edgepose
