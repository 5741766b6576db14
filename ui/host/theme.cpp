#include "ui/host/theme.hpp"

#include <cmath>

#include "render/drawing/fonts.hpp"

namespace sweepscope::ui {
namespace {

/// ImGui's size of a font is its line's height; DejaVu's is this many ems.
constexpr double kLine_em = 1.1640625;

constexpr std::array<ImWchar, 21> kGlyphs{0x0020, 0x00FF,  // Latin
                                          0x0370, 0x03FF,  // Greek
                                          0x2010, 0x2027,  // dashes, ellipsis
                                          0x2070, 0x209C,  // superscripts and subscripts
                                          0x2190, 0x2199,  // arrows
                                          0x2212, 0x221A,  // minus to root
                                          0x2248, 0x2248, 0x2264, 0x2265, 0x25A0, 0x25FF,  // shapes
                                          0x2713, 0x2713, 0};

ImVec4 vec(Colour c, double opacity = 1) {
  return {static_cast<float>(c.red) / 255, static_cast<float>(c.green) / 255,
          static_cast<float>(c.blue) / 255, static_cast<float>(opacity)};
}

Colour mix(Colour a, Colour b, double part) {
  const auto channel = [&](std::uint8_t from, std::uint8_t to) {
    return static_cast<std::uint8_t>(std::lround(from + part * (to - from)));
  };
  return {channel(a.red, b.red), channel(a.green, b.green), channel(a.blue, b.blue)};
}

ImFont* add_font(double em_px, bool bold) {
  const std::string_view bytes = font_bytes(bold);
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  config.OversampleH = 2;
  config.OversampleV = 1;
  config.PixelSnapH = false;
  const auto size = static_cast<float>(std::round(em_px * kLine_em));
  return ImGui::GetIO().Fonts->AddFontFromMemoryTTF(
      const_cast<char*>(bytes.data()), static_cast<int>(bytes.size()), size, &config, kGlyphs.data());
}

void set_colours(ImVec4* colours, const Style& style) {
  const Colour control = mix(style.page, style.text, 0.07), hovered = mix(style.page, style.text, 0.13),
               active = mix(style.page, style.text, 0.2), accent = colour_of_b(style);
  const auto set = [&](std::initializer_list<int> which, const ImVec4& colour) {
    for (const int i : which) colours[i] = colour;
  };
  set({ImGuiCol_Text}, vec(style.text));
  set({ImGuiCol_TextDisabled}, vec(style.faint_text));
  set({ImGuiCol_WindowBg, ImGuiCol_MenuBarBg}, vec(style.page));
  set({ImGuiCol_ChildBg}, vec(style.page, 0));
  set({ImGuiCol_PopupBg}, vec(mix(style.page, style.text, 0.04)));
  set({ImGuiCol_Border, ImGuiCol_Separator}, vec(style.frame));
  set({ImGuiCol_FrameBg, ImGuiCol_Button}, vec(control));
  set({ImGuiCol_FrameBgHovered, ImGuiCol_ButtonHovered}, vec(hovered));
  set({ImGuiCol_FrameBgActive, ImGuiCol_ButtonActive}, vec(active));
  set({ImGuiCol_Header, ImGuiCol_HeaderHovered}, vec(hovered));
  set({ImGuiCol_HeaderActive}, vec(active));
  set({ImGuiCol_CheckMark, ImGuiCol_SliderGrab, ImGuiCol_PlotHistogram, ImGuiCol_NavHighlight}, vec(accent));
  set({ImGuiCol_SliderGrabActive}, vec(style.highlight));
  set({ImGuiCol_TextSelectedBg}, vec(accent, 0.35));
  set({ImGuiCol_ScrollbarBg}, vec(style.page));
  set({ImGuiCol_ScrollbarGrab}, vec(hovered));
  set({ImGuiCol_ScrollbarGrabHovered, ImGuiCol_ScrollbarGrabActive}, vec(active));
  set({ImGuiCol_ModalWindowDimBg}, vec({0, 0, 0}, 0.45));
}

}  // namespace

const Fonts::Sized& Fonts::nearest(double em_px, bool bold_wanted) const {
  const Sized* best = nullptr;
  for (const Sized& sized : all) {
    if (sized.bold != bold_wanted) continue;
    if (best == nullptr || std::abs(sized.em_px - em_px) < std::abs(best->em_px - em_px)) best = &sized;
  }
  return *best;
}

Fonts load_fonts(double scale) {
  ImGui::GetIO().Fonts->Clear();
  Fonts fonts;
  std::size_t next = 0;
  for (const bool bold : {false, true}) {
    for (const double em_px : {11.0, 13.0, 15.0, 24.0}) {
      const double whole_px = std::round(em_px * scale * kLine_em) / kLine_em;
      fonts.all[next++] = {add_font(em_px * scale, bold), whole_px, bold};
    }
  }
  fonts.small = fonts.all[0].font;
  fonts.body = fonts.all[1].font;
  fonts.bold = fonts.all[5].font;
  fonts.heading = fonts.all[6].font;
  fonts.title = fonts.all[7].font;
  ImGui::GetIO().FontDefault = fonts.body;
  return fonts;
}

const Style& style_of(Theme theme) {
  return theme == Theme::kLight ? kLightStyle : kDarkStyle;
}

ImU32 to_imgui(Colour colour) {
  return IM_COL32(colour.red, colour.green, colour.blue, colour.alpha);
}

ImU32 to_imgui(Colour colour, double opacity) {
  return IM_COL32(colour.red, colour.green, colour.blue, static_cast<int>(std::lround(255 * opacity)));
}

void apply_theme(const Style& style, double scale) {
  ImGuiStyle imgui;
  imgui.WindowPadding = {12, 10};
  imgui.FramePadding = {8, 4};
  imgui.ItemSpacing = {8, 7};
  imgui.ItemInnerSpacing = {6, 4};
  imgui.WindowRounding = imgui.ChildRounding = 0;
  imgui.FrameRounding = imgui.GrabRounding = 3;
  imgui.PopupRounding = 5;
  imgui.WindowBorderSize = 0;
  imgui.PopupBorderSize = 1;
  imgui.FrameBorderSize = 0;
  imgui.ScrollbarSize = 10;
  imgui.GrabMinSize = 10;
  imgui.ScaleAllSizes(static_cast<float>(scale));
  set_colours(imgui.Colors, style);
  ImGui::GetStyle() = imgui;
}

}  // namespace sweepscope::ui
