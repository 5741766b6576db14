#include "core/geometry/gear.hpp"

#include <algorithm>
#include <cmath>

namespace sweepscope {

MotorTrack laser_angles(const MotorTrack& shown, const Gear& gear) {
  MotorTrack laser = shown;
  // Least squares may give a gear without play a negative one: then the laser runs ahead.
  const double half_rad = std::abs(gear.play_rad) / 2, sign = gear.play_rad < 0 ? -1 : 1;
  double carried_rad = 0;
  for (std::size_t i = 0; i < shown.angle_rad.size(); ++i) {
    const double shown_rad = shown.angle_rad[i];
    const double shaft_rad =
        shown_rad - gear.encoder_rad[0] * std::sin(shown_rad) - gear.encoder_rad[1] * std::cos(shown_rad);
    carried_rad = i == 0 ? shaft_rad : std::clamp(carried_rad, shaft_rad - half_rad, shaft_rad + half_rad);
    laser.angle_rad[i] = shaft_rad + sign * (carried_rad - shaft_rad);
  }
  return laser;
}

}  // namespace sweepscope
