#include "render/page/html.hpp"

#include <fmt/format.h>

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>

#include "core/io/printable_text.hpp"

namespace sweepscope::html {
std::string base64(std::string_view bytes) {
  using Digits = boost::archive::iterators::base64_from_binary<
      boost::archive::iterators::transform_width<std::string_view::const_iterator, 6, 8>>;
  std::string text(Digits(bytes.begin()), Digits(bytes.end()));
  text.append((3 - bytes.size() % 3) % 3, '=');
  return text;
}

std::string escape(std::string_view text) {
  return markup_line(text);
}

std::string element(std::string_view name, std::string_view inside) {
  return fmt::format("<{0}>{1}</{0}>\n", name, inside);
}

std::string json_block(std::string_view id, std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, json);
}

std::string data_block(std::string_view id, std::string_view bytes) {
  return fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, base64(bytes));
}

std::string png_image(std::string_view png, std::string_view alternative) {
  return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", escape(alternative), base64(png));
}

std::string png_images(std::string_view light_png, std::string_view dark_png, std::string_view alternative) {
  return fmt::format(
      "<picture><source media=\"screen and (prefers-color-scheme: dark)\" "
      "srcset=\"data:image/png;base64,{}\">{}</picture>",
      base64(dark_png), png_image(light_png, alternative));
}

std::string inline_svg(std::string_view svg) {
  const std::size_t begin = svg.find("<svg");
  return std::string(begin == std::string_view::npos ? "" : svg.substr(begin));
}

}  // namespace sweepscope::html
