#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// A number of a field command, to drag or to type.
struct NumberBox {
  std::string id;  // unlike any other's in a frame
  const Command* command = nullptr;
  std::size_t index = 0;           // of the command's values
  double least = 0, greatest = 0;  // that a drag reaches
  double step = 0;
  double per_px = 1;  // of a drag
  bool slider = false;
  std::string format;  // for ImGui: "%.1f ms"
  /// What the command's values are by themselves while none is set; shown faintly. Who changes one keeps the
  /// others. Empty: they are set.
  std::vector<double> automatic = {};
};
/// To drag between the parameter's limits, in its unit and with its step.
NumberBox box_of(const Command& command, std::size_t index);
/// The last widget is the box.
void number_box(const PaneContext& context, const NumberBox& box);

/// Before the boxes of a frame are drawn.
void begin_number_boxes(Transient& transient);
/// Tab (way 1) and Shift+Tab (way -1) through the boxes of the last frame.
void type_into_next_box(Transient& transient, int way);

/// What a person typed: a number with a decimal point or comma, and perhaps the parameter's unit.
Result<double> parse_typed_number(const Parameter& parameter, std::string_view text);

}  // namespace sweepscope::ui
