#include "core/apply/driver_parameters.hpp"

#include <fmt/format.h>

#include <cmath>

namespace sweepscope {

const std::vector<DriverParameter>& driver_parameters() {
  static const std::vector<DriverParameter> all{
      {"urg_node", "1", "time_offset", 0, 10,
       "https://github.com/ros-drivers/urg_node, melodic-devel, cfg/URG.cfg"},
      {"urg_node", "2", "default_user_latency", 0, 0,
       "https://github.com/ros-drivers/urg_node, ros2-devel, src/urg_c_wrapper.cpp (grabScan)"},
      {"urg_node2", "2", "time_offset", 0, 0, "https://github.com/Hokuyo-aut/urg_node2, src/urg_node2.cpp"},
      {"hokuyo_node", "1", "time_offset", 0, 0.25,
       "https://github.com/ros-drivers/hokuyo_node, src/hokuyo_node.cpp (publishScan), cfg/Hokuyo.cfg"},
      {"sick_tim", "1 and 2", "time_offset", -0.001, 0.25,
       "https://github.com/uos/sick_tim, src/sick_tim551_2050001_parser.cpp, cfg/SickTim.cfg"},
      {"sick_scan_xd", "1 and 2", "time_offset", 0, 0.25,
       "https://github.com/SICKAG/sick_scan_xd, driver/src/sick_scan_common.cpp, cfg/SickScan.cfg"},
      {"sick_safetyscanners", "1", "time_offset", 0, 0.25,
       "https://github.com/SICKAG/sick_safetyscanners, src/SickSafetyscannersRos.cpp"},
      {"sick_safetyscanners2", "2", "time_offset", 0, 0,
       "https://github.com/SICKAG/sick_safetyscanners2, src/utils/MessageCreator.cpp"},
      {"velodyne_driver", "1", "time_offset", 0, 1,
       "https://github.com/ros-drivers/velodyne, velodyne_driver/src/lib/input.cc, cfg/VelodyneNode.cfg"},
  };
  return all;
}

double driver_value_s(const DriverParameter& parameter, double offset_s) {
  return parameter.default_s + offset_s;
}

std::string driver_parameters_text(const std::vector<std::string>& head, double offset_s) {
  std::string text;
  for (const std::string& line : head) text += "# " + line + "\n";
  for (const DriverParameter& parameter : driver_parameters()) {
    const double value_s = driver_value_s(parameter, offset_s);
    const bool allowed = parameter.max_s == 0 || std::abs(value_s) <= parameter.max_s;
    text += fmt::format("# {}\n", parameter.source);
    if (!allowed)
      text += fmt::format("# not possible, the driver takes {:g} to {:g}:\n# ", -parameter.max_s,
                          parameter.max_s);
    text +=
        fmt::format("{} of ROS {}: {{{}: {:.9f}}}", parameter.driver, parameter.ros, parameter.name, value_s);
    if (parameter.default_s != 0)
      text += fmt::format("  # the default, {:g}, plus the offset", parameter.default_s);
    text += "\n";
  }
  return text;
}

}  // namespace sweepscope
