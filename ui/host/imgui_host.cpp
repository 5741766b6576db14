#include "ui/host/imgui_host.hpp"

#include <backends/imgui_impl_opengl3.h>

#include <algorithm>

#include "render/gl/default_framebuffer.hpp"

namespace sweepscope::ui {
namespace {

void map_keys(ImGuiIO& io) {
  const auto map = [&](ImGuiKey_ key, Key code) { io.KeyMap[key] = code; };
  map(ImGuiKey_Tab, keys::kTab);
  map(ImGuiKey_LeftArrow, keys::kLeft);
  map(ImGuiKey_RightArrow, keys::kRight);
  map(ImGuiKey_UpArrow, keys::kUp);
  map(ImGuiKey_DownArrow, keys::kDown);
  map(ImGuiKey_PageUp, keys::kPageUp);
  map(ImGuiKey_PageDown, keys::kPageDown);
  map(ImGuiKey_Home, keys::kHome);
  map(ImGuiKey_End, keys::kEnd);
  map(ImGuiKey_Delete, keys::kDelete);
  map(ImGuiKey_Backspace, keys::kBackspace);
  map(ImGuiKey_Space, keys::kSpace);
  map(ImGuiKey_Enter, keys::kEnter);
  map(ImGuiKey_Escape, keys::kEscape);
  map(ImGuiKey_A, 'A');
  map(ImGuiKey_C, 'C');
  map(ImGuiKey_V, 'V');
  map(ImGuiKey_X, 'X');
  map(ImGuiKey_Y, 'Y');
  map(ImGuiKey_Z, 'Z');
}

void use_modifiers(ImGuiIO& io, unsigned modifiers) {
  io.KeyShift = (modifiers & kShift) != 0;
  io.KeyCtrl = (modifiers & kCtrl) != 0;
  io.KeyAlt = (modifiers & kAlt) != 0;
}

/// Enter comes as Space while a list is open. However it went down, it goes up as both.
void feed_key(ImGuiIO& io, const InputEvent& event, bool enter_chooses) {
  const auto set = [&](Key key) {
    if (key >= 0 && key < IM_ARRAYSIZE(io.KeysDown)) io.KeysDown[key] = event.down;
  };
  const bool enter = event.key == keys::kEnter;
  if (enter && (enter_chooses || !event.down)) set(keys::kSpace);
  if (!enter || !enter_chooses || !event.down) set(event.key);
  use_modifiers(io, event.modifiers);
}

void feed(ImGuiIO& io, const InputEvent& event, bool enter_chooses) {
  switch (event.what) {
    case InputEvent::What::kMove:
      io.MousePos = {static_cast<float>(event.x), static_cast<float>(event.y)};
      break;
    case InputEvent::What::kButton:
      io.MouseDown[event.button] = event.down;
      use_modifiers(io, event.modifiers);
      break;
    case InputEvent::What::kWheel:
      io.MouseWheel += static_cast<float>(event.wheel);
      break;
    case InputEvent::What::kKey:
      feed_key(io, event, enter_chooses);
      break;
    case InputEvent::What::kText:
      io.AddInputCharactersUTF8(event.text.c_str());
      break;
    case InputEvent::What::kDrop:
      break;  // the interface's own business
  }
}

}  // namespace

ImGuiHost::ImGuiHost(gl::Context& context) : context_(context), imgui_(ImGui::CreateContext()) {
  ImGui::SetCurrentContext(imgui_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.LogFilename = nullptr;
  io.MousePos = {-1, -1};
  io.ClipboardUserData = this;
  io.SetClipboardTextFn = [](void* host, const char* text) {
    static_cast<ImGuiHost*>(host)->clipboard = text;
  };
  io.GetClipboardTextFn = [](void* host) { return static_cast<ImGuiHost*>(host)->clipboard.c_str(); };
  map_keys(io);
  context_.make_current();
  ImGui_ImplOpenGL3_Init("#version 150");
}

ImGuiHost::~ImGuiHost() {
  ImGui::SetCurrentContext(imgui_);
  context_.make_current();
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(imgui_);
}

void ImGuiHost::use(Theme theme, double scale) {
  ImGui::SetCurrentContext(imgui_);
  if (theme == theme_ && scale == scale_) return;
  if (scale != scale_) {
    context_.make_current();  // a window that was resized meanwhile is not
    fonts_ = load_fonts(scale);
    ImGui_ImplOpenGL3_DestroyFontsTexture();  // made again with the next frame
    ImGui_ImplOpenGL3_CreateFontsTexture();
  }
  apply_theme(style_of(theme), scale);
  theme_ = theme;
  scale_ = scale;
}

void ImGuiHost::navigate_by_keys(bool on) {
  ImGui::SetCurrentContext(imgui_);
  ImGuiConfigFlags& flags = ImGui::GetIO().ConfigFlags;
  flags = on ? flags | ImGuiConfigFlags_NavEnableKeyboard : flags & ~ImGuiConfigFlags_NavEnableKeyboard;
}

void ImGuiHost::begin_frame(std::span<const InputEvent> events, double seconds_since_last) {
  ImGui::SetCurrentContext(imgui_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(context_.width_px()), static_cast<float>(context_.height_px())};
  io.DeltaTime = static_cast<float>(std::max(seconds_since_last, 1e-4));
  for (const InputEvent& event : events) feed(io, event, enter_chooses);
  context_.make_current();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

void ImGuiHost::end_frame(Colour background) {
  ImGui::Render();
  background_ = background;
}

void ImGuiHost::paint() {
  ImGui::SetCurrentContext(imgui_);
  gl::begin_default_framebuffer(context_, background_);
  if (ImDrawData* frame = ImGui::GetDrawData()) ImGui_ImplOpenGL3_RenderDrawData(frame);
}

}  // namespace sweepscope::ui
