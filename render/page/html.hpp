#pragma once

#include <string>
#include <string_view>

namespace sweepscope::html {

/// A text of one line, made printable, with HTML's markup characters as entities.
std::string escape(std::string_view text);

/// "<name>inside</name>" and a line end.
std::string element(std::string_view name, std::string_view inside);

std::string base64(std::string_view bytes);

/// JSON for a script of the page, under an id. No text in it can end the block.
std::string json_block(std::string_view id, std::string json);

/// Bytes for a script of the page, under an id, as base64.
std::string data_block(std::string_view id, std::string_view bytes);

/// A PNG file as an image inside the page.
std::string png_image(std::string_view png, std::string_view alternative);

/// The same for light pages and paper, with another one for dark screens.
std::string png_images(std::string_view light_png, std::string_view dark_png, std::string_view alternative);

/// An SVG file as an element of the page.
std::string inline_svg(std::string_view svg);

}  // namespace sweepscope::html
