#include "core/apply/driver_parameters.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <map>

#include "core/apply/rig_snippet.hpp"
#include "core/offset/estimator.hpp"
#include "core/recording/assemble/assemble.hpp"
#include "core/simulation/write_simulation.hpp"

namespace sweepscope {
namespace {

std::string text_for(double offset_s) {
  RigSnippet snippet;
  snippet.source = "a.bag";
  snippet.offset.offset_s = offset_s;
  return rig_snippet(snippet, RigSystem::kDriverParams);
}

/// How the drivers stamp a scan, from their sources: all add the parameter to the time of the scan.
std::int64_t stamped_ns(std::int64_t time_of_scan_ns, double parameter_s) {
  return time_of_scan_ns + std::llround(parameter_s * 1e9);
}

// A recording that a driver made with its default; the same scans stamped by it with the value that was
// written.
TEST(DriverParameters, EachDriverTakesTheOffsetAwayWithTheValueThatIsWritten) {
  SimulationOptions options;
  options.scene = "room-2";
  options.offset_s = -0.0317;
  options.sweep_s = 0.513;
  const Simulation simulation = simulate(options, Job()).value();
  const YAML::Node written = YAML::Load(text_for(options.offset_s));
  EXPECT_EQ(written.size(), driver_parameters().size());
  std::map<std::int64_t, Estimate> by_shift_ns;  // most drivers shift stamps alike
  for (const DriverParameter& parameter : driver_parameters()) {
    const std::string key = std::string(parameter.driver) + " of ROS " + std::string(parameter.ros);
    ASSERT_TRUE(written[key]) << key;
    const auto value_s = written[key][std::string(parameter.name)].as<double>();
    RawRecording raw = messages_of(simulation);
    std::int64_t shift_ns = 0;
    for (RawScan& scan : raw.lasers[0].scans) {
      const std::int64_t time_of_scan_ns = stamped_ns(scan.stamps.header_ns, -parameter.default_s);
      shift_ns = stamped_ns(time_of_scan_ns, value_s) - scan.stamps.header_ns;
      scan.stamps.header_ns += shift_ns;
    }
    if (!by_shift_ns.contains(shift_ns))
      by_shift_ns[shift_ns] =
          estimate(assemble(std::move(raw), {}, StampSource::kHeader).value(), {}, Job()).value();
    const Estimate& found = by_shift_ns[shift_ns];
    ASSERT_TRUE(found.offset_s) << key;
    EXPECT_NEAR(*found.offset_s, 0, 3 * found.sigma_s.value()) << key;
  }
}

TEST(DriverParameters, TheDefaultOfADriverIsKept) {
  const YAML::Node written = YAML::Load(text_for(0.024));
  EXPECT_NEAR(written["sick_tim of ROS 1 and 2"]["time_offset"].as<double>(), 0.023, 1e-12);
  EXPECT_NEAR(written["urg_node of ROS 2"]["default_user_latency"].as<double>(), 0.024, 1e-12);
}

TEST(DriverParameters, AValueThatADriverDoesNotTakeIsAComment) {
  const std::string text = text_for(0.3);
  const YAML::Node written = YAML::Load(text);
  EXPECT_FALSE(written["hokuyo_node of ROS 1"]);
  EXPECT_TRUE(written["velodyne_driver of ROS 1"]);
  EXPECT_NE(text.find("# not possible, the driver takes -0.25 to 0.25:\n# hokuyo_node of ROS 1"),
            std::string::npos)
      << text;
}

TEST(DriverParameters, EachNamesItsSourceAndThoseWithoutOneAreNamed) {
  const std::string text = text_for(0.024);
  for (const DriverParameter& parameter : driver_parameters())
    EXPECT_NE(text.find("# " + std::string(parameter.source)), std::string::npos) << parameter.driver;
  EXPECT_NE(text.find("rplidar_ros"), std::string::npos);
}

TEST(DriverParameters, ReceiveTimesAreNotShifted) {
  RigSnippet snippet;
  snippet.rig.laser.stamp = StampSource::kReceive;
  EXPECT_NE(rig_snippet(snippet, RigSystem::kDriverParams).find("estimate with --stamps header"),
            std::string::npos);
  EXPECT_EQ(text_for(0.1).find("--stamps"), std::string::npos);
}

}  // namespace
}  // namespace sweepscope
