#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/recording/recording.hpp"

namespace sweepscope {

/// The content of a recording's file before anything is chosen, sorted or checked: the same for every format.

/// The time at which a message was made, and the time at which it was received; ns, 0 if not given.
struct MessageStamps {
  std::int64_t header_ns = 0;
  std::int64_t receive_ns = 0;
};

struct RawScan {
  MessageStamps stamps;
  float angle_min_rad = 0, angle_max_rad = 0, angle_increment_rad = 0;  // the greatest is not used
  float time_increment_s = 0, scan_time_s = 0;
  float range_min_m = 0, range_max_m = 0;
  std::size_t first_range = 0;  // of beam 0 in RawLaser::ranges_m
  std::uint32_t beams = 0;
  std::uint16_t ring = 0;
  // Of a line of a cloud: when its first beam, and the cloud's last one, were fired after the stamp.
  double first_beam_after_stamp_s = 0, cloud_end_after_stamp_s = 0;
};

/// The direction of a scan's last beam, for RawScan::angle_max_rad if a format has none.
inline float last_beam_angle_rad(const RawScan& scan) {
  const double steps = scan.beams - 1.0;
  return static_cast<float>(double{scan.angle_min_rad} + steps * double{scan.angle_increment_rad});
}

/// A cloud as it was recorded, for writing it into another format.
struct RawCloud {
  struct Field {
    std::string name;
    std::uint32_t offset = 0;
    std::uint8_t datatype = 0;
    std::uint32_t count = 1;
  };
  MessageStamps stamps;
  std::string frame;
  std::uint32_t height = 0, width = 0, point_bytes = 0, row_bytes = 0;
  bool big_endian = false, dense = false;
  std::vector<Field> fields;
  std::vector<std::byte> data;
};

/// What is kept of clouds: only the scan lines that they are read as, or the clouds too.
enum class CloudDetail { kLines, kWhole };

/// The scans of one topic in the order of the file.
struct RawLaser {
  std::string topic;
  std::string frame;                      // of the first message's header
  std::vector<std::string> other_frames;  // of later messages
  bool of_clouds = false;                 // the scans are lines of a 3D scanner's clouds
  bool of_echoes = false;                 // each beam is one of several echoes
  std::vector<RawScan> scans;
  std::vector<float> ranges_m;
  std::vector<float> intensities;  // like ranges_m as long as every scan had them
  bool has_intensities = true;
  std::vector<Eigen::Vector3f> directions;  // of clouds, like ranges_m: see Recording::directions
  std::vector<RawCloud> clouds;             // with CloudDetail::kWhole, those that lines were read from
};

/// The source of a joint's positions. If the rig names neither topic nor joint, the motor is searched for
/// among joint states; without any among states of controllers, then among numbers, and then among
/// transforms: numbers may be anything, and so may the cause of a frame's motion.
enum class JointSource { kJointState, kController, kNumber, kTransform };

/// The samples of one joint of one topic in the order of the file.
struct RawJoint {
  std::string topic;
  std::string joint;
  JointSource source = JointSource::kJointState;
  std::vector<MessageStamps> stamps;
  std::vector<double> positions;  // raw: before the rig's scale and zero
  std::size_t left_out = 0;       // samples that were counted and not kept
  /// Who published each sample: an index of `publishers`, names of nodes. Both empty where that is not
  /// recorded.
  std::vector<std::uint16_t> publisher = {};
  std::vector<std::string> publishers = {};
};

/// The largest minus the smallest finite position; 0 without any.
double range_of(const RawJoint& joint);

/// The known poses of a frame in its parent frame: the first transform, and the one rotated farthest from it.
struct RawFrame {
  struct Pose {
    MessageStamps stamps;
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
  };
  std::string parent, child;
  Pose first, farthest;
  double turned_rad = 0;  // between these two
  double shifted_m = 0;   // the most from the first
};

/// The measurements of the rig's IMU, in the order of the file.
struct RawTurnRates {
  std::vector<MessageStamps> stamps;
  std::vector<Eigen::Vector3d> rates_rad_s;  // in the IMU's frame
};

/// The poses of the base frame by the rig's odometry, in the order of the file.
struct RawOdometry {
  std::vector<MessageStamps> stamps;
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<Eigen::Quaterniond> orientations;  // as recorded: not of unit length yet
};

struct RawRecording {
  std::string file;  // as given, for messages
  std::string name;
  std::vector<RecordedTopic> topics;
  std::vector<RawLaser> lasers;
  std::vector<RawJoint> joints;
  std::vector<RawFrame> frames;  // of all transforms, also of those that are no joint
  RawTurnRates turn_rates;       // of the topics that the rig names, else empty
  RawOdometry odometry;
  std::vector<std::string> warnings;
};

/// A scan, a whole cloud or a joint's sample that is to be written.
struct WrittenMessage {
  std::int64_t receive_ns = 0;
  bool is_scan = false;  // or a cloud
  std::size_t number = 0;
};

/// All messages in the order in which they were received, or made if that is not known; for equal times scans
/// come first. For clouds these are the clouds themselves: RawLaser::clouds.
std::vector<WrittenMessage> write_order(const RawLaser& laser, const RawJoint& joint);

}  // namespace sweepscope
