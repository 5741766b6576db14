#include "ui/serve/http/served_files.hpp"

#include <algorithm>
#include <array>

#include "render/drawing/embed.hpp"

// The build gives the folder.
SWEEPSCOPE_EMBED("sweepscope_serve_page", SWEEPSCOPE_SERVE_FOLDER "/index.html");
SWEEPSCOPE_EMBED("sweepscope_serve_style", SWEEPSCOPE_SERVE_FOLDER "/serve.css");
SWEEPSCOPE_EMBED("sweepscope_serve_frames", SWEEPSCOPE_SERVE_FOLDER "/frames.js");
SWEEPSCOPE_EMBED("sweepscope_serve_input", SWEEPSCOPE_SERVE_FOLDER "/input.js");
SWEEPSCOPE_EMBED("sweepscope_serve_touch", SWEEPSCOPE_SERVE_FOLDER "/touch.js");
SWEEPSCOPE_EMBED("sweepscope_serve_upload", SWEEPSCOPE_SERVE_FOLDER "/upload.js");
SWEEPSCOPE_EMBED("sweepscope_serve_main", SWEEPSCOPE_SERVE_FOLDER "/main.js");

extern "C" {
extern const char sweepscope_serve_page_begin[], sweepscope_serve_page_end[];
extern const char sweepscope_serve_style_begin[], sweepscope_serve_style_end[];
extern const char sweepscope_serve_frames_begin[], sweepscope_serve_frames_end[];
extern const char sweepscope_serve_input_begin[], sweepscope_serve_input_end[];
extern const char sweepscope_serve_touch_begin[], sweepscope_serve_touch_end[];
extern const char sweepscope_serve_upload_begin[], sweepscope_serve_upload_end[];
extern const char sweepscope_serve_main_begin[], sweepscope_serve_main_end[];
}

namespace sweepscope::ui {

const ServedFile* find_served_file(std::string_view path) {
  constexpr std::string_view kScript = "text/javascript; charset=utf-8";
  static const std::array<ServedFile, 7> files{
      {{"/", "text/html; charset=utf-8", {sweepscope_serve_page_begin, sweepscope_serve_page_end}},
       {"/serve.css", "text/css; charset=utf-8", {sweepscope_serve_style_begin, sweepscope_serve_style_end}},
       {"/frames.js", kScript, {sweepscope_serve_frames_begin, sweepscope_serve_frames_end}},
       {"/input.js", kScript, {sweepscope_serve_input_begin, sweepscope_serve_input_end}},
       {"/touch.js", kScript, {sweepscope_serve_touch_begin, sweepscope_serve_touch_end}},
       {"/upload.js", kScript, {sweepscope_serve_upload_begin, sweepscope_serve_upload_end}},
       {"/main.js", kScript, {sweepscope_serve_main_begin, sweepscope_serve_main_end}}}};
  const auto found =
      std::find_if(files.begin(), files.end(), [&](const ServedFile& file) { return file.path == path; });
  return found == files.end() ? nullptr : &*found;
}

}  // namespace sweepscope::ui
