#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/http/span_body.hpp>
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "ui/serve/http/answer.hpp"

namespace sweepscope::ui {

/// Beast's views of texts as the library's.
inline std::string_view view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

using TextResponse = boost::beast::http::response<boost::beast::http::span_body<const char>>;

/// `body` must outlive it.
std::shared_ptr<TextResponse> make_text_response(unsigned status, std::string_view body,
                                                 std::string_view type = Answer{}.type);

/// The fields that every answer has: nothing is kept, framed, or guessed at. `host` is the request's Host
/// header, or localhost where that is not this server's.
void set_common_fields(boost::beast::http::fields& fields, std::string_view host);

/// Sends a response as the last thing of a connection, which `owner` keeps alive.
template <typename Response, typename Owner>
void send_last(boost::beast::tcp_stream& stream, const std::shared_ptr<Response>& response,
               std::string_view host, Owner owner) {
  constexpr std::chrono::minutes kMaxAnswer(30);  // of a large file over a slow link
  set_common_fields(response->base(), host);
  response->keep_alive(false);
  response->prepare_payload();
  stream.expires_after(kMaxAnswer);
  boost::beast::http::async_write(
      stream, *response,
      [&stream, owner = std::move(owner), response](boost::beast::error_code, std::size_t) {
        boost::beast::error_code ignored;
        (void)stream.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
      });
}

}  // namespace sweepscope::ui
