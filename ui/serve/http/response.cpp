#include "ui/serve/http/response.hpp"

namespace sweepscope::ui {

namespace http = boost::beast::http;

std::shared_ptr<TextResponse> make_text_response(unsigned status, std::string_view body,
                                                 std::string_view type) {
  auto response = std::make_shared<TextResponse>(http::int_to_status(status), 11);
  response->body() = {body.data(), body.size()};
  response->set(http::field::content_type, std::string(type));
  return response;
}

void set_common_fields(http::fields& fields, std::string_view host) {
  fields.set("Content-Security-Policy", security_policy(host));
  fields.set("X-Content-Type-Options", "nosniff");
  fields.set("X-Frame-Options", "DENY");
  fields.set("Referrer-Policy", "no-referrer");
  fields.set("Cross-Origin-Opener-Policy", "same-origin");
  fields.set("Cross-Origin-Resource-Policy", "same-origin");
  fields.set(http::field::cache_control, "no-store");
}

}  // namespace sweepscope::ui
