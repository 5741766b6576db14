#include "core/io/cloud_file.hpp"

#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include <cmath>
#include <limits>

#include "tests/folder_test.hpp"

namespace sweepscope {
namespace {

using test::contents_of;

/// A point whose fields have the names that files carry, so that PCL's own readers and writers fit it.
struct EIGEN_ALIGN16 FilePoint {
  PCL_ADD_POINT4D;
  float intensity;
  std::uint32_t sweep;
  double time;
};

}  // namespace
}  // namespace sweepscope

#pragma GCC diagnostic ignored "-Wunused-function"  // operators that the macro makes
POINT_CLOUD_REGISTER_POINT_STRUCT(sweepscope::FilePoint,
                                  (float, x, x)(float, y, y)(float, z, z)(float, intensity, intensity)(
                                      std::uint32_t, sweep, sweep)(double, time, time))

namespace sweepscope {
namespace {

MapCloud example_cloud(std::size_t points = 500) {
  MapCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const auto value = static_cast<float>(i);
    MapPoint point;
    point.x = 0.1F * value;
    point.y = -3.0F + value;
    point.z = std::sin(value);
    point.intensity = 2 * value;
    point.sweep = static_cast<std::uint32_t>(i / 100) + 4'000'000'000U;
    point.time_s = 1e6 + 1e-6 * static_cast<double>(i);  // more digits than a float has
    cloud.push_back(point);
  }
  return cloud;
}

template <typename A, typename B>
void expect_same_points(const A& a, const B& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].x, b[i].x) << i;
    ASSERT_EQ(a[i].y, b[i].y) << i;
    ASSERT_EQ(a[i].z, b[i].z) << i;
    ASSERT_EQ(a[i].intensity, b[i].intensity) << i;
    ASSERT_EQ(a[i].sweep, b[i].sweep) << i;
  }
}

template <typename A, typename B>
void expect_same_times(const A& map, const B& file) {
  for (std::size_t i = 0; i < map.size(); ++i) ASSERT_EQ(map[i].time_s, file[i].time) << i;
}

pcl::PointCloud<FilePoint> to_file_points(const MapCloud& cloud) {
  pcl::PointCloud<FilePoint> points;
  for (const MapPoint& p : cloud) {
    FilePoint point;
    point.x = p.x;
    point.y = p.y;
    point.z = p.z;
    point.intensity = p.intensity;
    point.sweep = p.sweep;
    point.time = p.time_s;
    points.push_back(point);
  }
  return points;
}

class CloudFileTest : public test::FolderTest {};

TEST_F(CloudFileTest, PclReadsOurPcd) {
  const MapCloud cloud = example_cloud();
  ASSERT_TRUE(write_cloud(folder_ / "a.pcd", cloud));
  pcl::PointCloud<FilePoint> read;
  ASSERT_EQ(pcl::io::loadPCDFile((folder_ / "a.pcd").string(), read), 0);
  expect_same_points(cloud, read);
  expect_same_times(cloud, read);
}

TEST_F(CloudFileTest, PclReadsOurPly) {
  const MapCloud cloud = example_cloud();
  ASSERT_TRUE(write_cloud(folder_ / "a.ply", cloud));
  pcl::PointCloud<FilePoint> read;
  ASSERT_EQ(pcl::io::loadPLYFile((folder_ / "a.ply").string(), read), 0);
  expect_same_points(cloud, read);
  expect_same_times(cloud, read);
}

TEST_F(CloudFileTest, WeReadPclsPcdInAllThreeForms) {
  const MapCloud cloud = example_cloud();
  const auto points = to_file_points(cloud);
  pcl::PCDWriter writer;
  const std::string path = (folder_ / "p.pcd").string();
  const auto check = [&](const char* form) {
    SCOPED_TRACE(form);
    const auto read = read_cloud(path);
    ASSERT_TRUE(read) << read.error().message;
    expect_same_points(cloud, **read);
    expect_same_times(**read, points);
  };
  ASSERT_EQ(writer.writeBinary(path, points), 0);
  check("binary");
  ASSERT_EQ(writer.writeBinaryCompressed(path, points), 0);
  check("binary_compressed");
  ASSERT_EQ(writer.writeASCII(path, points, 17), 0);
  check("ascii");
}

TEST_F(CloudFileTest, WeReadPclsPlyInBothForms) {
  const MapCloud cloud = example_cloud();
  const std::string path = (folder_ / "p.ply").string();
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(to_file_points(cloud), blob);
  for (const bool binary : {true, false}) {
    pcl::PLYWriter writer;
    ASSERT_EQ(writer.write(path, blob, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity(), binary, true),
              0);
    const auto read = read_cloud(path);
    ASSERT_TRUE(read) << read.error().message;
    ASSERT_EQ((*read)->size(), cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      ASSERT_NEAR((**read)[i].y, cloud[i].y, 1e-3) << i;
      ASSERT_EQ((**read)[i].sweep, cloud[i].sweep) << i;
    }
  }
}

TEST_F(CloudFileTest, WhatWeWriteWeReadBackToTheBit) {
  const MapCloud cloud = example_cloud(100'000);
  for (const char* name : {"a.pcd", "a.ply"}) {
    ASSERT_TRUE(write_cloud(folder_ / name, cloud));
    const auto read = read_cloud(folder_ / name);
    ASSERT_TRUE(read) << read.error().message;
    expect_same_points(cloud, **read);
    EXPECT_EQ((**read)[99'999].time_s, cloud[99'999].time_s);
  }
}

TEST_F(CloudFileTest, AnEmptyMapIsAFileThatReadsBackEmpty) {
  for (const char* name : {"a.pcd", "a.ply"}) {
    ASSERT_TRUE(write_cloud(folder_ / name, MapCloud()));
    const auto read = read_cloud(folder_ / name);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_TRUE((*read)->empty());
  }
}

TEST_F(CloudFileTest, AnUnknownExtensionIsWrongUsage) {
  const auto written = write_cloud(folder_ / "a.xyz", example_cloud());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ExitCode::kWrongUsage);
}

constexpr const char* kAsciiHeader = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nWIDTH 2\nHEIGHT 1\n";

TEST(CloudText, OnlyPlacesAreNeededAndPlacesThatAreNotFiniteArePassedOver) {
  const auto read = parse_cloud(std::string(kAsciiHeader) + "DATA ascii\n1 2 3\nnan nan nan\n", "a.pcd");
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ((*read)->size(), 1U);
  EXPECT_EQ((**read)[0].z, 3);
  EXPECT_EQ((**read)[0].intensity, 0);
}

TEST(CloudText, FieldsOfSeveralNumbersAreSteppedOver) {
  const std::string text =
      "VERSION .7\nFIELDS histogram x y z\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 3 1 1 1\nPOINTS 1\nDATA ascii\n"
      "9 9 9 1 2 3\n";
  const auto read = parse_cloud(text, "a.pcd");
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ((**read)[0].x, 1);
}

std::string message_of(const std::string& bytes) {
  const auto read = parse_cloud(bytes, "a");
  return read ? "read" : read.error().message;
}

TEST(CloudText, ErrorsNameTheFileAndThePlace) {
  const std::string header = kAsciiHeader;
  EXPECT_EQ(message_of("hello"), "a: is neither a PCD nor a PLY file");
  EXPECT_EQ(message_of(header), "a: the PCD header has no DATA line");
  EXPECT_EQ(message_of(header + "DATA ascii\n1 2 3\n1 2 x\n"), "a: line 9: a point is 3 numbers");
  EXPECT_EQ(message_of(header + "DATA ascii\n1 2 3\n"),
            "a: the header promises 2 points, the file ends after 1");
  EXPECT_EQ(message_of(header + "DATA binary\nshort"),
            "a: the header promises 2 points of 12 bytes, the file holds 5 bytes of them");
  EXPECT_EQ(message_of("VERSION .7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 0\nDATA ascii\n"),
            "a: the header names no field z");
  EXPECT_EQ(message_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty list uchar int x\nend_header\n"),
            "a: line 4: a list in the element vertex cannot be read");
  EXPECT_EQ(message_of("ply\nformat binary_big_endian 1.0\nelement vertex 0\nproperty float x\nend_header\n"),
            "a: PLY format binary_big_endian is not read, only ascii and binary_little_endian");
}

TEST(CloudText, AHugePromiseIsRefusedBeforeItIsAllocated) {
  const std::string header = "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 4000000000\n";
  EXPECT_NE(message_of(header + "DATA binary\n1234").find("promises 4000000000"), std::string::npos);
  EXPECT_NE(message_of(header + "DATA ascii\n1 2 3\n").find("the file ends after 1"), std::string::npos);
  EXPECT_NE(
      message_of("VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS -1\nDATA ascii\n").find("POINTS"),
      std::string::npos);
}

TEST_F(CloudFileTest, AFileThatIsCutAnywhereIsAnErrorNotACrash) {
  pcl::PCDWriter writer;
  const std::string path = (folder_ / "p.pcd").string();
  const auto points = to_file_points(example_cloud(20));
  ASSERT_EQ(writer.writeBinaryCompressed(path, points), 0);
  const std::string compressed = contents_of(path);
  ASSERT_TRUE(write_cloud(folder_ / "a.ply", example_cloud(20)));
  const std::string ply = contents_of(folder_ / "a.ply");
  for (std::size_t length = 0; length < compressed.size(); ++length) {
    EXPECT_FALSE(parse_cloud(compressed.substr(0, length), "a")) << length;
  }
  for (std::size_t length = 0; length < ply.size(); ++length) {
    EXPECT_FALSE(parse_cloud(ply.substr(0, length), "a")) << length;
  }
}

}  // namespace
}  // namespace sweepscope
