#pragma once

#include <string>

#include "render/page/live_map.hpp"

namespace sweepscope {

/// A page of one file: it needs no network, and its security policy allows nothing but its own style, its own
/// scripts and embedded pictures. `title` is plain text, `body` is HTML. The scripts are part of it only with
/// `live`: the data of live_map_data(), or empty.
std::string html_page(const std::string& title, const std::string& body, const std::string& live);

}  // namespace sweepscope
