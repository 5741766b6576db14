#include "ui/serve/http/address.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>

#include "core/io/printable_text.hpp"

namespace sweepscope::ui {
namespace {

enum class Family { kNone, kV4, kV6 };

Family family_of(const std::string& host) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  if (inet_pton(AF_INET, host.c_str(), bytes.data()) == 1) return Family::kV4;
  if (inet_pton(AF_INET6, host.c_str(), bytes.data()) == 1) return Family::kV6;
  return Family::kNone;
}

std::optional<std::uint16_t> port_of(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, failed] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (text.empty() || failed != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return port;
}

bool all_digits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

struct Parts {
  std::string_view host, port;
};

/// An IPv6 address alone has colons of its own.
Parts split(std::string_view text) {
  if (all_digits(text)) return {{}, text};
  if (text.starts_with('[')) {
    const std::size_t end = text.find(']');
    if (end == text.npos) return {text, {}};
    const std::string_view rest = text.substr(end + 1);
    return {text.substr(1, end - 1), rest.starts_with(':') ? rest.substr(1) : rest};
  }
  const std::size_t colon = text.find(':');
  if (colon == text.npos || text.find(':', colon + 1) != text.npos) return {text, {}};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

}  // namespace

std::string ListenAddress::text() const {
  return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port)
                                             : fmt::format("[{}]:{}", host, port);
}

Result<ListenAddress> parse_listen_address(std::string_view text, std::uint16_t default_port) {
  ListenAddress address;
  address.port = default_port;
  const auto [host, port] = split(text);
  if (!host.empty()) address.host = host == "localhost" ? "127.0.0.1" : std::string(host);
  const Family family = family_of(address.host);
  const auto number = port.empty() ? std::optional(address.port) : port_of(port);
  if (family == Family::kNone || !number)
    return failure(ExitCode::kWrongUsage,
                   fmt::format("--serve {}: ADDRESS:PORT is needed, such as 127.0.0.1:{}, where ADDRESS is a "
                               "number of this machine or localhost; other arguments come before --serve",
                               printable_line(text), default_port));
  address.port = *number;
  address.loopback = family == Family::kV4 ? address.host.starts_with("127.") : address.host == "::1";
  return address;
}

Result<ListenAddress> allowed_listen_address(std::string_view text, bool anywhere, std::uint16_t port) {
  auto address = parse_listen_address(text, port);
  if (!address || address->loopback || anywhere) return address;
  return failure(
      ExitCode::kWrongUsage,
      fmt::format("--serve {}: other machines would reach it without encryption. Use 127.0.0.1 and "
                  "ssh -L, or add --listen-anywhere",
                  printable_line(text)));
}

}  // namespace sweepscope::ui
