#include "ui/serve/hub.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "ui/serve/http/access.hpp"

namespace sweepscope::ui {
namespace {

using OrderedJson = nlohmann::ordered_json;

// A page sends at most one message of input to a picture of its screen, and one for each frame.
constexpr double kMessages_per_s = 400, kMessageBurst = 800;
constexpr double kBytes_per_s = 256 * 1024, kByteBurst = 512 * 1024;
// Frames that are not on the page's screen yet. With two, the next is on its way while one is shown.
constexpr int kMaxInFlight = 2;
// 14 Mbit/s, so that a link of 20 Mbit/s has room.
constexpr double kFrameBytes_per_s = 14e6 / 8, kFrameBurst_bytes = 64 * 1024;
constexpr std::chrono::seconds kMaxUnanswered(30);
constexpr std::chrono::seconds kLeft(3), kLost(60);  // a page that is loaded again, or that reconnects
constexpr std::size_t kMaxDownloads = 32;

bool is_release_of(const InputEvent& release, const InputEvent& event) {
  return release.what == event.what && release.button == event.button && release.key == event.key;
}

/// Limited to what a frame's header holds.
std::uint32_t microseconds(Hub::Time from, Hub::Time to) {
  const auto count = std::chrono::duration_cast<std::chrono::microseconds>(to - from).count();
  return static_cast<std::uint32_t>(std::clamp<decltype(count)>(count, 0, 0xFFFFFFFF));
}

std::string percent_encoded(const std::string& text) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (kPlain.find(c) != kPlain.npos)
      out += c;
    else
      out += {'%', kDigits[code >> 4], kDigits[code & 15]};
  }
  return out;
}

std::string to_text(const OrderedJson& json) {
  return json.dump(-1, ' ', false, OrderedJson::error_handler_t::replace);
}

}  // namespace

Hub::Viewer::Viewer(ViewerLink& connection, Time now)
    : link(&connection),
      messages(kMessages_per_s, kMessageBurst, now),
      bytes(kBytes_per_s, kByteBurst, now),
      pace(kFrameBytes_per_s, kFrameBurst_bytes, now),
      waits_since(now) {}

std::optional<int> Hub::join(ViewerLink& link, Time now) {
  if (viewers_.size() >= options_.max_viewers) return std::nullopt;
  const int id = next_viewer_++;
  viewers_.emplace(id, Viewer(link, now));
  over_at_.reset();
  crew_.join(id);
  for (const Download& download : downloads_) {
    const std::string name = download.path.filename().string();
    link.send_text(to_text({{"type", "download"},
                            {"name", name},
                            {"address", "/download/" + download.id + "/" + percent_encoded(name)}}));
  }
  tell_state();
  mailbox_.repaint();
  pump(now);
  return id;
}

void Hub::leave(int viewer, bool lost, Time now) {
  const int before = crew_.driver();
  viewers_.erase(viewer);
  crew_.leave(viewer);
  driver_changed(before);
  tell_state();
  if (viewers_.empty()) picture_ = {};  // an old one is not shown to who comes next
  if (viewers_.empty() && options_.once) over_at_ = now + (lost ? kLost : kLeft);
}

void Hub::receive(int viewer, std::string_view text, Time now) {
  const auto found = viewers_.find(viewer);
  if (found == viewers_.end() || found->second.closing) return;
  Viewer& from = found->second;
  if (!from.messages.take(1, now) || !from.bytes.take(static_cast<double>(text.size()), now))
    return close(from, "too many messages");
  auto message = parse_page_message(text);
  if (!message) return close(from, message.error().message);
  use(viewer, from, std::move(*message), now);
  pump(now);
}

void Hub::use(int id, Viewer& viewer, PageMessage message, Time now) {
  const bool drives = crew_.driver() == id;
  if (const auto* input = std::get_if<InputMessage>(&message)) use_input(id, viewer, *input);
  if (const auto* shown = std::get_if<ShownMessage>(&message)) use_shown(viewer, shown->frame, now);
  if (const auto* control = std::get_if<ControlMessage>(&message)) use_control(id, control->what, now);
  if (const auto* upload = std::get_if<UploadMessage>(&message)) use_upload(id, viewer, *upload, now);
  if (const auto* size = std::get_if<SizeMessage>(&message)) {
    viewer.size = *size;
    if (drives) mailbox_.resize(*size);
  }
  if (auto* paste = std::get_if<PasteMessage>(&message); paste != nullptr && drives)
    mailbox_.paste(std::move(paste->text));
  if (std::holds_alternative<BlurMessage>(message) && drives) release_held();
}

void Hub::use_input(int id, Viewer& viewer, const InputMessage& input) {
  if (crew_.driver() != id) return;
  for (const InputEvent& event : input.events) {
    if (event.what != InputEvent::What::kButton && event.what != InputEvent::What::kKey) continue;
    std::erase_if(held_, [&](const InputEvent& release) { return is_release_of(release, event); });
    if (!event.down) continue;
    held_.push_back(event);
    held_.back().down = false;
    held_.back().modifiers = 0;
  }
  input_number_ = input.number;
  if (!mailbox_.add(input)) close(viewer, "too much input");
}

void Hub::use_shown(Viewer& viewer, std::uint32_t frame, Time now) {
  if (frame <= viewer.shown || frame > viewer.sent) return;
  viewer.shown = frame;
  viewer.waits_since = now;
}

void Hub::use_control(int id, Control what, Time now) {
  const int before = crew_.driver();
  if (what == Control::kAsk) crew_.ask(id, now);
  if (what == Control::kGive) crew_.give(id);
  if (what == Control::kKeep) crew_.keep(id);
  driver_changed(before);
  tell_state();
}

void Hub::use_upload(int id, Viewer& viewer, const UploadMessage& message, Time now) {
  OrderedJson answer{{"type", "upload"}, {"name", message.name}};
  if (crew_.driver() != id) {
    answer["refused"] = "Only the viewer who drives can send a file.";
  } else if (const auto upload = uploads_.announce(id, message, now)) {
    answer["address"] = "/upload/" + *upload;
  } else {
    answer["refused"] = upload.error().message;
  }
  viewer.link->send_text(to_text(answer));
}

void Hub::release_held() {
  if (!held_.empty()) (void)mailbox_.add({input_number_, std::exchange(held_, {})});
}

void Hub::driver_changed(int before) {
  if (crew_.driver() == before) return;
  release_held();
  input_number_ = 0;
  const auto driver = viewers_.find(crew_.driver());
  if (driver != viewers_.end() && driver->second.size) mailbox_.resize(*driver->second.size);
}

std::string Hub::state_for(int viewer) const {
  return to_text({{"type", "state"},
                  {"viewer", viewer},
                  {"driver", crew_.driver()},
                  {"asking", crew_.asking()},
                  {"viewers", crew_.size()},
                  {"title", state_.title},
                  {"cursor", state_.cursor}});
}

void Hub::tell_state() {
  for (auto& [id, viewer] : viewers_) {
    std::string state = state_for(id);
    if (state == viewer.told_state) continue;
    viewer.told_state = state;
    viewer.link->send_text(std::move(state));
  }
}

void Hub::show(ServedPicture picture, Time now) {
  picture_ = std::move(picture);
  pump(now);
}

void Hub::tell(PageState state) {
  state_ = std::move(state);
  tell_state();
}

void Hub::copy(const std::string& text) {
  const auto driver = viewers_.find(crew_.driver());
  if (driver != viewers_.end()) driver->second.link->send_text(to_text({{"type", "copied"}, {"text", text}}));
}

void Hub::offer(const std::filesystem::path& file) {
  std::error_code failed;
  const auto path = std::filesystem::canonical(file, failed);
  if (failed || !options_.roots.can_read(path)) return;
  std::erase_if(downloads_, [&](const Download& download) { return download.path == path; });
  if (downloads_.size() >= kMaxDownloads) downloads_.erase(downloads_.begin());
  downloads_.push_back({random_token(), path});
  const std::string name = path.filename().string();
  for (auto& [id, viewer] : viewers_)
    viewer.link->send_text(
        to_text({{"type", "download"},
                 {"name", name},
                 {"address", "/download/" + downloads_.back().id + "/" + percent_encoded(name)}}));
}

std::optional<std::filesystem::path> Hub::offered(std::string_view id) const {
  std::optional<std::filesystem::path> found;
  for (const Download& download : downloads_)
    if (equal_in_constant_time(id, download.id)) found = download.path;
  return found && options_.roots.can_read(*found) ? found : std::nullopt;
}

std::optional<Upload> Hub::begin_upload(std::string_view id, std::uint64_t size_bytes, Time now) {
  auto upload = uploads_.begin(id, now);
  if (!upload || upload->size_bytes == size_bytes) return upload;
  uploads_.end(upload->id);
  return std::nullopt;
}

bool Hub::end_upload(const Upload& upload, bool whole) {
  uploads_.end(upload.id);
  if (!whole || crew_.driver() != upload.viewer) return false;
  return mailbox_.add({input_number_, {InputEvent::drop(upload.path.string())}});
}

void Hub::send_frame(Viewer& viewer, Time now) {
  if (!picture_.image || viewer.closing || viewer.in_flight() >= kMaxInFlight || viewer.link->is_sending() ||
      viewer.pace.free_at(now) > now)
    return;
  const Time begun = Time::clock::now();
  std::vector<FramePart> parts = viewer.coder.next(picture_.image, now);
  const std::uint32_t encode_us = microseconds(begun, Time::clock::now());
  const bool exact = viewer.coder.exact();
  const bool told = viewer.told_input == picture_.input_number && viewer.told_rest == picture_.at_rest &&
                    viewer.told_exact == exact;
  if (parts.empty() && told) return;
  if (viewer.in_flight() == 0) viewer.waits_since = now;
  std::string bytes = to_bytes({++viewer.sent, picture_.input_number, picture_.wait_us, picture_.draw_us,
                                microseconds(picture_.drawn_at, begun), encode_us, picture_.image->width_px,
                                picture_.image->height_px, exact, picture_.at_rest, std::move(parts)});
  viewer.told_input = picture_.input_number;
  viewer.told_rest = picture_.at_rest;
  viewer.told_exact = exact;
  viewer.pace.spend(static_cast<double>(bytes.size()), now);
  viewer.link->send_frame(std::move(bytes));
}

void Hub::pump(Time now) {
  const int before = crew_.driver();
  if (crew_.expire(now)) {
    driver_changed(before);
    tell_state();
  }
  for (auto& [id, viewer] : viewers_) {
    if (viewer.in_flight() > 0 && now - viewer.waits_since >= kMaxUnanswered)
      close(viewer, "the page does not show the pictures");
    send_frame(viewer, now);
  }
}

std::optional<Hub::Time> Hub::next_wake(Time now) {
  std::optional<Time> first = over_at_;
  const auto at = [&](std::optional<Time> time) {
    if (time && (!first || *time < *first)) first = time;
  };
  at(crew_.expires_at());
  for (auto& [id, viewer] : viewers_) {
    if (viewer.closing) continue;
    if (viewer.in_flight() > 0) at(viewer.waits_since + kMaxUnanswered);
    if (viewer.in_flight() >= kMaxInFlight || viewer.link->is_sending()) continue;
    const Time free = viewer.pace.free_at(now);
    if (free > now)
      at(free);
    else if (picture_.image)
      at(viewer.coder.rested_at());
  }
  return first;
}

std::optional<Hub::Time> Hub::sendable_at(Time now) {
  const auto driver = viewers_.find(crew_.driver());
  if (driver == viewers_.end() || driver->second.closing) return Time();
  Viewer& viewer = driver->second;
  if (viewer.in_flight() >= kMaxInFlight || viewer.link->is_sending()) return std::nullopt;
  const Time free = viewer.pace.free_at(now);
  return free > now ? free : Time();
}

void Hub::close(Viewer& viewer, std::string_view why) {
  if (viewer.closing) return;
  viewer.closing = true;
  viewer.link->close(why);
}

}  // namespace sweepscope::ui
