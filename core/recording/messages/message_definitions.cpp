#include "core/recording/messages/message_definitions.hpp"

#include <algorithm>
#include <array>

namespace sweepscope {
namespace {

/// The members of a type, which differ between ROS 1 and ROS 2 where `ros2` is not empty.
struct Members {
  std::string_view type, members, ros2 = "";
};

constexpr std::string_view kTrajectoryState = "control_msgs/JointTrajectoryControllerState";

constexpr Members kMembers[] = {
    {"sensor_msgs/LaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
     "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nfloat32[] ranges\n"
     "float32[] intensities\n"},
    {"sensor_msgs/MultiEchoLaserScan",
     "std_msgs/Header header\nfloat32 angle_min\nfloat32 angle_max\nfloat32 angle_increment\n"
     "float32 time_increment\nfloat32 scan_time\nfloat32 range_min\nfloat32 range_max\nLaserEcho[] ranges\n"
     "LaserEcho[] intensities\n"},
    {"sensor_msgs/LaserEcho", "float32[] echoes\n"},
    {"sensor_msgs/PointCloud2",
     "std_msgs/Header header\nuint32 height\nuint32 width\nPointField[] fields\nbool is_bigendian\n"
     "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
    {"sensor_msgs/PointField",
     "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\n"
     "uint8 FLOAT32=7\nuint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
    {"sensor_msgs/JointState",
     "std_msgs/Header header\nstring[] name\nfloat64[] position\nfloat64[] velocity\nfloat64[] effort\n"},
    {"sensor_msgs/Imu",
     "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
     "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
     "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n"},
    {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
    {"geometry_msgs/TransformStamped",
     "std_msgs/Header header\nstring child_frame_id\nTransform transform\n"},
    {"geometry_msgs/Transform", "Vector3 translation\nQuaternion rotation\n"},
    {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Quaternion", "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n",
     "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
    {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
    {"geometry_msgs/Pose", "Point position\nQuaternion orientation\n"},
    {"geometry_msgs/Vector3Stamped", "std_msgs/Header header\nVector3 vector\n"},
    {"geometry_msgs/PointStamped", "std_msgs/Header header\nPoint point\n"},
    {"geometry_msgs/QuaternionStamped", "std_msgs/Header header\nQuaternion quaternion\n"},
    {"geometry_msgs/PoseStamped", "std_msgs/Header header\nPose pose\n"},
    {"control_msgs/JointControllerState",
     "std_msgs/Header header\nfloat64 set_point\nfloat64 process_value\nfloat64 process_value_dot\n"
     "float64 error\nfloat64 time_step\nfloat64 command\nfloat64 p\nfloat64 i\nfloat64 d\nfloat64 i_clamp\n"
     "bool antiwindup\n"},
    // Later versions call the two "reference" and "feedback".
    {kTrajectoryState,
     "std_msgs/Header header\nstring[] joint_names\ntrajectory_msgs/JointTrajectoryPoint desired\n"
     "trajectory_msgs/JointTrajectoryPoint actual\n"},
    {"trajectory_msgs/JointTrajectoryPoint",
     "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n"
     "duration time_from_start\n",
     "float64[] positions\nfloat64[] velocities\nfloat64[] accelerations\nfloat64[] effort\n"
     "builtin_interfaces/Duration time_from_start\n"},
    {"dynamixel_workbench_msgs/DynamixelStateList", "DynamixelState[] dynamixel_state\n"},
    {"dynamixel_workbench_msgs/DynamixelState",
     "string name\nuint8 id\nint32 present_position\nint32 present_velocity\nint16 present_current\n"},
    {"dynamixel_msgs/JointState",
     "std_msgs/Header header\nstring name\nint32[] motor_ids\nint32[] motor_temps\nfloat64 goal_pos\n"
     "float64 current_pos\nfloat64 error\nfloat64 velocity\nfloat64 load\nbool is_moving\n"},
    {"std_msgs/MultiArrayLayout", "MultiArrayDimension[] dim\nuint32 data_offset\n"},
    {"std_msgs/MultiArrayDimension", "string label\nuint32 size\nuint32 stride\n"},
    {"std_msgs/Header", "uint32 seq\ntime stamp\nstring frame_id\n",
     "builtin_interfaces/Time stamp\nstring frame_id\n"},
    {"builtin_interfaces/Time", "", "int32 sec\nuint32 nanosec\n"},
    {"builtin_interfaces/Duration", "", "int32 sec\nuint32 nanosec\n"},
};

/// A message and the types that it uses besides its header, in the order of the definition.
struct Message {
  std::string_view type;
  std::array<std::string_view, 4> uses;
};

constexpr Message kMessages[] = {
    {"sensor_msgs/LaserScan", {}},
    {"sensor_msgs/PointCloud2", {"sensor_msgs/PointField"}},
    {"sensor_msgs/JointState", {}},
    {"sensor_msgs/Imu", {"geometry_msgs/Quaternion", "geometry_msgs/Vector3"}},
    {"tf2_msgs/TFMessage",
     {"geometry_msgs/TransformStamped", "geometry_msgs/Transform", "geometry_msgs/Vector3",
      "geometry_msgs/Quaternion"}},
};

/// std_msgs/UInt16 and std_msgs/UInt16MultiArray are named by the type of their numbers.
std::string members_of_number(std::string_view type) {
  constexpr std::string_view kPackage = "std_msgs/", kArray = "multiarray";
  constexpr std::string_view kNumbers[] = {"bool",   "byte",    "char",   "int8",   "uint8",
                                           "int16",  "uint16",  "int32",  "uint32", "int64",
                                           "uint64", "float32", "float64"};
  if (!type.starts_with(kPackage)) return "";
  std::string number(type.substr(kPackage.size()));
  for (char& c : number) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const bool array = number.ends_with(kArray);
  if (array) number.resize(number.size() - kArray.size());
  if (std::ranges::find(kNumbers, number) == std::end(kNumbers)) return "";
  return array ? "MultiArrayLayout layout\n" + number + "[] data\n" : number + " data\n";
}

}  // namespace

std::string members_of(std::string_view type, Encoding encoding) {
  const auto* const found = std::ranges::find(kMembers, type, &Members::type);
  if (found == std::end(kMembers)) return members_of_number(type);
  return std::string(encoding == Encoding::kCdr && !found->ros2.empty() ? found->ros2 : found->members);
}

bool only_beginning_known(std::string_view type) {
  return type == kTrajectoryState;
}

std::string message_definition(std::string_view type, Encoding encoding) {
  const MessageType* known = find_message_type(type);
  if (known == nullptr) return "";
  const auto* const message = std::ranges::find(kMessages, known->name, &Message::type);
  if (message == std::end(kMessages)) return "";
  std::string text = members_of(message->type, encoding);
  const auto add = [&](std::string_view used) {
    text.append(80, '=').append("\nMSG: ").append(used).append("\n").append(members_of(used, encoding));
  };
  for (const std::string_view used : message->uses)
    if (!used.empty()) add(used);
  add("std_msgs/Header");
  if (encoding == Encoding::kCdr) add("builtin_interfaces/Time");
  return text;
}

}  // namespace sweepscope
