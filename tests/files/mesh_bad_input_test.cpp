#include <gtest/gtest.h>

#include "files/mesh_file.h"
#include "files/mesh_health.h"
#include "tests/files/bad_input.h"
#include "tests/files/mesh_samples.h"

namespace edgepose {
namespace {

const std::string kPly = "ply\nformat ascii 1.0\n";
const std::string kBinaryPly = "ply\nformat binary_little_endian 1.0\n";
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";
const std::string kFace = "property list uchar int vertex_indices\n";

void refused(const std::string& content, const std::string& name, std::vector<std::string> parts) {
  parts.push_back(name);
  expect_input_error([&] { parse_text(content, name); }, parts);
}

std::string ascii_ply(const std::string& rows) {
  return kPly + "element vertex 3\n" + kXyz + "element face 1\n" + kFace + "end_header\n" + rows;
}

TEST(BadMesh, MissingFolderOrEmpty) {
  const TemporaryFolder folder;
  expect_input_error([&] { read_mesh(folder / "no.ply"); }, {"no.ply", "no such file"});
  expect_input_error([&] { read_mesh(folder.path()); }, {"folder"});
  expect_input_error([&] { read_mesh(folder.write("a.ply", "")); }, {"a.ply", "empty file"});
  expect_input_error([&] { read_cloud(folder.write("a.pcd", ""), LengthUnit::kMetre); },
                     {"a.pcd", "empty file"});
  for (const char* name : {"a.ply", "a.stl", "a.obj", "a.pcd", "a"}) refused("", name, {"empty file"});
}

TEST(BadMesh, MixedUpFormats) {
  const std::string contents[] = {
      ascii_ply("0 0 0 1 0 0 0 1 0 3 0 1 2"), "solid x\nfacet normal 0 0 0\nendsolid",
      "# a comment\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\n"};
  const char* names[] = {"a.ply", "a.stl", "a.obj", "a.pcd"};
  const char* formats[] = {"PLY", "STL", "OBJ", "PCD"};
  for (int content = 0; content < 4; ++content) {
    for (int name = 0; name < 4; ++name) {
      if (content == name) continue;
      refused(
          contents[content], names[name],
          {std::string("expected ") + formats[name], std::string("found ") + formats[content], "extension"});
    }
  }
}

TEST(BadMesh, SomethingElse) {
  refused("\x89PNG\r\n\x1a\n", "a.ply", {"PLY", "PNG image"});
  refused("\x89PNG\r\n\x1a\n", "a.png", {"PLY, STL, OBJ, PCD", "PNG image"});
  refused("\xff\xd8\xff\xe0 and so on", "a.obj", {"OBJ"});
  refused("PK\x03\x04", "a.stl", {"STL", "ZIP archive"});
  refused("<!DOCTYPE html>", "a.pcd", {"PCD", "XML or HTML"});
  refused("version https://git-lfs.github.com/spec/v1", "a.ply", {"Git LFS pointer"});
  refused("Dear reader", "a.ply", {"'ply'", "'Dear reader'"});
  refused(std::string("\0\1\2\3", 4), "a.xyz", {"00 01 02 03"});
}

TEST(BadPly, Header) {
  refused("ply\nformat ascii 1.0\nelement vertex 1\n", "a.ply", {"end_header", "end of the file"});
  refused("ply\nelement vertex 1\n" + kXyz + "end_header\n1 2 3", "a.ply", {"format"});
  refused("ply\nformat ascii 2.0\nend_header\n", "a.ply", {"1.0", "2.0"});
  refused("ply\nformat binary 1.0\nend_header\n", "a.ply", {"line 2", "'binary'"});
  refused(kPly + "element vertex -1\nend_header\n", "a.ply", {"'-1'"});
  refused(kPly + "element vertex many\nend_header\n", "a.ply", {"'many'"});
  refused(kPly + "element vertex 99999999999999999999\nend_header\n", "a.ply", {"'9999"});
  refused(kPly + "property float x\nend_header\n", "a.ply", {"element before"});
  refused(kPly + "element vertex 1\nproperty real x\nend_header\n", "a.ply", {"'real'"});
  refused(kPly + "element face 1\nproperty list float int vertex_indices\nend_header\n0\n", "a.ply",
          {"integer"});
  refused(kPly + "element vertex 1\n" + kXyz + "property float x\nend_header\n", "a.ply", {"'x' twice"});
  refused(kPly + "element vertex 1\n" + kXyz + "element vertex 1\nend_header\n", "a.ply", {"'vertex' twice"});
  refused(kPly + "element vertex 1\nproperty float x\nproperty float y\nend_header\n1 2\n", "a.ply",
          {"x, y and z"});
  refused(kPly + "element face 1\n" + kFace + "end_header\n3 0 0 0\n", "a.ply", {"vertices", "none"});
  refused(kPly + "element vertex 0\n" + kXyz + "end_header\n", "a.ply", {"vertices", "none"});
  refused(kPly + "garbage\nend_header\n", "a.ply", {"line 3", "'garbage'"});
}

TEST(BadPly, CountsThatLie) {
  for (const char* count :
       {"1000000000", "4294967295", "4294967296", "1000000000000000000", "18446744073709551615"}) {
    refused(kPly + "element vertex " + count + "\n" + kXyz + "end_header\n0 0 0\n", "a.ply",
            {count, "6 bytes"});
    refused(kBinaryPly + "element vertex " + count + "\n" + kXyz + "end_header\n" + std::string(12, '\0'),
            "a.ply", {count, "12 bytes"});
    refused(kBinaryPly + "element vertex 1\n" + kXyz + "element face " + count + "\n" + kFace +
                "end_header\n" + std::string(12, '\0'),
            "a.ply", {count, "0 bytes"});
    refused(kPly + "element other " + count + "\nproperty int a\nelement vertex 1\n" + kXyz +
                "end_header\n0 0 0\n",
            "a.ply", {count});
  }
  // Lists that lie, in every type of length.
  refused(kBinaryPly + "element vertex 1\n" + kXyz +
              "element face 1\nproperty list uint int vertex_indices\nend_header\n" + std::string(12, '\0') +
              bytes_of(uint32_t{1000000000}),
          "a.ply", {"end of the file"});
  refused(kBinaryPly + "element vertex 1\n" + kXyz + "property list int double l\nend_header\n" +
              std::string(12, '\0') + bytes_of(int32_t{1000000000}),
          "a.ply", {"1000000000", "end of the file"});
  refused(kBinaryPly + "element vertex 1\n" + kXyz + "property list char int l\nend_header\n" +
              std::string(12, '\0') + "\xff",
          "a.ply", {"length of a list", "-1"});
  refused(ascii_ply("0 0 0 1 0 0 0 1 0 1000000000 0 1 2"), "a.ply", {"end of the file"});
  refused(ascii_ply("0 0 0 1 0 0 0 1 0 1e300 0 1 2"), "a.ply", {"length of a list"});
  refused(ascii_ply("0 0 0 1 0 0 0 1 0 nan 0 1 2"), "a.ply", {"length of a list"});
  // An element without properties takes no room, however many there are.
  EXPECT_EQ(
      parse_text(kPly + "element nothing 1000000000000\nelement vertex 1\n" + kXyz + "end_header\n0 0 0\n",
                 "a.ply")
          .vertices.size(),
      1u);
  // A count too low leaves data behind.
  refused(ascii_ply("0 0 0 1 0 0 0 1 0 3 0 1 2 3 0 1 2"), "a.ply", {"'3'"});
}

TEST(BadPly, Body) {
  refused(ascii_ply("0 0 0 1 0 0 0 1 0 3 0 1 3"), "a.ply", {"line 10", "from 0 to 2", "found 3"});
  refused(ascii_ply("0 0 0 1 0 0 0 1 0 3 0 1 -1"), "a.ply", {"found -1"});
  refused(ascii_ply("0 0 0 1 0 0 0 1 0 3 0 1 1.5"), "a.ply", {"found 1.5"});
  refused(ascii_ply("0 0 0 1 0 0 0 one 0 3 0 1 2"), "a.ply", {"a number", "'one'"});
  refused(ascii_ply("0 0 0 1 0 0 0 1 0 3 0 1"), "a.ply", {"end of the file"});
  refused(kPly + "element vertex 1\n" + kXyz +
              "element face 1\nproperty list uchar float vertex_indices\nend_header\n0 0 0 0\n",
          "a.ply", {"vertex_indices"});
  refused(kPly + "element vertex 1\n" + kXyz + "element tristrips 1\n" + kFace + "end_header\n0 0 0 1 1\n",
          "a.ply", {"-1"});
}

TEST(BadMesh, NoFaces) {
  refused(kPly + "element vertex 1\n" + kXyz + "element face 0\n" + kFace + "end_header\n0 0 0\n", "a.ply",
          {"no faces"});
  refused(ascii_ply("0 0 0 1 0 0 0 1 0 2 0 1"), "a.ply", {"no faces"});
  refused("solid x\nendsolid x\n", "a.stl", {"none"});
  refused(std::string(84, '\0'), "a.stl", {"none"});
  refused("v 0 0 0\nv 1 0 0\nv 0 1 0\n", "a.obj", {"3 vertices and no faces"});
}

TEST(BadStl, CutShortOrLying) {
  std::string binary(80, ' ');
  binary += bytes_of(uint32_t{2}) + std::string(100, '\0');
  EXPECT_EQ(parse_text(binary, "a.stl").triangles.size(), 2u);
  refused(binary.substr(0, 183), "a.stl", {"184 bytes", "183 bytes", "2 triangles"});
  refused(binary.substr(0, 82), "a.stl", {"STL", "84 bytes", "82 bytes"});
  refused(binary + "x", "a.stl", {"185 bytes"});
  binary.replace(80, 4, bytes_of(uint32_t{1000000000}));
  refused(binary, "a.stl", {"1000000000 triangles", "184 bytes"});
  binary.replace(80, 4, bytes_of(uint32_t{0xffffffff}));
  refused(binary, "a.stl", {"4294967295 triangles"});

  const std::string facet =
      "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
      "0\nendloop\nendfacet\n";
  EXPECT_EQ(parse_text(facet + "endsolid", "a.stl").triangles.size(), 1u);
  refused(facet, "a.stl", {"'endsolid'", "end of the file"});
  refused(facet.substr(0, 60), "a.stl", {"end of the file"});
  refused(facet + "facet normal 0 0 1 outer loop vertex 0 0", "a.stl", {"line 9", "number"});
  refused("solid x\nvertex 0 0 0\n", "a.stl", {"line 2", "'facet'", "'vertex'"});
  refused(facet + "endsolid x\nfacet\n", "a.stl", {"line 10", "'solid'"});
}

TEST(BadObj, Lines) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  refused(vertices + "f 1 2 4\n", "a.obj", {"3 vertices", "vertex 4"});
  refused(vertices + "f 1 2 1000000000\n", "a.obj", {"1000000000"});
  refused(vertices + "f 1 2 99999999999\n", "a.obj", {"line 4", "'99999999999'"});
  refused(vertices + "f 0 1 2\n", "a.obj", {"line 4", "'0'"});
  refused(vertices + "f -4 -1 -2\n", "a.obj", {"'-4'"});
  refused(vertices + "f 1//1 2//1 3//1\n", "a.obj", {"0 normals", "normal 1"});
  refused(vertices + "f 1/x 2 3\n", "a.obj", {"'1/x'"});
  refused(vertices + "f 1/1/1/1 2 3\n", "a.obj", {"'1/1/1/1'"});
  refused(vertices + "f 1 2\n", "a.obj", {"three corners", "2"});
  refused("v 0 0\n", "a.obj", {"line 1", "three numbers"});
  refused("v 0 0 zero\n", "a.obj", {"'zero'"});
  refused(vertices + "f 1 2 3\n\x01\x02\n", "a.obj",
          {"line 5",
           "'?"
           "?'"});
}

std::string pcd(const std::string& data,
                const std::string& fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n",
                const std::string& points = "WIDTH 2\nHEIGHT 1\nPOINTS 2\n") {
  return "# .PCD v0.7\nVERSION 0.7\n" + fields + points + "DATA " + data + "\n";
}

TEST(BadPcd, Header) {
  refused("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\n", "a.pcd", {"DATA", "end of the file"});
  refused("VERSION 0.8\nDATA ascii\n", "a.pcd", {"0.7", "'0.8'"});
  refused(pcd("ascii", "FIELDS x y z\nSIZE 4 4\nTYPE F F F\n"), "a.pcd", {"3 FIELDS"});
  refused(pcd("ascii", "FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n"), "a.pcd", {"'F' with 3"});
  refused(pcd("ascii", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F Q\n"), "a.pcd", {"'Q' with 4"});
  refused(pcd("ascii", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 0\n"), "a.pcd", {"COUNT"});
  refused(pcd("ascii", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1000000000\n"), "a.pcd",
          {"1000000000"});
  refused(pcd("ascii", "FIELDS x y w\nSIZE 4 4 4\nTYPE F F F\n"), "a.pcd", {"x, y and z"});
  refused(pcd("ascii", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 2\n"), "a.pcd", {"x, y and z"});
  refused(pcd("ascii", ""), "a.pcd", {"FIELDS"});
  refused(pcd("ascii", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n", ""), "a.pcd", {"WIDTH"});
  refused(pcd("zipped"), "a.pcd", {"'zipped'"});
  refused(pcd("ascii", "WEIGHT 1\n"), "a.pcd", {"'WEIGHT'"});
  refused(pcd("ascii", "VIEWPOINT a b c\n"), "a.pcd", {"'a'"});
}

TEST(BadPcd, CountsThatLie) {
  const std::string fields = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n";
  for (const char* data : {"ascii", "binary", "binary_compressed"}) {
    refused(pcd(data, fields, "WIDTH 1000000000\nHEIGHT 1\n") + bytes_of(uint32_t{4}, uint32_t{24}) + "\n0 0",
            "a.pcd", {"1000000000"});
    refused(pcd(data, fields, "WIDTH 4294967295\nHEIGHT 4294967295\n") + "0 0 0\n0 0 0\n", "a.pcd",
            {"points"});
    refused(pcd(data, fields, "WIDTH 99999999999\nHEIGHT 1\n"), "a.pcd", {"'99999999999'"});
    refused(pcd(data, fields, "WIDTH 2\nHEIGHT 2\nPOINTS 5\n"), "a.pcd", {"= 4", "5"});
    refused(pcd(data, fields, "WIDTH 0\nHEIGHT 1\nPOINTS 0\n"), "a.pcd", {"none"});
  }
}

TEST(BadPcd, Body) {
  refused(pcd("ascii") + "0 0 0\n0 0\n", "a.pcd", {"2 points", "11 bytes"});
  refused(pcd("ascii") + "0.5 0 0\n0 0\n", "a.pcd", {"line 13", "end of the file"});
  refused(pcd("ascii") + "0 0 0\n0 0 0\n0\n", "a.pcd", {"end of the file", "'0'"});
  refused(pcd("ascii") + "0 0 0\n0 0 x\n", "a.pcd", {"line 12", "'x'"});
  const std::string no_number = pcd("ascii") + "nan nan nan\n0 inf 0\n";
  expect_input_error([&] { parse_cloud(std::as_bytes(std::span(no_number)), "a.pcd", LengthUnit::kMetre); },
                     {"a.pcd", "finite"});
  refused(pcd("binary") + std::string(23, '\0'), "a.pcd", {"12 bytes", "2 points", "23 bytes"});
  refused(pcd("binary_compressed") + "1234", "a.pcd", {"8 bytes"});
  const std::string packed(25, '\x17');  // a run of 24 literals
  const std::string sizes = bytes_of(uint32_t{25}, uint32_t{24});
  EXPECT_EQ(parse_text(pcd("binary_compressed") + sizes + packed, "a.pcd").vertices.size(), 2u);
  refused(pcd("binary_compressed") + sizes + packed.substr(1), "a.pcd", {"25 bytes", "24 bytes"});
  refused(pcd("binary_compressed") + bytes_of(uint32_t{25}, uint32_t{1000000000}) + packed, "a.pcd",
          {"1000000000"});
  refused(pcd("binary_compressed") + sizes + std::string(25, '\xff'), "a.pcd", {"LZF"});
  // Points and size agree, but no 25 bytes hold that much.
  refused(pcd("binary_compressed", "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n", "WIDTH 100000000\n") +
              bytes_of(uint32_t{25}, uint32_t{1200000000}) + packed,
          "a.pcd", {"1200000000"});
}

TEST(BadMesh, UnitsThatCannotBe) {
  const TemporaryFolder folder;
  const auto load = [&](LengthUnit unit) {
    const std::string name = (folder / "a.ply").string();
    const Mesh mesh = read_mesh(name, unit);
    MeshHealth health = check_mesh(mesh);
    return mend_mesh(mesh, health, name);
  };
  write_ply(folder / "a.ply", ball(0.1f), LengthUnit::kMetre);
  EXPECT_NO_THROW(load(LengthUnit::kMetre));
  expect_input_error([&] { load(LengthUnit::kMillimetre); },
                     {"a.ply", "0.2 mm", "in metres, not millimetres", "200 mm with --unit m)"});
  write_ply(folder / "a.ply", ball(0.1f), LengthUnit::kMillimetre);
  EXPECT_NO_THROW(load(LengthUnit::kMillimetre));
  expect_input_error([&] { load(LengthUnit::kMetre); },
                     {"a.ply", "200 m", "in millimetres, not metres", "200 mm with --unit mm)"});
}

}  // namespace
}  // namespace edgepose
