#include "ui/serve/upload_connection.hpp"

#include <boost/asio/post.hpp>
#include <boost/beast/http.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/io/atomic_file.hpp"
#include "ui/serve/http/response.hpp"

namespace sweepscope::ui {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using Clock = std::chrono::steady_clock;
using Header = http::request_parser<http::empty_body>;

constexpr std::size_t kPiece_bytes = std::size_t{256} * 1024;

/// Pieces go from the network to the disk one after the other: a slow disk slows the page down, and nothing
/// collects in memory.
class Receiver : public std::enable_shared_from_this<Receiver> {
 public:
  Receiver(beast::tcp_stream stream, OpenConnection context, beast::flat_buffer read, Header&& header,
           std::string_view host)
      : stream_(std::move(stream)),
        context_(std::move(context)),
        buffer_(std::move(read)),
        parser_(std::move(header)),
        host_(host) {}
  ~Receiver() {
    if (upload_) context_->hub.end_upload(*upload_, false);
  }

  void run(std::string_view id) {
    const auto size = parser_.content_length();
    if (size) upload_ = context_->hub.begin_upload(id, *size, Clock::now());
    if (!upload_) return answer(404, "This file was not announced.\n");
    auto file = AtomicFile::create(upload_->path);
    if (!file) return fail(file.error().message);
    file_.emplace(std::move(*file));
    if (*size == 0) return finish();
    read();
  }

 private:
  void read() {
    parser_.get().body().data = piece_.data();
    parser_.get().body().size = piece_.size();
    stream_.expires_after(context_->max_request);
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](beast::error_code failed, std::size_t) {
                       // A full piece counts as one. Whoever breaks off leaves nothing.
                       if (!failed || failed == http::error::need_buffer) self->write();
                     });
  }

  void write() {
    const std::size_t size = piece_.size() - parser_.get().body().size;
    on_disk(
        [this, size] {
          return file_->write({piece_.data(), size});
        },
        [this] { parser_.is_done() ? finish() : read(); });
  }

  void finish() {
    on_disk(
        [this]() -> Result<void> {
          std::error_code ignored;
          if (std::filesystem::exists(upload_->path, ignored))
            return failure(ExitCode::kWrongUsage, upload_->path.string() + ": already exists");
          return file_->commit();
        },
        [this] {
          const bool opened = context_->hub.end_upload(*std::exchange(upload_, std::nullopt), true);
          context_->after();
          answer(200, opened ? "opened\n" : "kept\n");
        });
  }

  template <typename Work, typename Next>
  void on_disk(Work work, Next next) {
    stream_.expires_never();
    asio::post(context_->disk, [self = shared_from_this(), work, next]() mutable {
      const auto executor = self->stream_.get_executor();
      asio::post(executor, [self = std::move(self), next, done = work()] {
        done ? next() : self->fail(done.error().message);
      });
    });
  }

  void fail(std::string why) {
    why_ = std::move(why) + "\n";
    file_.reset();  // before the page gets the answer
    answer(507, why_);
  }

  void answer(unsigned status, std::string_view text) {
    send_last(stream_, make_text_response(status, text), host_, shared_from_this());
  }

  beast::tcp_stream stream_;
  OpenConnection context_;
  beast::flat_buffer buffer_;
  http::request_parser<http::buffer_body> parser_;
  std::string host_, why_;
  std::optional<Upload> upload_;
  std::optional<AtomicFile> file_;
  std::vector<char> piece_ = std::vector<char>(kPiece_bytes);
};

}  // namespace

void take_upload(beast::tcp_stream stream, OpenConnection context, beast::flat_buffer read, Header&& header,
                 std::string_view id, std::string_view host) {
  std::make_shared<Receiver>(std::move(stream), std::move(context), std::move(read), std::move(header), host)
      ->run(id);
}

}  // namespace sweepscope::ui
