#include "ui/serve/http/answer.hpp"

#include <fmt/format.h>

#include "ui/serve/http/served_files.hpp"

namespace sweepscope::ui {
namespace {

Answer refusal(unsigned status, std::string_view why) {
  return {.status = status, .body = why};
}

/// Of a list such as "sweepscope.1, token.abc" the entry that begins like this, without the beginning.
std::string_view entry_of(std::string_view list, std::string_view beginning) {
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    std::string_view entry = list.substr(0, comma);
    list = comma == list.npos ? std::string_view() : list.substr(comma + 1);
    while (entry.starts_with(' ') || entry.starts_with('\t')) entry.remove_prefix(1);
    while (entry.ends_with(' ') || entry.ends_with('\t')) entry.remove_suffix(1);
    if (entry.starts_with(beginning)) return entry.substr(beginning.size());
  }
  return {};
}

constexpr std::string_view kWrongToken =
    "The token is wrong. Use the address that this start of the program printed.\n";

/// Whether the token holds, and what else is in the way of the page that asks.
Answer check(const Request& request, std::string_view token) {
  constexpr std::string_view kBearer = "Bearer ";
  const bool bearer = request.authorization.starts_with(kBearer);
  const std::string_view given = bearer ? request.authorization.substr(kBearer.size()) : std::string_view();
  if (!equal_in_constant_time(given, token)) return refusal(403, kWrongToken);
  if (!request.page_origin.empty() && !is_own_origin(request.page_origin, request.host))
    return refusal(409,
                   "A proxy between this page and the program changes the Host header. It must pass it on "
                   "unchanged, with the port: see docs/remote.md.\n");
  return {.status = 200, .body = "ok\n"};
}

Answer web_socket(const Request& request, std::string_view token) {
  if (!is_own_origin(request.origin, request.host))
    return refusal(403, "A page of another site may not connect.\n");
  if (!equal_in_constant_time(entry_of(request.protocols, "token."), token)) return refusal(403, kWrongToken);
  return {.kind = Answer::Kind::kWebSocket};
}

Answer download(std::string_view rest) {
  const std::string_view id = rest.substr(0, rest.find('/'));
  return {.kind = Answer::Kind::kDownload, .file_id = id};
}

/// The id alone lets in: it went through the WebSocket to who announced the file.
Answer upload(const Request& request, std::string_view id) {
  if (!is_own_origin(request.origin, request.host))
    return refusal(403, "A page of another site may not send files.\n");
  return {.kind = Answer::Kind::kUpload, .file_id = id};
}

}  // namespace

Answer answer_to(const Request& request, const HostPolicy& hosts, std::string_view token) {
  constexpr std::string_view kDownload = "/download/", kUpload = "/upload/";
  if (!is_own_host(request.host, hosts))
    return refusal(421, "This server is not reached by that name. See --host of sweepscope view.\n");
  const std::string_view path = request.target.substr(0, request.target.find('?'));
  if (request.method == "PUT" && path.starts_with(kUpload) && !request.upgrade)
    return upload(request, path.substr(kUpload.size()));
  if (request.method != "GET")
    return refusal(405, "Only GET is answered, and PUT for a file that was announced.\n");
  if (request.upgrade) return path == "/socket" ? web_socket(request, token) : refusal(404, "Not found.\n");
  if (path.starts_with(kDownload)) return download(path.substr(kDownload.size()));
  if (path == "/check") return check(request, token);
  if (const ServedFile* file = find_served_file(path)) return {.type = file->type, .body = file->text};
  return refusal(404, "Not found.\n");
}

std::string security_policy(std::string_view host) {
  // Not every browser takes a WebSocket of the same host for 'self'.
  return fmt::format(
      "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; "
      "connect-src 'self' ws://{0} wss://{0}; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
      host);
}

}  // namespace sweepscope::ui
