#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <string_view>

#include "ui/serve/connection.hpp"

namespace sweepscope::ui {

/// Writes the body of a request, whose header was read, into the file that was announced under `id`. The file
/// appears whole or not at all; a connection that brings nothing for a while ends. `host` is for the answer.
void take_upload(boost::beast::tcp_stream stream, OpenConnection context, boost::beast::flat_buffer read,
                 boost::beast::http::request_parser<boost::beast::http::empty_body>&& header,
                 std::string_view id, std::string_view host);

}  // namespace sweepscope::ui
