#include "render/page/page_files.hpp"

#include <array>

#include "render/drawing/embed.hpp"

// The build gives the folder, and the hash of each file that a page's security policy names.
SWEEPSCOPE_EMBED("sweepscope_page_style", SWEEPSCOPE_PAGE_FOLDER "/page.css");
SWEEPSCOPE_EMBED("sweepscope_page_place", SWEEPSCOPE_PAGE_FOLDER "/place.vert");
SWEEPSCOPE_EMBED("sweepscope_page_draw", SWEEPSCOPE_PAGE_FOLDER "/draw.vert");
SWEEPSCOPE_EMBED("sweepscope_page_beams", SWEEPSCOPE_PAGE_FOLDER "/beams.js");
SWEEPSCOPE_EMBED("sweepscope_page_loop", SWEEPSCOPE_PAGE_FOLDER "/loop.js");
SWEEPSCOPE_EMBED("sweepscope_page_splat", SWEEPSCOPE_PAGE_FOLDER "/splat.js");
SWEEPSCOPE_EMBED("sweepscope_page_view", SWEEPSCOPE_PAGE_FOLDER "/view.js");
SWEEPSCOPE_EMBED("sweepscope_page_charts", SWEEPSCOPE_PAGE_FOLDER "/charts.js");
SWEEPSCOPE_EMBED("sweepscope_page_main", SWEEPSCOPE_PAGE_FOLDER "/main.js");

extern "C" {
extern const char sweepscope_page_style_begin[], sweepscope_page_style_end[];
extern const char sweepscope_page_place_begin[], sweepscope_page_place_end[];
extern const char sweepscope_page_draw_begin[], sweepscope_page_draw_end[];
extern const char sweepscope_page_beams_begin[], sweepscope_page_beams_end[];
extern const char sweepscope_page_loop_begin[], sweepscope_page_loop_end[];
extern const char sweepscope_page_splat_begin[], sweepscope_page_splat_end[];
extern const char sweepscope_page_view_begin[], sweepscope_page_view_end[];
extern const char sweepscope_page_charts_begin[], sweepscope_page_charts_end[];
extern const char sweepscope_page_main_begin[], sweepscope_page_main_end[];
}

namespace sweepscope {

PageFile page_style() {
  return {{sweepscope_page_style_begin, sweepscope_page_style_end}, SWEEPSCOPE_PAGE_HASH_page_css};
}

std::span<const PageFile> page_scripts() {
  static const std::array<PageFile, 6> scripts{
      {{{sweepscope_page_beams_begin, sweepscope_page_beams_end}, SWEEPSCOPE_PAGE_HASH_beams_js},
       {{sweepscope_page_loop_begin, sweepscope_page_loop_end}, SWEEPSCOPE_PAGE_HASH_loop_js},
       {{sweepscope_page_splat_begin, sweepscope_page_splat_end}, SWEEPSCOPE_PAGE_HASH_splat_js},
       {{sweepscope_page_view_begin, sweepscope_page_view_end}, SWEEPSCOPE_PAGE_HASH_view_js},
       {{sweepscope_page_charts_begin, sweepscope_page_charts_end}, SWEEPSCOPE_PAGE_HASH_charts_js},
       {{sweepscope_page_main_begin, sweepscope_page_main_end}, SWEEPSCOPE_PAGE_HASH_main_js}}};
  return scripts;
}

std::string_view place_shader() {
  return {sweepscope_page_place_begin, sweepscope_page_place_end};
}

std::string_view draw_shader() {
  return {sweepscope_page_draw_begin, sweepscope_page_draw_end};
}

}  // namespace sweepscope
