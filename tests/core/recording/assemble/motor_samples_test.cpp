#include "core/recording/assemble/motor_samples.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {}  // namespace
}  // namespace sweepscope
