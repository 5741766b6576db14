#pragma once

#include <string>

#include "core/recording/rig.hpp"

namespace sweepscope {

/// As the rig file spells them.
inline std::string name_of(StampSource stamp) {
  return stamp == StampSource::kHeader ? "header" : "receive";
}
inline std::string name_of(StampAt stamp_at) {
  if (stamp_at == StampAt::kFirstBeam) return "first_beam";
  return stamp_at == StampAt::kLastBeam ? "last_beam" : "arrival";
}

}  // namespace sweepscope
