#include "ui/serve/connection.hpp"

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <limits>
#include <optional>
#include <utility>

#include "ui/serve/http/listen.hpp"
#include "ui/serve/http/response.hpp"
#include "ui/serve/upload_connection.hpp"
#include "ui/serve/viewer_connection.hpp"

namespace sweepscope::ui {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using Tcp = boost::asio::ip::tcp;

/// A request and its answer.
class Exchange : public std::enable_shared_from_this<Exchange> {
 public:
  Exchange(Tcp::socket socket, std::shared_ptr<ConnectionContext> context)
      : stream_(std::move(socket)), context_(std::move(context)) {}

  void run() {
    parser_.header_limit(kMaxHeader_bytes);
    // No body is read but that of an upload, which was announced with its size.
    parser_.body_limit(std::numeric_limits<std::uint64_t>::max());
    stream_.expires_after(context_->max_request);
    http::async_read_header(stream_, buffer_, parser_,
                            [self = shared_from_this()](beast::error_code failed, std::size_t) {
                              if (!failed) self->answer();
                            });
  }

 private:
  void answer() {
    const auto& request = parser_.get();
    const auto field = [&](http::field name) { return view(request[name]); };
    const bool upgrade = beast::websocket::is_upgrade(request);
    const std::string_view target = view(request.target());
    const Answer answer = answer_to(
        {view(request.method_string()), target, field(http::field::host), field(http::field::origin),
         field(http::field::sec_websocket_protocol), field(http::field::authorization), upgrade,
         view(request[beast::string_view(kPageOriginField.data(), kPageOriginField.size())])},
        context_->hosts, context_->token);
    switch (answer.kind) {
      case Answer::Kind::kWebSocket:
        return take_viewer(std::move(stream_), std::move(context_), parser_.release());
      case Answer::Kind::kUpload: {
        const std::string id(answer.file_id), host(field(http::field::host));
        return take_upload(std::move(stream_), std::move(context_), std::move(buffer_), std::move(parser_),
                           id, host);
      }
      case Answer::Kind::kDownload:
        return send_file(context_->hub.offered(answer.file_id));
      case Answer::Kind::kText:
        return send(make_text_response(answer.status, answer.body, answer.type));
    }
  }

  void send_file(const std::optional<std::filesystem::path>& path) {
    auto response = std::make_shared<http::response<http::file_body>>(http::status::ok, 11);
    beast::error_code failed;
    if (path) response->body().open(path->c_str(), beast::file_mode::scan, failed);
    if (!path || failed) return send(make_text_response(404, "This file no longer exists.\n"));
    response->set(http::field::content_type, "application/octet-stream");
    response->set(http::field::content_disposition, "attachment");  // the address ends with the name
    send(response);
  }

  template <typename Response>
  void send(const std::shared_ptr<Response>& response) {
    const std::string_view host = view(parser_.get()[http::field::host]);
    send_last(stream_, response, is_own_host(host, context_->hosts) ? host : "localhost", shared_from_this());
  }

  beast::tcp_stream stream_;
  OpenConnection context_;
  beast::flat_buffer buffer_;
  http::request_parser<http::empty_body> parser_;
};

}  // namespace

void take_connection(Tcp::socket socket, std::shared_ptr<ConnectionContext> context) {
  std::make_shared<Exchange>(std::move(socket), std::move(context))->run();
}

}  // namespace sweepscope::ui
