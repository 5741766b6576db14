#include <cairo-ft.h>
#include <cairo-pdf.h>
#include <ft2build.h>
#include FT_FREETYPE_H

#include <cmath>
#include <stdexcept>

#include "core/io/atomic_file.hpp"
#include "core/io/printable_text.hpp"
#include "render/drawing/fonts.hpp"
#include "render/vector/vector_file.hpp"
#include "render/vector/view_images.hpp"

namespace sweepscope {
namespace {

constexpr double kPointsPerPixel = 72.0 / 96.0;

/// FreeType's side of a font, which lives as long as cairo's.
struct FontSource {
  FT_Library library = nullptr;
  FT_Face face = nullptr;

  FontSource() = default;
  FontSource(const FontSource&) = delete;
  FontSource& operator=(const FontSource&) = delete;
  ~FontSource() {
    FT_Done_Face(face);
    FT_Done_FreeType(library);
  }
};

struct DestroyFont {
  void operator()(cairo_font_face_t* face) const { cairo_font_face_destroy(face); }
};
using Font = std::unique_ptr<cairo_font_face_t, DestroyFont>;

Font open_font(bool bold) {
  static const cairo_user_data_key_t kSource{};
  auto source = std::make_unique<FontSource>();
  const std::string_view bytes = font_bytes(bold);
  if (FT_Init_FreeType(&source->library) != 0 ||
      FT_New_Memory_Face(source->library, reinterpret_cast<const FT_Byte*>(bytes.data()),
                         static_cast<FT_Long>(bytes.size()), 0, &source->face) != 0) {
    throw std::runtime_error("the font inside the program cannot be read");
  }
  Font font(cairo_ft_font_face_create_for_ft_face(source->face, FT_LOAD_NO_HINTING));
  cairo_font_face_set_user_data(font.get(), &kSource, source.release(),
                                [](void* owned) { delete static_cast<FontSource*>(owned); });
  return font;
}

/// Paints marks onto a page of which a unit is a pixel.
class Painter {
 public:
  explicit Painter(cairo_surface_t* page) : cairo_(cairo_create(page)) {
    cairo_scale(cairo_, kPointsPerPixel, kPointsPerPixel);
    cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    cairo_set_font_options(cairo_, options);
    cairo_font_options_destroy(options);
  }
  ~Painter() { cairo_destroy(cairo_); }
  Painter(const Painter&) = delete;
  Painter& operator=(const Painter&) = delete;

  void paint_background(Colour colour) {
    if (colour.alpha == 0) return;
    set_colour(colour);
    cairo_paint(cairo_);
  }

  void paint(const ViewImage& view) {
    cairo_save(cairo_);
    cairo_rectangle(cairo_, view.place.left, view.place.top, view.place.width, view.place.height);
    cairo_clip(cairo_);  // viewers may widen an image to whole pixels
    cairo_translate(cairo_, view.place.left, view.place.top);
    cairo_scale(cairo_, view.place.width / cairo_image_surface_get_width(view.image.get()),
                view.place.height / cairo_image_surface_get_height(view.image.get()));
    cairo_set_source_surface(cairo_, view.image.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cairo_), CAIRO_FILTER_NEAREST);
    cairo_paint(cairo_);
    cairo_restore(cairo_);
  }

  void paint(const TextMark& mark) {
    const double width = text_width_px(mark.text, mark.size_px, mark.bold);
    const double before = mark.align_x == AlignX::kLeft     ? 0
                          : mark.align_x == AlignX::kCentre ? width / 2
                                                            : width;
    set_colour(mark.colour);
    cairo_set_font_face(cairo_, (mark.bold ? bold_ : regular_).get());
    cairo_set_font_size(cairo_, mark.size_px);
    cairo_move_to(cairo_, mark.at.x - before, baseline_y(mark));
    cairo_show_text(cairo_, printable_line(mark.text).c_str());
  }

  void paint(const LineMark& mark) {
    if (mark.points.size() < 2) return;
    set_colour(mark.colour);
    cairo_set_line_width(cairo_, mark.width_px);
    cairo_set_dash(cairo_, &mark.dash_px, mark.dash_px > 0 ? 1 : 0, 0);
    trace(mark.points);
    cairo_stroke(cairo_);
  }

  void paint(const PolygonMark& mark) {
    set_colour(mark.colour);
    trace(mark.points);
    cairo_close_path(cairo_);
    cairo_fill(cairo_);
  }

  void paint(const AreaMark& mark) {
    if (mark.points.size() < 2) return;
    set_colour(mark.colour);
    trace(mark.points);
    cairo_line_to(cairo_, mark.points.back().x, mark.base_y);
    cairo_line_to(cairo_, mark.points.front().x, mark.base_y);
    cairo_close_path(cairo_);
    cairo_fill(cairo_);
  }

 private:
  void set_colour(Colour colour) {
    cairo_set_source_rgba(cairo_, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0,
                          colour.alpha / 255.0);
  }
  void trace(const std::vector<PixelPoint>& points) {
    cairo_new_path(cairo_);
    for (const PixelPoint& point : points) cairo_line_to(cairo_, point.x, point.y);
  }

  cairo_t* cairo_;
  Font regular_ = open_font(false), bold_ = open_font(true);
};

void set_metadata(cairo_surface_t* page, std::span<const PngText> texts) {
  const auto set = [&](cairo_pdf_metadata_t what, const std::string& text) {
    cairo_pdf_surface_set_metadata(page, what, printable_text(text).c_str());
  };
  std::string others;
  for (const PngText& text : texts) {
    if (text.key == "Title") {
      set(CAIRO_PDF_METADATA_TITLE, text.text);
    } else if (text.key == "Software") {
      set(CAIRO_PDF_METADATA_CREATOR, text.text);
    } else {
      others += (others.empty() ? "" : "; ") + text.key + ": " + text.text;
    }
  }
  if (!others.empty()) set(CAIRO_PDF_METADATA_SUBJECT, others);
  cairo_pdf_surface_set_metadata(page, CAIRO_PDF_METADATA_CREATE_DATE, nullptr);  // else the clock's
}

}  // namespace

Result<std::string> encode_pdf(const Picture& picture, std::span<const PngText> texts) {
  const auto views = view_images(picture);
  if (!views) return tl::unexpected(views.error());
  std::string pdf;
  const Surface page(cairo_pdf_surface_create_for_stream(
      append_bytes, &pdf, picture.width_px * kPointsPerPixel, picture.height_px * kPointsPerPixel));
  set_metadata(page.get(), texts);
  {
    Painter painter(page.get());
    painter.paint_background(picture.background);
    for (const ViewImage& view : *views) painter.paint(view);
    const Drawing marks = flat_marks(picture);
    for (const Drawing::Mark& mark : marks.marks())
      std::visit([&](const auto& one) { painter.paint(one); }, mark);
  }
  cairo_surface_finish(page.get());
  if (const cairo_status_t status = cairo_surface_status(page.get()); status != CAIRO_STATUS_SUCCESS)
    throw std::logic_error(std::string("a picture that PDF cannot hold: ") + cairo_status_to_string(status));
  return pdf;
}

Result<void> write_pdf(const std::filesystem::path& path, const Picture& picture,
                       std::span<const PngText> texts) {
  return encode_pdf(picture, texts).and_then([&](const std::string& pdf) { return write_file(path, pdf); });
}

}  // namespace sweepscope
