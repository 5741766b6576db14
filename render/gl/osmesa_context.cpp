#include <dlfcn.h>
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <vector>

#include "render/gl/offscreen_context.hpp"

namespace sweepscope::gl {
namespace {

// From OSMesa's and OpenGL's interfaces; their headers are not needed otherwise.
constexpr int kOsmesaFormat = 0x22, kOsmesaDepthBits = 0x30, kOsmesaStencilBits = 0x31, kOsmesaProfile = 0x33,
              kOsmesaCoreProfile = 0x34, kOsmesaMajor = 0x36, kOsmesaMinor = 0x37;
constexpr int kGlRgba = 0x1908;
constexpr unsigned kGlUnsignedByte = 0x1401, kGlRenderer = 0x1F01;

/// What libGLdispatch knows of a thread. The tag says whose struct it is: 0 would be GLX's, 1 EGL's, and
/// their libraries would take it for their own.
struct DispatchThreadState {
  int tag = 0x53;
  void (*thread_destroyed)(DispatchThreadState*) = nullptr;
  void* private_state = nullptr;
};

/// Functions of the two libraries, which stay loaded until the program ends.
struct Libraries {
  using Procedure = void (*)();
  using Lookup = void* (*)(const char*, void*);
  void* (*create_context)(const int*, void*) = nullptr;
  unsigned char (*make_current)(void*, void*, unsigned, int, int) = nullptr;
  void (*destroy_context)(void*) = nullptr;
  Procedure (*proc_address)(const char*) = nullptr;
  int (*abi_version)() = nullptr;
  void (*dispatch_init)() = nullptr;
  int (*new_vendor_id)() = nullptr;
  void* (*create_table)(Lookup, void*) = nullptr;
  unsigned char (*dispatch_make_current)(DispatchThreadState*, void*, int, const void*) = nullptr;
  void (*dispatch_lose_current)() = nullptr;
  int vendor_id = 0;
  void* table = nullptr;
};

void* find_procedure(const char* name, void* libraries) {
  return reinterpret_cast<void*>(static_cast<const Libraries*>(libraries)->proc_address(name));
}

template <typename Function>
bool load(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  return function != nullptr;
}

tl::unexpected<Error> cannot_draw(std::string why) {
  return failure(ExitCode::kWrongUsage, "Pictures cannot be drawn: " + std::move(why));
}

/// A library of this machine, by its name or with the reason why there is none.
Result<void*> load_library(const char* name, const char* package) {
  dlerror();
  if (void* library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) return library;
  const char* why = dlerror();
  return cannot_draw(fmt::format("install {} (Debian's package {}): {}", name, package,
                                 why != nullptr ? why : "it cannot be loaded"));
}

Result<Libraries*> load_libraries() {
  static Libraries libs;
  const auto osmesa_library = load_library("libOSMesa.so.8", "libosmesa6");
  if (!osmesa_library) return tl::unexpected(osmesa_library.error());
  const auto dispatch_library = load_library("libGLdispatch.so.0", "libglvnd0");
  if (!dispatch_library) return tl::unexpected(dispatch_library.error());
  void *osmesa = *osmesa_library, *dispatch = *dispatch_library;
  const bool complete = load(osmesa, "OSMesaCreateContextAttribs", libs.create_context) &&
                        load(osmesa, "OSMesaMakeCurrent", libs.make_current) &&
                        load(osmesa, "OSMesaDestroyContext", libs.destroy_context) &&
                        load(osmesa, "OSMesaGetProcAddress", libs.proc_address) &&
                        load(dispatch, "__glDispatchGetABIVersion", libs.abi_version) &&
                        load(dispatch, "__glDispatchInit", libs.dispatch_init) &&
                        load(dispatch, "__glDispatchNewVendorID", libs.new_vendor_id) &&
                        load(dispatch, "__glDispatchCreateTable", libs.create_table) &&
                        load(dispatch, "__glDispatchMakeCurrent", libs.dispatch_make_current) &&
                        load(dispatch, "__glDispatchLoseCurrent", libs.dispatch_lose_current);
  if (!complete) return cannot_draw("libOSMesa or libGLdispatch lacks a function that is needed");
  if (libs.abi_version() != 1) {
    return cannot_draw(fmt::format("libGLdispatch has interface version {}, not 1", libs.abi_version()));
  }
  libs.dispatch_init();
  libs.vendor_id = libs.new_vendor_id();
  libs.table = libs.create_table(find_procedure, &libs);
  if (libs.table == nullptr) return cannot_draw("libGLdispatch refuses a table of functions");
  return &libs;
}

const Result<Libraries*>& libraries_once() {
  static const Result<Libraries*> loaded = load_libraries();
  return loaded;
}

thread_local const Context* current_context = nullptr;

class OsmesaContext final : public OffscreenContext {
 public:
  OsmesaContext(const Libraries& libraries, void* context, int width_px, int height_px)
      : libraries_(libraries), context_(context) {
    resize(width_px, height_px);
  }

  ~OsmesaContext() override {
    release();
    libraries_.destroy_context(context_);
  }

  void make_current() override {
    if (is_current()) return;
    if (current_context != nullptr) libraries_.dispatch_lose_current();
    libraries_.make_current(context_, pixels_.data(), kGlUnsignedByte, width_px_, height_px_);
    libraries_.dispatch_make_current(&thread_state_, libraries_.table, libraries_.vendor_id, nullptr);
    current_context = this;
  }

  void resize(int width_px, int height_px) override {
    release();  // it draws into the pixels until then
    width_px_ = width_px;
    height_px_ = height_px;
    pixels_.resize(std::size_t{4} * static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  }

  void release() override {
    if (!is_current()) return;
    libraries_.dispatch_lose_current();
    libraries_.make_current(nullptr, nullptr, 0, 0, 0);
    current_context = nullptr;
  }

  bool is_current() const override { return current_context == this; }
  int width_px() const override { return width_px_; }
  int height_px() const override { return height_px_; }
  void present() override {}

  std::string renderer() const override {
    using GetString = const unsigned char* (*)(unsigned);
    const auto get_string = reinterpret_cast<GetString>(libraries_.proc_address("glGetString"));
    const auto* name = is_current() ? get_string(kGlRenderer) : nullptr;
    return name != nullptr ? reinterpret_cast<const char*>(name) : "";
  }

 private:
  const Libraries& libraries_;
  void* context_;
  int width_px_ = 0, height_px_ = 0;
  std::vector<std::uint8_t> pixels_;
  DispatchThreadState thread_state_;
};

}  // namespace

Result<void> check_offscreen() {
  return libraries_once().map([](const Libraries*) {});
}

Result<std::unique_ptr<Context>> make_offscreen_context(int width_px, int height_px) {
  return make_resizable_context(width_px, height_px).map([](std::unique_ptr<OffscreenContext>&& context) {
    return std::unique_ptr<Context>(std::move(context));
  });
}

Result<std::unique_ptr<OffscreenContext>> make_resizable_context(int width_px, int height_px) {
  return libraries_once().and_then(
      [&](const Libraries* libraries) -> Result<std::unique_ptr<OffscreenContext>> {
        // A compatibility profile would give other pixels than a window's core profile.
        const std::array<int, 13> attributes{kOsmesaFormat,
                                             kGlRgba,
                                             kOsmesaDepthBits,
                                             24,
                                             kOsmesaStencilBits,
                                             8,
                                             kOsmesaProfile,
                                             kOsmesaCoreProfile,
                                             kOsmesaMajor,
                                             3,
                                             kOsmesaMinor,
                                             3,
                                             0};
        void* context = libraries->create_context(attributes.data(), nullptr);
        if (context == nullptr) {
          return cannot_draw("libOSMesa.so.8 gives no OpenGL 3.3 core context; install Mesa 17 or later");
        }
        return std::make_unique<OsmesaContext>(*libraries, context, width_px, height_px);
      });
}

}  // namespace sweepscope::gl
