#include "core/simulation/meshes/mesh_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/folder_test.hpp"

namespace sweepscope::simulation {
namespace {

// A room of 4 x 6 x 3 m: eight corners and six quadrilaterals.
constexpr std::string_view kRoomCorners = "0 0 0\n4 0 0\n4 6 0\n0 6 0\n0 0 3\n4 0 3\n4 6 3\n0 6 3\n";
constexpr int kRoomFaces[6][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                  {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

std::string ascii_room() {
  std::string text =
      "ply\nformat ascii 1.0\ncomment a room\nelement vertex 8\nproperty float x\nproperty float y\n"
      "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
  text += kRoomCorners;
  for (const auto& f : kRoomFaces)
    text += "4 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + " " +
            std::to_string(f[3]) + "\n";
  return text;
}

template <typename T>
void put(std::string& bytes, T value, bool big_endian) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (big_endian) std::reverse(raw, raw + sizeof value);
  bytes.append(raw, sizeof value);
}

// The same with doubles, colours, an element between and one after the faces.
std::string binary_room(bool big_endian) {
  std::string bytes = std::string("ply\nformat ") +
                      (big_endian ? "binary_big_endian" : "binary_little_endian") +
                      " 1.0\nelement vertex 8\nproperty double x\nproperty double y\nproperty double z\n"
                      "property uchar red\nelement note 1\nproperty list ushort short words\n"
                      "element face 6\nproperty float quality\nproperty list uchar uint vertex_index\n"
                      "element edge 1\nproperty int a\nend_header\n";
  for (int i = 0; i < 8; ++i) {
    put(bytes, (i % 4 == 1 || i % 4 == 2) ? 4.0 : 0.0, big_endian);
    put(bytes, i % 4 >= 2 ? 6.0 : 0.0, big_endian);
    put(bytes, i >= 4 ? 3.0 : 0.0, big_endian);
    put(bytes, std::uint8_t(200), big_endian);
  }
  put(bytes, std::uint16_t(2), big_endian);
  put(bytes, std::int16_t(-7), big_endian);
  put(bytes, std::int16_t(8), big_endian);
  for (const auto& f : kRoomFaces) {
    put(bytes, 0.5F, big_endian);
    put(bytes, std::uint8_t(4), big_endian);
    for (const int corner : f) put(bytes, std::uint32_t(corner), big_endian);
  }
  put(bytes, std::int32_t(1), big_endian);
  return bytes;
}

bool same(const Mesh& l, const Mesh& r) {
  return std::equal(
      l.triangles.begin(), l.triangles.end(), r.triangles.begin(), r.triangles.end(),
      [](const Triangle& a, const Triangle& b) { return a.a == b.a && a.b == b.b && a.c == b.c; });
}

TEST(MeshFile, APlyRoomIsTwelveTriangles) {
  const auto mesh = parse_ply_mesh(ascii_room(), "room.ply");
  ASSERT_TRUE(mesh) << mesh.error().message;
  ASSERT_EQ(mesh->triangles.size(), 12U);
  EXPECT_EQ(mesh->triangles[0].c, Vector3d(4, 6, 0));  // a fan about the first corner
  EXPECT_EQ(mesh->triangles[1].b, Vector3d(4, 6, 0));
  EXPECT_EQ(mesh->triangles[1].c, Vector3d(0, 6, 0));
}

TEST(MeshFile, ThePlyFormatsHoldTheSame) {
  const auto ascii = parse_ply_mesh(ascii_room(), "a");
  for (const bool big_endian : {false, true}) {
    const auto binary = parse_ply_mesh(binary_room(big_endian), "b");
    ASSERT_TRUE(binary) << binary.error().message;
    EXPECT_TRUE(same(*ascii, *binary)) << big_endian;
  }
}

TEST(MeshFile, AnObjRoomIsTheSameAsThePly) {
  std::string text = "# a room\nmtllib room.mtl\no room\nvt 0 0\nvn 0 0 1\r\n";
  std::string corners(kRoomCorners);
  for (std::size_t at = 0; at < corners.size(); at = corners.find('\n', at) + 1)
    text += "v " + corners.substr(at, corners.find('\n', at) + 1 - at);
  const char* kinds[] = {"", "/1", "//1", "/1/1", "", ""};
  for (int i = 0; i < 6; ++i) {
    text += "f";
    for (const int corner : kRoomFaces[i])
      text += " " + std::to_string(i == 5 ? corner - 8 : corner + 1) + kinds[i];  // the last one counts back
    text += "\n";
  }
  const auto mesh = parse_obj_mesh(text, "room.obj");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_TRUE(same(*mesh, *parse_ply_mesh(ascii_room(), "a")));
}

TEST(MeshFile, TrianglesWithoutAnAreaAreLeftOut) {
  const auto mesh =
      parse_obj_mesh("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 1 4\nf 1 2 4\n", "m.obj");
  ASSERT_TRUE(mesh);
  EXPECT_EQ(mesh->triangles.size(), 1U);
}

std::string message_of(const Result<Mesh>& mesh) {
  EXPECT_FALSE(mesh);
  if (mesh) return {};
  EXPECT_EQ(mesh.error().code, ExitCode::kUnreadableInput);
  EXPECT_EQ(mesh.error().message.find('\n'), std::string::npos);
  return mesh.error().message;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(MeshFile, ABadPlyIsRefusedWithItsPlace) {
  const auto refused = [](const std::string& bytes) { return message_of(parse_ply_mesh(bytes, "m.ply")); };
  const std::string room = ascii_room();
  EXPECT_EQ(refused(room.substr(0, room.size() - 3)),
            "m.ply: line 24: the file ends, or a list is not numbers");
  EXPECT_EQ(refused(room.substr(0, room.find("4 6 0"))),
            "m.ply: line 12: the file ends, or there are too few numbers");
  EXPECT_EQ(refused(replaced(room, "\n4 6 0", "\n4 nan 0")),
            "m.ply: line 13: a coordinate is not a finite number");
  EXPECT_EQ(refused(replaced(room, "\n4 6 0", "\n4 6000 0")),
            "m.ply: line 13: a vertex lies more than 5000 m from the origin (a mesh is in metres)");
  EXPECT_EQ(refused(replaced(room, "4 0 1 2 3", "4 0 1 2 8")),
            "m.ply: line 19: a face names vertex 8 (counted from 0), but there are 8");
  EXPECT_EQ(refused(replaced(room, "4 0 1 2 3", "4 0 1 -1 3")),
            "m.ply: line 19: a face names vertex -1 (counted from 0), but there are 8");
  EXPECT_EQ(refused(replaced(room, "4 0 1 2 3", "2 0 1")),
            "m.ply: line 19: a face has 2 corners, not 3 or more");
  EXPECT_EQ(refused(replaced(room, "element face 6", "element face 0")),
            "m.ply: holds no triangle with an area");
  EXPECT_EQ(refused(replaced(room, "element face 6\nproperty list uchar int vertex_indices\n", "")),
            "m.ply: the PLY header names no element face: a cloud is not a mesh");
  EXPECT_EQ(refused(replaced(room, "property float y\n", "")), "m.ply: the element vertex has no property y");
  EXPECT_EQ(refused(replaced(room, "ascii", "text")),
            "m.ply: PLY format text is not read, only ascii, binary_little_endian and binary_big_endian");
  EXPECT_EQ(refused(replaced(room, "element vertex 8", "element vertex -8")),
            "m.ply: line 4: the number of the element vertex is not valid");
  EXPECT_EQ(refused("solid\n"), "m.ply: is not a PLY file");
  EXPECT_EQ(refused(""), "m.ply: is not a PLY file");
}

TEST(MeshFile, ATruncatedBinaryPlyIsRefusedAtEveryLength) {
  const std::string room = binary_room(true);
  // Without the last element (4 bytes) all that counts would be there, but the header promises it.
  for (std::size_t length = room.find("end_header") + 11; length < room.size(); length += 3)
    EXPECT_NE(
        message_of(parse_ply_mesh(room.substr(0, length), "m.ply")).find("(counted from 0): the file ends"),
        std::string::npos)
        << length;
}

TEST(MeshFile, ABadObjIsRefusedWithItsPlace) {
  const auto refused = [](const std::string& text) { return message_of(parse_obj_mesh(text, "m.obj")); };
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(refused(corners + "f 1 2 4\n"),
            "m.obj: line 4: a face names vertex 3 (counted from 0), but there are 3");
  EXPECT_EQ(refused(corners + "f 1 2 0\n"), "m.obj: line 4: \"0\" is not a corner of a face");
  EXPECT_EQ(refused(corners + "f -4 2 3\n"),
            "m.obj: line 4: a face counts back to -4, but there are 3 vertices so far");
  EXPECT_EQ(refused(corners + "f 1 2 c\n"), "m.obj: line 4: \"c\" is not a corner of a face");
  EXPECT_EQ(refused(corners + "f -9223372036854775808 2 3\n"),
            "m.obj: line 4: a face counts back to -9223372036854775808, but there are 3 vertices so far");
  EXPECT_EQ(refused("v 0 0\n"), "m.obj: line 1: a vertex needs three numbers");
  EXPECT_EQ(refused("v 0 inf 0\n"), "m.obj: line 1: a coordinate is not a finite number");
  EXPECT_EQ(refused(corners), "m.obj: holds no triangle with an area");
  EXPECT_EQ(refused(""), "m.obj: holds no triangle with an area");
}

class MeshFileOnDisk : public test::FolderTest {};

TEST_F(MeshFileOnDisk, IsReadByItsEnding) {
  std::ofstream(folder_ / "room.PLY") << ascii_room();
  std::ofstream(folder_ / "room.stl") << "solid\n";
  EXPECT_TRUE(read_mesh(folder_ / "room.PLY"));
  EXPECT_NE(message_of(read_mesh(folder_ / "room.stl")).find("room.stl: a mesh is a .ply or .obj file"),
            std::string::npos);
  EXPECT_NE(message_of(read_mesh(folder_ / "none.ply")).find("none.ply"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope::simulation
