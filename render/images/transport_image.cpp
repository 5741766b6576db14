#include "render/images/transport_image.hpp"

#include <png.h>
#include <turbojpeg.h>

#include <csetjmp>
#include <memory>
#include <stdexcept>
#include <vector>

#include "render/images/png_bytes.hpp"

namespace sweepscope {
namespace {

struct Free {
  void operator()(unsigned char* bytes) const { tjFree(bytes); }
};
struct Destroy {
  void operator()(void* codec) const { tjDestroy(codec); }
};

void no_flush(png_structp) {}

/// libpng leaves by longjmp: nothing with a destructor lives here.
bool encode_into(png_structp png, png_infop info, const Image& image, const ImageRect& part,
                 std::string& bytes) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &bytes, append_png_bytes, no_flush);
  png_set_IHDR(png, info, static_cast<png_uint_32>(part.width), static_cast<png_uint_32>(part.height), 8,
               PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 1);
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
  png_write_info(png, info);
  png_set_filler(png, 0, PNG_FILLER_AFTER);  // of four channels three are written
  for (int y = part.top; y < part.bottom(); ++y) png_write_row(png, image.pixel(part.left, y));
  png_write_end(png, nullptr);
  return true;
}

}  // namespace

std::string encode_jpeg(const Image& image, const ImageRect& part, int quality) {
  constexpr int kFullColour = 75;
  const std::unique_ptr<void, Destroy> codec(tjInitCompress());
  unsigned char* bytes = nullptr;
  unsigned long length = 0;
  const int failed =
      codec == nullptr
          ? -1
          : tjCompress2(codec.get(), image.pixel(part.left, part.top), part.width,
                        static_cast<int>(Image::kChannels) * image.width_px, part.height, TJPF_RGBX, &bytes,
                        &length, quality >= kFullColour ? TJSAMP_444 : TJSAMP_420, quality, TJFLAG_FASTDCT);
  const std::unique_ptr<unsigned char, Free> owned(bytes);
  if (failed != 0) throw std::logic_error("an image that JPEG cannot hold");
  return {reinterpret_cast<const char*>(bytes), length};
}

std::string encode_png_quickly(const Image& image, const ImageRect& part) {
  std::string bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  const bool encoded = encode_into(png, info, image, part, bytes);
  png_destroy_write_struct(&png, &info);
  if (!encoded) throw std::logic_error("an image that PNG cannot hold");
  return bytes;
}

}  // namespace sweepscope
