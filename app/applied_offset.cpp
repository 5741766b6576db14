#include "app/applied_offset.hpp"

#include <string>

#include "core/io/atomic_file.hpp"

namespace sweepscope::app {

Result<AppliedOffset> applied_offset(const std::optional<std::filesystem::path>& estimate,
                                     const std::optional<double>& offset_ms) {
  if (!estimate) {
    AppliedOffset offset;
    offset.offset_s = offset_ms.value() * 1e-3;
    return offset;
  }
  return read_file(*estimate).and_then(
      [&](const std::string& json) { return parse_applied_offset(json, estimate->string()); });
}

}  // namespace sweepscope::app
