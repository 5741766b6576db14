#include "tests/screenshots/machine_facts.hpp"

#include <dlfcn.h>
#include <fmt/format.h>
#include <vtkVersion.h>

#include <fstream>
#include <thread>

#include "render/gl/context.hpp"

namespace sweepscope::screenshots {
namespace {

constexpr unsigned kGlVersion = 0x1F02;

/// "4.5 (Core Profile) Mesa 22.3.6", of the current context.
std::string gl_version() {
  using GetString = const unsigned char* (*)(unsigned);
  void* library = dlopen("libGL.so.1", RTLD_NOW | RTLD_LOCAL);
  const auto get_string =
      reinterpret_cast<GetString>(library != nullptr ? dlsym(library, "glGetString") : nullptr);
  const unsigned char* version = get_string != nullptr ? get_string(kGlVersion) : nullptr;
  return version != nullptr ? reinterpret_cast<const char*>(version) : "unknown";
}

/// The processor's model and those of its instruction sets that llvmpipe chooses its code by.
std::string processor() {
  std::string line, model = "unknown", sets;
  for (std::ifstream file("/proc/cpuinfo"); std::getline(file, line) && !line.empty();) {
    if (line.starts_with("model name")) model = line.substr(line.find(':') + 2);
    if (!line.starts_with("flags")) continue;
    for (const char* set : {"sse4_1", "avx", "avx2", "fma", "f16c", "avx512f"}) {
      if ((line + " ").find(fmt::format(" {} ", set)) != std::string::npos) sets += fmt::format(" {}", set);
    }
  }
  return fmt::format("{}, {} threads,{}", model, std::thread::hardware_concurrency(), sets);
}

}  // namespace

Result<std::string> machine_facts() {
  auto context = gl::make_offscreen_context(16, 16);
  if (!context) return tl::unexpected(context.error());
  (*context)->make_current();
  const std::string renderer = (*context)->renderer(), version = gl_version();
  (*context)->release();
  if (!renderer.starts_with("llvmpipe")) {
    return failure(ExitCode::kUnreadableInput,
                   "the baselines are llvmpipe's, and what draws here is " + renderer);
  }
  return fmt::format("OpenGL renderer  {}\nOpenGL version   {}\nVTK              {}\nprocessor        {}\n",
                     renderer, version, vtkVersion::GetVTKVersion(), processor());
}

}  // namespace sweepscope::screenshots
