#pragma once

#include <span>
#include <string_view>

namespace sweepscope {

/// A file of assets/page, embedded in the program.
struct PageFile {
  std::string_view text;
  std::string_view sha256_hex;  // of the text
};

PageFile page_style();
/// In the order in which the page runs them.
std::span<const PageFile> page_scripts();
/// The shaders (GLSL ES 3.00): of placing the beams, and of drawing the points.
std::string_view place_shader();
std::string_view draw_shader();

}  // namespace sweepscope
