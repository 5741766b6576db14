#pragma once

#include <string>
#include <string_view>

namespace sweepscope::html {

/// A text of one line, made printable, with HTML's markup characters as entities.
std::string escape(std::string_view text);

/// "<name>inside</name>" and a line end.
std::string element(std::string_view name, std::string_view inside);

/// A PNG file as an image inside the page.
std::string png_image(std::string_view png, std::string_view alternative);

/// An SVG file as an element of the page.
std::string inline_svg(std::string_view svg);

}  // namespace sweepscope::html
