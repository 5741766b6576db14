#include "ui/serve/http/access.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <optional>
#include <system_error>

namespace sweepscope::ui {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

/// The name or number of a Host header, without its port and brackets; nothing if it is no such header.
std::optional<std::string> name_of(std::string_view header) {
  constexpr std::string_view kAllowed = "abcdefghijklmnopqrstuvwxyz0123456789.-:[]";
  const std::string text = lower(header);
  if (text.empty() || text.size() > 255 || text.find_first_not_of(kAllowed) != text.npos) return std::nullopt;
  const bool bracketed = text.front() == '[';
  const std::size_t end = bracketed ? text.find(']') : text.find(':');
  const std::string name = bracketed ? text.substr(1, end - 1) : text.substr(0, end);
  const std::string rest = end == text.npos ? "" : text.substr(bracketed ? end + 1 : end);
  const bool port = rest.empty() || (rest.size() > 1 && rest.size() <= 6 && rest.front() == ':' &&
                                     rest.find_first_not_of("0123456789", 1) == rest.npos);
  if (name.empty() || !port || (bracketed && end == text.npos)) return std::nullopt;
  return name;
}

bool is_number(const std::string& name) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return inet_pton(AF_INET, name.c_str(), bytes.data()) == 1 ||
         inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1;
}

}  // namespace

std::string random_token() {
  std::array<unsigned char, 32> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw std::system_error(errno, std::generic_category(), "the system gives no random numbers");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool equal_in_constant_time(std::string_view given, std::string_view expected) {
  std::size_t different = given.size() ^ expected.size();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const char c = given.empty() ? '\0' : given[i % given.size()];
    different |= static_cast<unsigned char>(c) ^ static_cast<unsigned char>(expected[i]);
  }
  return different == 0;
}

bool is_own_host(std::string_view host_header, const HostPolicy& policy) {
  const auto name = name_of(host_header);
  if (!name) return false;
  if (*name == "localhost" || *name == "127.0.0.1" || *name == "::1") return true;
  if (policy.anywhere && is_number(*name)) return true;
  return std::any_of(policy.names.begin(), policy.names.end(),
                     [&](const std::string& allowed) { return lower(allowed) == *name; });
}

bool is_own_origin(std::string_view origin, std::string_view host_header) {
  const std::string from = lower(origin), host = lower(host_header);
  return !host.empty() && (from == "http://" + host || from == "https://" + host);
}

}  // namespace sweepscope::ui
