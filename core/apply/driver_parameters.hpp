#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sweepscope {

/// The parameter by which a laser's driver shifts the header stamps of its scans: it adds the value, in
/// seconds.
struct DriverParameter {
  std::string_view driver;  // the package
  std::string_view ros;     // "1", "2" or "1 and 2"
  std::string_view name;
  double default_s = 0;     // the driver's own
  double max_s = 0;         // allowed to either side of 0; 0: any value
  std::string_view source;  // the file that adds it, or documents it
};

/// Those that are known. Drivers that have none are named in docs/integration.md.
const std::vector<DriverParameter>& driver_parameters();

/// The parameter's value that moves scans onto the motor's clock, if they were recorded with the default:
/// default + offset, as t_motor = t_laser + offset.
double driver_value_s(const DriverParameter& parameter, double offset_s);

/// A YAML document with a line per driver, `DRIVER of ROS N: {NAME: VALUE}`, below the comment lines `head`.
/// A value that the driver does not take is a comment.
std::string driver_parameters_text(const std::vector<std::string>& head, double offset_s);

}  // namespace sweepscope
