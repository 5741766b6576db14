#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace sweepscope::ui {

/// 256 random bits from the system as 64 hexadecimal digits. Throws if the system has none.
std::string random_token();

/// The time that it takes depends on the length of `expected` alone.
bool equal_in_constant_time(std::string_view given, std::string_view expected);

/// The names by which browsers may address a server.
struct HostPolicy {
  bool anywhere = false;           // numeric addresses other than those of this machine alone
  std::vector<std::string> names;  // besides localhost, such as that of a reverse proxy
};

/// Whether a Host header names this server. A site of an attacker whose name leads to this machine (DNS
/// rebinding) has a name of its own: names other than localhost must be listed. Ports do not matter, since a
/// tunnel changes them.
bool is_own_host(std::string_view host_header, const HostPolicy& policy);

/// Whether an Origin header is the server's own page: http or https, and exactly the Host header.
bool is_own_origin(std::string_view origin, std::string_view host_header);

}  // namespace sweepscope::ui
