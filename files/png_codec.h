#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// libpng behind a border of our own: it knows PNG and 16-bit grey, nothing of depth or files.
namespace edgepose::png {

/// The IHDR chunk, the first 33 bytes of every PNG.
struct Header {
  uint32_t width = 0, height = 0;
  int bits = 0;
  int colour = 0;  ///< PNG colour type; 0 = grey
};

/// What the bytes are if they are no PNG ("a JPEG image"), in words; empty if they start like a PNG.
std::string foreign_format(std::span<const std::byte> bytes);

/// Reads the header alone. False if the bytes are too short or do not hold one.
bool read_header(std::span<const std::byte> bytes, Header& header);
std::string describe(const Header& header);  ///< "640 x 480 pixels of 8-bit RGB"

/// Decodes a 16-bit grey PNG; `pixels` must hold width * height * 2 bytes (big endian, as in the file).
/// Empty if all went well, else libpng's complaint.
std::string decode_grey16(std::span<const std::byte> bytes, const Header& header, std::span<uint8_t> pixels);

/// Encodes big-endian 16-bit grey pixels. Throws std::runtime_error if libpng fails.
std::vector<std::byte> encode_grey16(const std::vector<uint8_t>& pixels, uint32_t width, uint32_t height);

}  // namespace edgepose::png
