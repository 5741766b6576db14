#include "core/offset/judgement/evidence.hpp"

#include <gtest/gtest.h>

namespace sweepscope {
namespace {
}  // namespace
}  // namespace sweepscope
