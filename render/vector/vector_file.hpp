#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/error.hpp"
#include "render/images/image.hpp"
#include "render/pictures/canvas.hpp"
#include "render/pictures/picture.hpp"

namespace sweepscope {

/// The picture as SVG or PDF: views of scenes as embedded images, marks as shapes, and text as text that can
/// be searched and selected. One pixel is 1/96 inch. PDF holds the fonts; SVG names them, with the width of
/// each text, so that another font keeps the layout. The texts go into the file's metadata (in PDF "Title"
/// and "Software" in their own places, the others as the subject).
///
/// The same picture and texts give the same bytes: no time, no host name. Errors as in draw.
Result<std::string> encode_svg(const Picture& picture, std::span<const PngText> texts = {});
Result<std::string> encode_pdf(const Picture& picture, std::span<const PngText> texts = {});

Result<void> write_svg(const std::filesystem::path& path, const Picture& picture,
                       std::span<const PngText> texts = {});
Result<void> write_pdf(const std::filesystem::path& path, const Picture& picture,
                       std::span<const PngText> texts = {});

/// Whether the path's extension is one that write_picture writes.
Result<void> check_picture_path(const std::filesystem::path& path);

/// As PNG, SVG or PDF, by the path's extension; another one is ExitCode::kWrongUsage. A PNG is drawn on the
/// canvas; without a canvas, and for images inside the others, off screen.
Result<void> write_picture(const std::filesystem::path& path, const Picture& picture,
                           std::span<const PngText> texts, Canvas& canvas);
Result<void> write_picture(const std::filesystem::path& path, const Picture& picture,
                           std::span<const PngText> texts = {});

}  // namespace sweepscope
