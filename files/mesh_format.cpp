#include "files/mesh_format.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <string_view>

#include "files/scalar_type.h"
#include "files/text_cursor.h"

namespace edgepose {
namespace {

constexpr size_t kStlHeader = 84, kStlTriangle = 50;

std::string_view as_text(std::span<const std::byte> bytes, size_t most) {
  return {reinterpret_cast<const char*>(bytes.data()), std::min(bytes.size(), most)};
}

/// Bytes from 128 on may be UTF-8.
bool is_text(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) >= ' ' ? c != '\x7f' : (c >= '\t' && c <= '\r');
  });
}

bool is_binary_stl(std::span<const std::byte> bytes) {
  if (bytes.size() < kStlHeader) return false;
  const double count = load_scalar(bytes.data() + 80, ScalarType::kUint32, false);
  return count * kStlTriangle == static_cast<double>(bytes.size() - kStlHeader);
}

/// First word of the first line that is not a comment. Looks at the whole file: comments may be long.
std::string_view first_keyword(std::span<const std::byte> bytes) {
  std::string_view text = as_text(bytes, bytes.size());
  for (;;) {
    std::string_view rest = text;
    const std::string_view token = next_token(rest);
    if (token.empty() || token[0] != '#') return token;
    const size_t end = text.find_first_of("\r\n", static_cast<size_t>(token.data() - text.data()));
    if (end == std::string_view::npos) return {};
    text.remove_prefix(end);
  }
}

template <size_t N>
bool is_one_of(std::string_view word, const std::array<std::string_view, N>& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

constexpr std::array<std::string_view, 6> kPcdWords = {"VERSION", "FIELDS", "SIZE",
                                                       "TYPE",    "WIDTH",  "POINTS"};
constexpr std::array<std::string_view, 12> kObjWords = {"v", "vn", "vt", "vp", "f",      "o",
                                                        "g", "s",  "l",  "p",  "mtllib", "usemtl"};

struct Magic {
  std::string_view bytes;
  const char* name;
};
constexpr Magic kMagics[] = {{"\x89PNG", "a PNG image"},
                             {"\xff\xd8\xff", "a JPEG image"},
                             {"\x1f\x8b", "a gzip archive (unpack it first)"},
                             {"PK\x03\x04", "a ZIP archive (unpack it first)"},
                             {"glTF", "a glTF file"},
                             {"version https://git-lfs", "a Git LFS pointer (run git lfs pull)"},
                             {"<", "XML or HTML"}};

}  // namespace

std::string name_of(MeshFormat format) {
  constexpr const char* kNames[] = {"unknown", "PLY", "STL", "OBJ", "PCD"};
  return kNames[static_cast<size_t>(format)];
}

bool starts_as_ply(std::span<const std::byte> bytes) {
  const std::string_view text = as_text(bytes, 5);
  return text.size() == 5 && text.starts_with("ply") && (text[3] == '\n' || text[3] == '\r');
}

bool starts_as_text_stl(std::span<const std::byte> bytes) {
  std::string_view text = as_text(bytes, 512);
  return is_text(text) && lower_case(next_token(text)) == "solid";
}

MeshFormat format_of_content(std::span<const std::byte> bytes) {
  if (starts_as_ply(bytes)) return MeshFormat::kPly;
  if (as_text(bytes, 6).starts_with("# .PCD")) return MeshFormat::kPcd;
  if (is_binary_stl(bytes) || starts_as_text_stl(bytes)) return MeshFormat::kStl;
  if (!is_text(as_text(bytes, 64))) return MeshFormat::kUnknown;
  const std::string_view word = first_keyword(bytes);
  if (is_one_of(word, kPcdWords)) return MeshFormat::kPcd;
  if (is_one_of(word, kObjWords)) return MeshFormat::kObj;
  return MeshFormat::kUnknown;
}

MeshFormat format_of_name(const std::string& name) {
  const std::string extension = lower_case(std::filesystem::path(name).extension().string());
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".stl") return MeshFormat::kStl;
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".pcd") return MeshFormat::kPcd;
  return MeshFormat::kUnknown;
}

std::string describe_content(std::span<const std::byte> bytes) {
  if (bytes.empty()) return "an empty file";
  for (const Magic& magic : kMagics) {
    if (as_text(bytes, magic.bytes.size()) == magic.bytes) return magic.name;
  }
  const MeshFormat format = format_of_content(bytes);
  if (format != MeshFormat::kUnknown) return "a file in " + name_of(format) + " format";
  const std::string_view start = as_text(bytes, 16);
  if (is_text(start)) return "text that starts with " + quoted(start);
  std::string hex = "binary data that starts with";
  for (const std::byte byte : bytes.first(std::min<size_t>(bytes.size(), 4))) {
    char digits[4];
    std::snprintf(digits, sizeof digits, " %02x", static_cast<unsigned>(byte));
    hex += digits;
  }
  return hex;
}

}  // namespace edgepose
