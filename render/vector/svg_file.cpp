#include <fmt/format.h>

#include <cmath>

#include "core/io/atomic_file.hpp"
#include "core/io/printable_text.hpp"
#include "render/vector/vector_file.hpp"
#include "render/vector/view_images.hpp"

namespace sweepscope {
namespace {

/// Text as XML holds it: markup as entities, and the control characters that XML forbids escaped.
std::string escaped(const std::string& text) {
  return markup_escaped(printable_text(text));
}

/// To a thousandth of a pixel, without what follows the last digit that counts.
std::string number(double value) {
  std::string text = fmt::format("{:.3f}", std::round(value * 1e3) / 1e3 + 0.0);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string paint_of(const char* what, Colour colour) {
  std::string text = fmt::format("{}=\"#{:02x}{:02x}{:02x}\"", what, colour.red, colour.green, colour.blue);
  if (colour.alpha != 255) text += fmt::format(" {}-opacity=\"{}\"", what, number(colour.alpha / 255.0));
  return text;
}

std::string points_of(const std::vector<PixelPoint>& points) {
  std::string text;
  for (const PixelPoint& point : points)
    text += fmt::format("{}{},{}", text.empty() ? "" : " ", number(point.x), number(point.y));
  return text;
}

std::string element(const TextMark& mark) {
  if (mark.text.empty()) return "";
  const char* anchor = mark.align_x == AlignX::kLeft     ? ""
                       : mark.align_x == AlignX::kCentre ? " text-anchor=\"middle\""
                                                         : " text-anchor=\"end\"";
  return fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\"{}{} textLength=\"{}\" {}>{}</text>\n",
                     number(mark.at.x), number(baseline_y(mark)), number(mark.size_px), anchor,
                     mark.bold ? " font-weight=\"bold\"" : "",
                     number(text_width_px(mark.text, mark.size_px, mark.bold)), paint_of("fill", mark.colour),
                     escaped(mark.text));
}

std::string element(const LineMark& mark) {
  if (mark.points.size() < 2) return "";
  const std::string dashes =
      mark.dash_px > 0 ? fmt::format(" stroke-dasharray=\"{}\"", number(mark.dash_px)) : "";
  return fmt::format(
      "<polyline points=\"{}\" fill=\"none\" stroke-width=\"{}\" stroke-linejoin=\"round\"{} {}/>\n",
      points_of(mark.points), number(mark.width_px), dashes, paint_of("stroke", mark.colour));
}

std::string element(const PolygonMark& mark) {
  return fmt::format("<polygon points=\"{}\" {}/>\n", points_of(mark.points), paint_of("fill", mark.colour));
}

std::string element(const AreaMark& mark) {
  if (mark.points.size() < 2) return "";
  std::vector<PixelPoint> outline = mark.points;
  outline.push_back({mark.points.back().x, mark.base_y});
  outline.push_back({mark.points.front().x, mark.base_y});
  return element(PolygonMark{std::move(outline), mark.colour});
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t triple = 0;
    for (std::size_t k = 0; k < 3; ++k)
      triple = triple << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : kDigits[triple >> (18 - 6 * k) & 63U];
  }
  return out;
}

std::string element(const ViewImage& view) {
  std::string png;
  cairo_surface_write_to_png_stream(view.image.get(), append_bytes, &png);
  const PixelRect& place = view.place;
  return fmt::format(
      "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" xlink:href=\"data:image/png;base64,{}\"/>\n",
      number(place.left), number(place.top), number(place.width), number(place.height), base64(png));
}

std::string metadata_of(std::span<const PngText> texts) {
  std::string title, entries;
  for (const PngText& text : texts) {
    if (text.key == "Title") title = fmt::format("<title>{}</title>\n", escaped(text.text));
    entries += fmt::format("<s:text key=\"{}\">{}</s:text>\n", escaped(text.key), escaped(text.text));
  }
  if (entries.empty()) return title;
  return fmt::format("{}<metadata xmlns:s=\"urn:sweepscope:texts\">\n{}</metadata>\n", title, entries);
}

}  // namespace

Result<std::string> encode_svg(const Picture& picture, std::span<const PngText> texts) {
  const auto views = view_images(picture);
  if (!views) return tl::unexpected(views.error());
  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" "
      "width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\" font-family=\"'DejaVu Sans', Verdana, "
      "sans-serif\" xml:space=\"preserve\">\n",
      picture.width_px, picture.height_px);
  svg += metadata_of(texts);
  if (picture.background.alpha > 0) {
    svg += fmt::format("<rect width=\"{}\" height=\"{}\" {}/>\n", picture.width_px, picture.height_px,
                       paint_of("fill", picture.background));
  }
  for (const ViewImage& view : *views) svg += element(view);
  const Drawing marks = flat_marks(picture);
  for (const Drawing::Mark& mark : marks.marks())
    svg += std::visit([](const auto& one) { return element(one); }, mark);
  return svg + "</svg>\n";
}

Result<void> write_svg(const std::filesystem::path& path, const Picture& picture,
                       std::span<const PngText> texts) {
  return encode_svg(picture, texts).and_then([&](const std::string& svg) { return write_file(path, svg); });
}

}  // namespace sweepscope
