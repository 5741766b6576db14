#pragma once

#include <functional>
#include <span>
#include <string>

#include "ui/serve/server.hpp"
#include "ui/window_loop.hpp"

namespace sweepscope::ui {

struct ServeOptions {
  WindowOptions window;  // before the first page gives its size
  Server::Options server;
  /// Called with the text of the addresses once it listens.
  std::function<void(const std::string&)> say;
};

/// Runs the explorer for pages of browsers until a viewer quits it, or, with Hub::Options::once, the last one
/// left. `first_line` is executed first, then the scripts.
Result<void> run_served(Ui::Options options, ServeOptions wanted, const std::string& first_line,
                        std::span<const Script> scripts);

/// What a person needs to open the page: the address with its token, and how to reach it from elsewhere.
std::string how_to_reach(const ListenAddress& address, const std::string& token, const std::string& user,
                         const std::string& host);

}  // namespace sweepscope::ui
