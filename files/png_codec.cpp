#include "files/png_codec.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string_view>

namespace edgepose::png {
namespace {

constexpr size_t kHeaderBytes = 33;  // signature 8, length 4, "IHDR", 13 bytes, checksum 4

/// What libpng's callbacks share. Trivial on purpose: libpng leaves by longjmp, which runs no destructors.
struct Input {
  const std::byte* data;
  size_t size, offset;
  char complaint[160];
};
struct Output {
  std::vector<std::byte>* bytes;
  char complaint[160];
};

void remember(char (&complaint)[160], const char* message) {
  std::strncpy(complaint, message, sizeof(complaint) - 1);
  complaint[sizeof(complaint) - 1] = '\0';
}
[[noreturn]] void on_read_error(png_structp codec, png_const_charp message) {
  remember(static_cast<Input*>(png_get_error_ptr(codec))->complaint, message);
  png_longjmp(codec, 1);
}
[[noreturn]] void on_write_error(png_structp codec, png_const_charp message) {
  remember(static_cast<Output*>(png_get_error_ptr(codec))->complaint, message);
  png_longjmp(codec, 1);
}
void on_warning(png_structp, png_const_charp) {}  // about chunks that we do not use

void read_bytes(png_structp codec, png_bytep target, size_t count) {
  auto* input = static_cast<Input*>(png_get_io_ptr(codec));
  if (count > input->size - input->offset) png_error(codec, "the file ends too early");
  std::memcpy(target, input->data + input->offset, count);
  input->offset += count;
}

void write_bytes(png_structp codec, png_bytep source, size_t count) {
  auto* output = static_cast<Output*>(png_get_io_ptr(codec));
  bool stored = true;
  try {
    const auto* begin = reinterpret_cast<const std::byte*>(source);
    output->bytes->insert(output->bytes->end(), begin, begin + count);
  } catch (const std::bad_alloc&) {
    stored = false;
  }
  if (!stored) png_error(codec, "out of memory");
}
void flush_nothing(png_structp) {}

/// No local here needs a destructor, and none changes after setjmp.
bool decode_rows(png_structp codec, png_infop info, Input* input, uint8_t* pixels, const Header* header) {
  if (setjmp(png_jmpbuf(codec))) return false;
  png_set_read_fn(codec, input, read_bytes);
  png_set_user_limits(codec, header->width, header->height);
  // Text, colour profiles and the like are skipped unseen: a tiny chunk can unpack to gigabytes.
  png_set_keep_unknown_chunks(codec, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(codec, info);
  const bool as_in_header = png_get_image_width(codec, info) == header->width &&
                            png_get_image_height(codec, info) == header->height &&
                            png_get_bit_depth(codec, info) == 16 &&
                            png_get_color_type(codec, info) == PNG_COLOR_TYPE_GRAY;
  if (!as_in_header) png_error(codec, "the header changes its mind");
  const int passes = png_set_interlace_handling(codec);
  png_read_update_info(codec, info);
  for (int pass = 0; pass < passes; ++pass)
    for (uint32_t row = 0; row < header->height; ++row)
      png_read_row(codec, pixels + size_t{2} * header->width * row, nullptr);
  png_read_end(codec, nullptr);
  return true;
}

bool encode_rows(png_structp codec, png_infop info, Output* output, const uint8_t* pixels, uint32_t width,
                 uint32_t height) {
  if (setjmp(png_jmpbuf(codec))) return false;
  png_set_write_fn(codec, output, write_bytes, flush_nothing);
  png_set_IHDR(codec, info, width, height, 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(codec, info);
  for (uint32_t row = 0; row < height; ++row) png_write_row(codec, pixels + size_t{2} * width * row);
  png_write_end(codec, nullptr);
  return true;
}

uint32_t big_endian(std::span<const std::byte> bytes, size_t at) {
  uint32_t value = 0;
  for (size_t i = 0; i < 4; ++i) value = value << 8 | std::to_integer<uint32_t>(bytes[at + i]);
  return value;
}

bool starts_with(std::span<const std::byte> bytes, std::string_view magic) {
  return bytes.size() >= magic.size() && std::memcmp(bytes.data(), magic.data(), magic.size()) == 0;
}

}  // namespace

std::string foreign_format(std::span<const std::byte> bytes) {
  constexpr std::string_view kSignature = "\x89PNG\r\n\x1a\n";
  if (starts_with(bytes, kSignature)) return "";
  const std::array<std::pair<std::string_view, const char*>, 9> known = {{{"\xff\xd8\xff", "a JPEG image"},
                                                                          {"II*", "a TIFF image"},
                                                                          {"MM", "a TIFF image"},
                                                                          {"BM", "a BMP image"},
                                                                          {"v/1\x01", "an OpenEXR image"},
                                                                          {"\x93NUMPY", "a NumPy array"},
                                                                          {"P5", "a PGM image"},
                                                                          {"ply", "a PLY file"},
                                                                          {"\x89PNG",
                                                                           "a PNG damaged by a "
                                                                           "text-mode transfer"}}};
  for (const auto& [magic, name] : known)
    if (starts_with(bytes, magic)) return name;
  return "something else";
}

bool read_header(std::span<const std::byte> bytes, Header& header) {
  if (bytes.size() < kHeaderBytes || big_endian(bytes, 8) != 13) return false;
  if (!starts_with(bytes.subspan(12), "IHDR")) return false;
  header.width = big_endian(bytes, 16);
  header.height = big_endian(bytes, 20);
  header.bits = std::to_integer<int>(bytes[24]);
  header.colour = std::to_integer<int>(bytes[25]);
  return true;
}

std::string describe(const Header& header) {
  const std::string colours[] = {"grey",          "colour type 1", "RGB", "palette", "grey with alpha",
                                 "colour type 5", "RGBA"};
  const bool known = header.colour >= 0 && header.colour < static_cast<int>(std::size(colours));
  return std::to_string(header.width) + " x " + std::to_string(header.height) + " pixels of " +
         std::to_string(header.bits) + "-bit " +
         (known ? colours[header.colour] : "colour type " + std::to_string(header.colour));
}

std::string decode_grey16(std::span<const std::byte> bytes, const Header& header, std::span<uint8_t> pixels) {
  Input input{bytes.data(), bytes.size(), 0, ""};
  png_structp codec = png_create_read_struct(PNG_LIBPNG_VER_STRING, &input, on_read_error, on_warning);
  png_infop info = codec ? png_create_info_struct(codec) : nullptr;
  const bool done = info && decode_rows(codec, info, &input, pixels.data(), &header);
  png_destroy_read_struct(&codec, &info, nullptr);
  if (done) return "";
  return input.complaint[0] ? input.complaint : "out of memory";
}

std::vector<std::byte> encode_grey16(const std::vector<uint8_t>& pixels, uint32_t width, uint32_t height) {
  std::vector<std::byte> bytes;
  Output output{&bytes, ""};
  png_structp codec = png_create_write_struct(PNG_LIBPNG_VER_STRING, &output, on_write_error, on_warning);
  png_infop info = codec ? png_create_info_struct(codec) : nullptr;
  const bool done = info && encode_rows(codec, info, &output, pixels.data(), width, height);
  png_destroy_write_struct(&codec, &info);
  if (!done) throw std::runtime_error(std::string("cannot encode a PNG: ") + output.complaint);
  return bytes;
}

}  // namespace edgepose::png
