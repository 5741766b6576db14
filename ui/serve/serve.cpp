#include "ui/serve/serve.hpp"

#include <fmt/format.h>
#include <pwd.h>
#include <unistd.h>

#include <array>

#include "core/io/printable_text.hpp"
#include "ui/serve/served_window.hpp"

namespace sweepscope::ui {
namespace {

std::string user_name() {
  const passwd* entry = getpwuid(geteuid());
  return entry != nullptr ? entry->pw_name : "USER";
}

std::string host_name() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 && name.front() != '\0' ? name.data() : "HOST";
}

}  // namespace

std::string how_to_reach(const ListenAddress& address, const std::string& token, const std::string& user,
                         const std::string& host) {
  if (!address.loopback) {
    const bool any = address.host == "0.0.0.0" || address.host == "::";
    const std::string place = any ? fmt::format("ADDRESS-OF-THIS-MACHINE:{}", address.port) : address.text();
    return fmt::format(
        "The explorer is at\n    http://{}/#token={}\nWarning: nothing is encrypted. Everyone who can read "
        "the network between you and this machine sees the picture and the token. It is safer to listen on "
        "127.0.0.1 and to use ssh -L, or a reverse proxy with TLS (docs/remote.md).\n",
        place, token);
  }
  return fmt::format(
      "The explorer is at\n    http://{0}/#token={1}\n"
      "From another machine, first type there\n    ssh -N -L {2}:{0} {3}@{4}\nand open http://localhost:{2}/"
      "#token={1}\n",
      address.text(), token, address.port, printable_line(user), printable_line(host));
}

Result<void> run_served(Ui::Options options, ServeOptions wanted, const std::string& first_line,
                        std::span<const Script> scripts) {
  auto context = gl::make_resizable_context(wanted.window.width_px, wanted.window.height_px);
  if (!context) return tl::unexpected(context.error());
  Mailbox mailbox;
  const std::string token = wanted.server.token;
  auto server = Server::start(std::move(wanted.server), mailbox);
  if (!server) return tl::unexpected(server.error());
  ServedWindow window(std::move(*context), mailbox, **server);
  if (wanted.say) wanted.say(how_to_reach((*server)->address(), token, user_name(), host_name()));
  const WindowHooks hooks{.wake = [&] { mailbox.wake(); },
                          .started =
                              [&](Ui& ui) {
                                window.at_rest = [&ui] {
                                  return ui.explorer().at_rest() && ui.pictures_done() && !ui.has_input();
                                };
                                window.has_input = [&ui] { return ui.has_input(); };
                                ui.explorer().exports.wrote = [&](const std::filesystem::path& file) {
                                  (*server)->offer(file);
                                };
                              }};
  return run_explorer(window, std::move(options), wanted.window.record, hooks, first_line, scripts);
}

}  // namespace sweepscope::ui
