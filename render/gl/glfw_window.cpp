#include <fmt/format.h>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <array>

#include "render/gl/default_framebuffer.hpp"
#include "render/gl/window.hpp"

namespace sweepscope::gl {
namespace {

std::string last_error() {
  const char* why = nullptr;
  glfwGetError(&why);
  return why != nullptr ? why : "no reason given";
}

class GlfwWindow final : public Window {
 public:
  explicit GlfwWindow(GLFWwindow* window) : window_(window) {
    glfwSetWindowUserPointer(window_, this);
    constexpr std::array kShapes{GLFW_ARROW_CURSOR, GLFW_HAND_CURSOR, GLFW_IBEAM_CURSOR, GLFW_HRESIZE_CURSOR};
    for (std::size_t i = 0; i < kShapes.size(); ++i) cursors_[i] = glfwCreateStandardCursor(kShapes[i]);
    listen();
  }
  ~GlfwWindow() override {
    for (GLFWcursor* cursor : cursors_) glfwDestroyCursor(cursor);
    glfwDestroyWindow(window_);
    glfwTerminate();
  }

  void make_current() override {
    if (!is_current()) glfwMakeContextCurrent(window_);
  }
  void release() override {
    if (is_current()) glfwMakeContextCurrent(nullptr);
  }
  bool is_current() const override { return glfwGetCurrentContext() == window_; }
  int width_px() const override { return size().first; }
  int height_px() const override { return size().second; }
  void present() override { glfwSwapBuffers(window_); }
  std::string renderer() const override { return is_current() ? renderer_of_current() : ""; }

  void wait(double max_s) override {
    if (max_s > 0)
      glfwWaitEventsTimeout(max_s);
    else
      glfwPollEvents();
  }
  bool take_close() override {
    const bool asked = glfwWindowShouldClose(window_) != 0;
    glfwSetWindowShouldClose(window_, GLFW_FALSE);
    return asked;
  }
  double scale() const override {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    return static_cast<double>(x);
  }
  void set_title(const std::string& title) override { glfwSetWindowTitle(window_, title.c_str()); }
  void set_cursor(Cursor cursor) override {
    glfwSetCursor(window_, cursors_[static_cast<std::size_t>(cursor)]);
  }
  std::string clipboard() const override {
    const char* text = glfwGetClipboardString(window_);
    return text != nullptr ? text : "";
  }
  void set_clipboard(const std::string& text) override { glfwSetClipboardString(window_, text.c_str()); }

 private:
  static GlfwWindow& self(GLFWwindow* window) {
    return *static_cast<GlfwWindow*>(glfwGetWindowUserPointer(window));
  }
  std::pair<int, int> size() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {width, height};
  }
  /// Framebuffer pixels per unit of the window: not 1 on some desktops.
  double pixels_per_unit() const {
    int width = 0, height = 0;
    glfwGetWindowSize(window_, &width, &height);
    return width > 0 ? static_cast<double>(size().first) / width : 1;
  }

  void listen() {
    glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) {
      const double scale = self(w).pixels_per_unit();
      if (self(w).events.moved) self(w).events.moved(x * scale, y * scale);
    });
    glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int modifiers) {
      if (button <= 2 && self(w).events.pressed)
        self(w).events.pressed(button, action == GLFW_PRESS, modifiers);
    });
    glfwSetScrollCallback(window_, [](GLFWwindow* w, double, double y) {
      if (self(w).events.scrolled) self(w).events.scrolled(y);
    });
    glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int, int action, int modifiers) {
      if (self(w).events.key) self(w).events.key(key, action != GLFW_RELEASE, modifiers);
    });
    glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned code_point) {
      if (self(w).events.typed) self(w).events.typed(code_point);
    });
    glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** paths) {
      for (int i = 0; i < count && self(w).events.dropped; ++i) self(w).events.dropped(paths[i]);
    });
    const auto changed = [](GLFWwindow* w) {
      if (self(w).events.changed) self(w).events.changed();
    };
    glfwSetWindowRefreshCallback(window_, changed);
    glfwSetFramebufferSizeCallback(window_, [](GLFWwindow* w, int, int) {
      if (self(w).events.changed) self(w).events.changed();
    });
    glfwSetWindowContentScaleCallback(window_, [](GLFWwindow* w, float, float) {
      if (self(w).events.changed) self(w).events.changed();
    });
  }

  GLFWwindow* window_;
  std::array<GLFWcursor*, 4> cursors_{};
};

/// A size that fits the screen, below the window's title.
void fit_screen(int& width_px, int& height_px) {
  constexpr int kTitle_px = 36;
  int x = 0, y = 0, width = 0, height = 0;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  if (monitor != nullptr) glfwGetMonitorWorkarea(monitor, &x, &y, &width, &height);
  if (width > 0 && width_px > width) width_px = width;
  if (height > kTitle_px) height_px = std::min(height_px, height - kTitle_px);
}

}  // namespace

Result<std::unique_ptr<Window>> make_window(int width_px, int height_px, const std::string& title) {
  if (glfwInit() == 0)
    return failure(ExitCode::kWrongUsage, fmt::format("No window can be opened: {}", last_error()));
  fit_screen(width_px, height_px);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  glfwWindowHint(GLFW_SAMPLES, 0);
  GLFWwindow* window = glfwCreateWindow(width_px, height_px, title.c_str(), nullptr, nullptr);
  if (window == nullptr) {
    const std::string why = last_error();
    glfwTerminate();
    return failure(ExitCode::kWrongUsage,
                   fmt::format("No window with OpenGL 3.3 can be opened: {}; install a driver that has it "
                               "(Debian's package libgl1-mesa-dri)",
                               why));
  }
  return std::make_unique<GlfwWindow>(window);
}

double display_scale() {
  float x = 1, y = 1;
  GLFWmonitor* monitor = glfwInit() != 0 ? glfwGetPrimaryMonitor() : nullptr;
  if (monitor != nullptr) glfwGetMonitorContentScale(monitor, &x, &y);
  return static_cast<double>(x);
}

void wake_window() {
  glfwPostEmptyEvent();
}

}  // namespace sweepscope::gl
