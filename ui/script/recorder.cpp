#include "ui/script/recorder.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <system_error>

#include "ui/state/value.hpp"

namespace sweepscope::ui {
namespace {

std::string key_line(const InputEvent& event) {
  const Chord chord{event.key, event.modifiers};
  if (!event.down || parse_chord(to_text(chord)) != chord) return "";
  return "key " + to_text(chord);
}

std::string button_line(const InputEvent& event) {
  constexpr std::array kNames{"left", "right", "middle"};
  if (event.button < 0 || static_cast<std::size_t>(event.button) >= kNames.size()) return "";
  return fmt::format("mouse {} {}{}", event.down ? "down" : "up",
                     kNames[static_cast<std::size_t>(event.button)],
                     event.modifiers != 0 ? "  # with a key held" : "");
}

}  // namespace

std::string script_line(const InputEvent& event) {
  switch (event.what) {
    case InputEvent::What::kMove:
      return fmt::format("mouse move {} {}", event.x, event.y);
    case InputEvent::What::kButton:
      return button_line(event);
    case InputEvent::What::kWheel:
      return fmt::format("wheel {}", event.wheel);
    case InputEvent::What::kKey:
      return key_line(event);
    case InputEvent::What::kText:
      return "type " + quoted(event.text);
    case InputEvent::What::kDrop:
      break;
  }
  return "drop " + quoted(event.text);
}

Result<ScriptRecorder> ScriptRecorder::create(const std::filesystem::path& path) {
  ScriptRecorder recorder;
  recorder.name_ = path.string();
  recorder.file_.reset(std::fopen(path.c_str(), "w"));
  if (recorder.file_ == nullptr)
    return failure(ExitCode::kWrongUsage,
                   fmt::format("{}: {}", path.string(), std::generic_category().message(errno)));
  return recorder;
}

void ScriptRecorder::add_line(const std::string& line) {
  failed_ |= std::fprintf(file_.get(), "%s\n", line.c_str()) < 0;
  failed_ |= std::fflush(file_.get()) != 0;
}

void ScriptRecorder::add_events(std::span<const InputEvent> events) {
  for (const InputEvent& event : events)
    if (const std::string line = script_line(event); !line.empty()) add_line(line);
}

void ScriptRecorder::add_frame(std::span<const InputEvent> events, bool at_rest, bool began_work) {
  add_events(events);
  if ((was_busy_ || began_work) && at_rest) add_line("wait solved");
  was_busy_ = !at_rest;
}

Result<void> ScriptRecorder::end() {
  if (!failed_) return {};
  return failure(ExitCode::kWrongUsage, name_ + ": not all of the script could be written");
}

}  // namespace sweepscope::ui
