#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ui/serve/http/access.hpp"

namespace sweepscope::ui {

/// A request, as far as it decides what is answered.
struct Request {
  std::string_view method, target, host, origin, protocols, authorization;
  bool upgrade = false;               // to a WebSocket
  std::string_view page_origin = {};  // what the page says of itself, in kPageOriginField
};

/// What a request gets.
struct Answer {
  enum class Kind { kText, kDownload, kUpload, kWebSocket };
  Kind kind = Kind::kText;
  unsigned status = 200;
  std::string_view type = "text/plain; charset=utf-8";
  std::string_view body = {};
  std::string_view file_id = {};  // of a download or an upload
};

/// The WebSocket's subprotocol. A page offers it together with "token." and the token.
inline constexpr std::string_view kSubprotocol = "sweepscope.1";

/// A page that could not connect asks why with this field.
inline constexpr std::string_view kPageOriginField = "X-Page-Origin";

/// Decides by method, Host, Origin, token and path. Refusals say in a sentence why.
Answer answer_to(const Request& request, const HostPolicy& hosts, std::string_view token);

/// The page's Content-Security-Policy: its own files alone, and its WebSocket under this Host header, which
/// answer_to accepted.
std::string security_policy(std::string_view host);

}  // namespace sweepscope::ui
