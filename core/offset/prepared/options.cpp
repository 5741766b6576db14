#include "core/offset/prepared/options.hpp"

namespace sweepscope {

Method method_of(const EstimateOptions& options, RigKind kind, bool keeps_candidates) {
  if (options.method) return *options.method;
  const bool of_the_paper = keeps_candidates || !options.ranges.empty() || options.around || options.fit ||
                            options.scoring || options.weight_c || options.edge_gate_m ||
                            options.plane_gate_m;
  if (!of_the_paper) return Method::kDirect;
  return kind == RigKind::kMoving ? Method::kMoving : Method::kStationary;
}

MappingOptions mapping_of(const EstimateOptions& options) {
  MappingOptions mapping = options.mapping;
  mapping.edge_gate_m = options.edge_gate_m.value_or(mapping.edge_gate_m);
  mapping.plane_gate_m = options.plane_gate_m.value_or(mapping.plane_gate_m);
  return mapping;
}

}  // namespace sweepscope
