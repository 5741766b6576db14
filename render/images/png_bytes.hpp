#pragma once

#include <png.h>

#include <string>

namespace sweepscope {

/// For png_set_write_fn, whose pointer is a std::string.
inline void append_png_bytes(png_structp png, png_bytep bytes, png_size_t length) {
  static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), length);
}

}  // namespace sweepscope
