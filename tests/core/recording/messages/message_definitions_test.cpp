#include "core/recording/messages/message_definitions.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <sensor_msgs/PointCloud2.h>

#include <map>
#include <sstream>

#include "tests/core/recording/message_allocator.hpp"

namespace sweepscope {
namespace {

/// The lines of each type of a definition, without comments, empty lines and white space; the first is "".
std::map<std::string, std::vector<std::string>> types_of(const std::string& definition) {
  std::map<std::string, std::vector<std::string>> types;
  std::string type;
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    line.resize(std::min(line.find('#'), line.size()));
    std::istringstream words(line);
    std::string joined;
    for (std::string word; words >> word;) joined += (joined.empty() ? "" : " ") + word;
    for (std::size_t at; (at = joined.find(" = ")) != std::string::npos;) joined.replace(at, 3, "=");
    if (joined == "Header header") joined = "std_msgs/Header header";
    if (joined.starts_with("MSG: "))
      type = joined.substr(5);
    else if (!joined.empty() && !joined.starts_with("===="))
      types[type].push_back(joined);
  }
  return types;
}

template <typename Message>
std::map<std::string, std::vector<std::string>> types_of_ros() {
  return types_of(ros::message_traits::Definition<Message>::value());
}

TEST(MessageDefinitions, AreThoseOfRos1ButForComments) {
  const auto ours = [](const char* type) { return types_of(message_definition(type, Encoding::kRos1)); };
  EXPECT_EQ(ours("sensor_msgs/LaserScan"), types_of_ros<sensor_msgs::LaserScan_<MessageAllocator<void>>>());
  EXPECT_EQ(ours("sensor_msgs/PointCloud2"),
            types_of_ros<sensor_msgs::PointCloud2_<MessageAllocator<void>>>());
  EXPECT_EQ(ours("sensor_msgs/JointState"), types_of_ros<sensor_msgs::JointState_<MessageAllocator<void>>>());
  EXPECT_EQ(ours("sensor_msgs/Imu"), types_of_ros<sensor_msgs::Imu_<MessageAllocator<void>>>());
  auto transform = types_of_ros<geometry_msgs::TransformStamped_<MessageAllocator<void>>>();
  transform["geometry_msgs/TransformStamped"] = transform[""];
  transform[""] = {"geometry_msgs/TransformStamped[] transforms"};
  EXPECT_EQ(ours("tf2_msgs/TFMessage"), transform);
}

TEST(MessageDefinitions, OfRos2HaveAHeaderWithoutANumberAndItsTime) {
  for (const char* type : {"sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2",
                           "sensor_msgs/msg/JointState", "sensor_msgs/msg/Imu", "tf2_msgs/msg/TFMessage"}) {
    const auto types = types_of(message_definition(type, Encoding::kCdr));
    EXPECT_EQ(types.at("std_msgs/Header"),
              (std::vector<std::string>{"builtin_interfaces/Time stamp", "string frame_id"}))
        << type;
    EXPECT_EQ(types.at("builtin_interfaces/Time"), (std::vector<std::string>{"int32 sec", "uint32 nanosec"}));
  }
}

TEST(MessageDefinitions, AreEmptyForTypesThatAreNotWritten) {
  for (const char* type : {"nav_msgs/Odometry", "std_msgs/Float64", "sensor_msgs/Image", ""})
    EXPECT_EQ(message_definition(type, Encoding::kRos1), "") << type;
}

}  // namespace
}  // namespace sweepscope
