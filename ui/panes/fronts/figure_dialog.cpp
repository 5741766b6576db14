#include "ui/panes/fronts/figure_dialog.hpp"

#include <fmt/format.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "ui/panes/fronts/figure_preview.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

/// Of screens and of paper: two columns are 175 mm wide, printed at 300 dpi.
struct FigureSize {
  const char *title, *size;
};
constexpr std::array kSizes{FigureSize{"Slide", "1920x1080"}, FigureSize{"Page", kUsualFigureSize},
                            FigureSize{"Two columns", "2067x1200"}, FigureSize{"Poster", "3840x2400"}};

void draw_preview(const PaneContext& context, double width, double height) {
  FigurePreview& preview = context.preview;
  const Transient::Figure& figure = context.transient.figure;
  if (const auto size = parse_figure_size(figure.size))
    preview.show(context.explorer, figure.parts, size->first, size->second, context.transient.pane_aspect);
  const ImVec2 from = ImGui::GetCursorScreenPos();
  const PixelRect place{static_cast<double>(from.x), static_cast<double>(from.y), width, height};
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(corner(place), far_corner(place), to_imgui(context.style.panel));
  if (preview.texture() != 0) {
    const double shrink = std::min({width / preview.width_px(), height / preview.height_px(), context.scale});
    const double w = shrink * preview.width_px(), h = shrink * preview.height_px();
    const PixelRect shown{place.left + std::round((width - w) / 2), place.top + std::round((height - h) / 2),
                          w, h};
    // ImGui keeps OpenGL's numbers as pointers.
    list.AddImage(reinterpret_cast<ImTextureID>(
                      std::uintptr_t{preview.texture()}),  // NOLINT(performance-no-int-to-ptr)
                  corner(shown), far_corner(shown));
  }
  const bool comes = context.explorer.background.has("preview");
  const std::string words = !preview.problem().empty() ? preview.problem() : comes ? "Drawing …" : "";
  if (!words.empty())
    list.AddText({from.x + context.pxf(8), from.y + context.pxf(6)}, to_imgui(context.style.faint_text),
                 words.c_str());
  ImGui::Dummy(vec(width, height));
  context.anchor_last("figure preview");
}

void size_choice(const PaneContext& context) {
  std::string& size = context.transient.figure.size;
  ImGui::TextUnformatted("Size");
  ImGui::SetNextItemWidth(-1e-3f);
  if (ImGui::BeginCombo("##figure size", size.c_str())) {
    for (const auto& [title, value] : kSizes) {
      if (ImGui::Selectable(fmt::format("{}   {}", title, value).c_str(), size == value)) size = value;
      if (size == value) ImGui::SetItemDefaultFocus();
      context.anchor_last(std::string("figure size ") + value);
    }
    ImGui::EndCombo();
  }
  context.anchor_last("figure size");
}

void part_choice(const PaneContext& context, const char* title, const char* name, bool& on) {
  ImGui::Checkbox(title, &on);
  context.anchor_last(std::string("figure ") + name);
}

/// Sets the ending of the file.
void type_choice(const PaneContext& context) {
  std::string& file = context.transient.asked_text;
  ImGui::TextUnformatted("Type");
  const std::string now = std::filesystem::path(file).extension().string();
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x,
              width = (ImGui::GetContentRegionAvail().x - 2 * gap) / 3;
  for (const auto& [title, ending] :
       {std::pair{"PNG", ".png"}, std::pair{"SVG", ".svg"}, std::pair{"PDF", ".pdf"}}) {
    if (ending != std::string(".png")) ImGui::SameLine(0, gap);
    const bool chosen = now == ending;
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (ImGui::Button(title, {width, 0})) {
      file = std::filesystem::path(file).replace_extension(ending).string();
      context.transient.replaces.clear();
    }
    if (chosen) ImGui::PopStyleColor();
    context.anchor_last(std::string("figure type") + ending);
  }
}

}  // namespace

void draw_figure_options(const PaneContext& context) {
  Transient::Figure& figure = context.transient.figure;
  const double room = static_cast<double>(ImGui::GetContentRegionAvail().x);
  const double column = context.px(190), gap = context.px(16);
  const bool beside = room > context.px(520);
  const double width = beside ? room - column - gap : room;
  const double below = beside ? context.px(118) : context.px(330);
  const double height = std::max(
      context.px(90), std::min(0.64 * width, static_cast<double>(ImGui::GetContentRegionAvail().y) - below));
  draw_preview(context, width, height);
  if (beside) ImGui::SameLine(0, static_cast<float>(gap));
  ImGui::BeginGroup();
  ImGui::PushItemWidth(static_cast<float>(beside ? column : room));
  size_choice(context);
  type_choice(context);
  part_choice(context, "Offsets", "offsets", figure.parts.offsets);
  if (!beside) ImGui::SameLine();
  part_choice(context, "Legend", "legend", figure.parts.legend);
  part_choice(context, "Scale bar", "scale", figure.parts.scale);
  if (!beside) ImGui::SameLine();
  part_choice(context, "Close-up", "close-up", figure.parts.close_up);
  ImGui::PopItemWidth();
  ImGui::EndGroup();
}

std::string figure_line(const Transient& transient, const std::string& file) {
  return fmt::format("export-figure {} {} {}", file, transient.figure.size, to_words(transient.figure.parts));
}

}  // namespace sweepscope::ui
