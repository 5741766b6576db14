#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>

#include "ui/serve/connection.hpp"

namespace sweepscope::ui {

/// Opens the WebSocket that this request asks for, and joins the hub with it until it ends.
void take_viewer(boost::beast::tcp_stream stream, OpenConnection context,
                 const boost::beast::http::request<boost::beast::http::empty_body>& request);

}  // namespace sweepscope::ui
