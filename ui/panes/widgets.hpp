#pragma once

#include <string>

#include "ui/explorer/hints.hpp"
#include "ui/panes/pane_context.hpp"

namespace sweepscope::ui {

/// ImGui's numbers.
inline ImVec2 vec(double x, double y) {
  return {static_cast<float>(x), static_cast<float>(y)};
}
inline ImVec2 corner(const PixelRect& rect) {
  return vec(rect.left, rect.top);
}
inline ImVec2 far_corner(const PixelRect& rect) {
  return vec(rect.right(), rect.bottom());
}
inline ImVec2 extent(const PixelRect& rect) {
  return vec(rect.width, rect.height);
}

/// That stands for a map everywhere.
inline Colour colour_of(const PaneContext& context, Side side) {
  return side == Side::kA ? colour_of_a(context.style) : colour_of_b(context.style);
}

/// Where the mouse is.
PixelPoint mouse();

/// Whether the mouse moved since this button was pressed last: a hand that clicks trembles.
bool is_dragged(const PaneContext& context, int button);
/// The button that is down, the left one first.
int held_button();

/// Of padded panels, to the left and to the right, at a scale of 1.
inline constexpr double kPanelMargin = 14;

/// Opens a window at a fixed position without decoration, behind or above the others; `end_panel` closes it.
/// What does not fit can be scrolled to, with a bar where the window is padded. `by_keys`: arrows and Space
/// reach its widgets while the interface is navigated by keys.
void begin_panel(const PaneContext& context, const char* name, const PixelRect& place, bool padded = true,
                 bool above = false, bool by_keys = false);
void end_panel();

inline constexpr ImGuiButtonFlags kAnyButton =
    ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle;
/// A widget without a look that takes the mouse over a rectangle; whether it was clicked.
bool invisible_button(const std::string& name, const PixelRect& place, ImGuiButtonFlags flags = 0);

/// A line of text in another font.
void text_in(ImFont* font, const std::string& text);
/// The text with breaks between its words, so that no line is wider: none within a number, or before its
/// unit.
std::string in_lines(const std::string& text, float width_px);
/// Text that wraps at the panel's edge, of another colour as well.
void wrapped_text(const std::string& text);
void wrapped_text(const Colour& colour, const std::string& text);
/// The same, small and faint.
void small_print(const PaneContext& context, const std::string& text);
/// Stands for two lines that are still to come, and takes as much room.
void waiting_text(const std::string& text);

/// A panel's heading with a rule above it (not above the first).
void heading(const PaneContext& context, const char* text, bool first = false);

/// A name at the left and a value at a fixed distance from it; the value wraps.
void row(const PaneContext& context, const char* name, const std::string& value);

/// A value of a choice for a person: "Side by side" of "side-by-side".
std::string choice_in_words(std::string word);

/// A widget for a field command: a slider, a switch, or a list of choices, with its title and tooltip. A
/// change by the person is performed as that command.
void field(const PaneContext& context, const char* command);

/// The field's title; the widget that comes next stands beside it, to the panel's edge.
void begin_field(const PaneContext& context, const Command& command);

/// A button that performs a line; wide as the panel unless `width_px` is given. Its anchor is "button LINE".
bool button(const PaneContext& context, const char* title, const std::string& line, double width_px = 0,
            bool primary = false);

/// A button for each.
void hint_buttons(const PaneContext& context, const std::vector<Hint>& hints);

/// A tooltip, shown while the mouse rests on the last widget: beside the mouse, or below the widget where
/// that has to stay legible.
enum class TooltipPlace { kBesideMouse, kBelow };
void tooltip(const PaneContext& context, const std::string& text,
             TooltipPlace place = TooltipPlace::kBesideMouse);

/// A thin bar, `fraction` of it filled; as wide as there is room unless `width_px` says otherwise.
void progress_bar(const PaneContext& context, double fraction, double width_px = 0);

/// "1:05 left"; empty if it is not known.
std::string time_left(double seconds);

}  // namespace sweepscope::ui
