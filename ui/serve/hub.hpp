#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ui/model/file_roots.hpp"
#include "ui/serve/crew.hpp"
#include "ui/serve/frame_coder.hpp"
#include "ui/serve/mailbox.hpp"
#include "ui/serve/rate_limit.hpp"
#include "ui/serve/uploads.hpp"

namespace sweepscope::ui {

/// The connection to a page. It sends in order.
class ViewerLink {
 public:
  virtual ~ViewerLink() = default;
  virtual void send_text(std::string text) = 0;
  virtual void send_frame(std::string bytes) = 0;
  /// Whether something is not handed to the network yet.
  virtual bool is_sending() const = 0;
  /// The page gets the reason. Hub::leave may come later.
  virtual void close(std::string_view why) = 0;
};

/// A picture of the explorer, on its way to the pages.
struct ServedPicture {
  SharedImage image;
  std::uint32_t input_number = 0, wait_us = 0, draw_us = 0;  // see Frame
  bool at_rest = false;
  std::chrono::steady_clock::time_point drawn_at{};
};

/// What the pages show beside the picture.
struct PageState {
  std::string title = "sweepscope", cursor = "default";  // CSS's name
  bool operator==(const PageState&) const = default;
};

/// A file that was written, offered under an address that cannot be guessed.
struct Download {
  std::string id;
  std::filesystem::path path;
};

/// The viewers of a session: who drives, what each page has, and what it may send. Used by the thread of the
/// network; the time is given.
class Hub {
 public:
  using Time = std::chrono::steady_clock::time_point;
  struct Options {
    std::size_t max_viewers = 8;
    bool once = false;  // over when the last viewer left
    FileRoots roots;    // of what is offered
  };
  Hub(Options options, Mailbox& mailbox)
      : options_(std::move(options)), mailbox_(mailbox), uploads_(options_.roots) {}

  /// The viewer's number; nothing if there are too many.
  std::optional<int> join(ViewerLink& link, Time now);
  /// `lost`: the connection broke, rather than that the page was left.
  void leave(int viewer, bool lost, Time now);
  /// A message of a page. One that is wrong, or one too many, closes the connection.
  void receive(int viewer, std::string_view text, Time now);

  void show(ServedPicture picture, Time now);
  void tell(PageState state);
  void copy(const std::string& text);
  void offer(const std::filesystem::path& file);
  /// The file of an address, if it still lies where files may be read.
  std::optional<std::filesystem::path> offered(std::string_view id) const;

  /// The file that a page may send to this address, once, if it is as long as it was announced.
  std::optional<Upload> begin_upload(std::string_view id, std::uint64_t size_bytes, Time now);
  /// Call it for everything that begin_upload returned. The explorer opens a file that came whole while its
  /// viewer drives; true if so.
  bool end_upload(const Upload& upload, bool whole);

  /// Sends what can be sent now, and closes what does not answer.
  void pump(Time now);
  /// When pump next has something to do; nothing while everything rests.
  std::optional<Time> next_wake(Time now);

  /// When the driver's next picture can be sent, in the past if at once; nothing as long as that depends on
  /// the page.
  std::optional<Time> sendable_at(Time now);

  std::size_t viewers() const { return viewers_.size(); }
  bool is_over(Time now) const { return over_at_ && now >= *over_at_; }

 private:
  struct Viewer {
    Viewer(ViewerLink& connection, Time now);
    int in_flight() const { return static_cast<int>(sent - shown); }

    ViewerLink* link;
    FrameCoder coder;
    RateLimit messages, bytes, pace;
    std::uint32_t sent = 0, shown = 0;  // frames, counted from 1
    Time waits_since;                   // for a frame to be shown
    std::optional<std::uint32_t> told_input;
    bool told_rest = false, told_exact = false, closing = false;
    std::string told_state;
    std::optional<SizeMessage> size;
  };
  void use(int id, Viewer& viewer, PageMessage message, Time now);
  void use_input(int id, Viewer& viewer, const InputMessage& input);
  void use_shown(Viewer& viewer, std::uint32_t frame, Time now);
  void use_upload(int id, Viewer& viewer, const UploadMessage& message, Time now);
  void use_control(int id, Control what, Time now);
  void release_held();
  void driver_changed(int before);
  void tell_state();
  void send_frame(Viewer& viewer, Time now);
  void close(Viewer& viewer, std::string_view why);
  std::string state_for(int viewer) const;

  Options options_;
  Mailbox& mailbox_;
  Crew crew_;
  std::map<int, Viewer> viewers_;
  int next_viewer_ = 1;
  ServedPicture picture_;
  PageState state_;
  std::vector<InputEvent> held_;  // what the driver holds down, as the releases
  std::uint32_t input_number_ = 0;
  std::vector<Download> downloads_;
  Uploads uploads_;
  std::optional<Time> over_at_;
};

}  // namespace sweepscope::ui
