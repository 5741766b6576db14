#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ui/explorer/choices_page.hpp"
#include "ui/explorer/exports.hpp"
#include "ui/explorer/file_guard.hpp"
#include "ui/explorer/fitted_view.hpp"
#include "ui/explorer/kept_answers.hpp"
#include "ui/explorer/map_pair.hpp"
#include "ui/explorer/messages.hpp"
#include "ui/explorer/open_recording.hpp"
#include "ui/explorer/place_list.hpp"
#include "ui/explorer/rig_recordings.hpp"
#include "ui/explorer/running_estimate.hpp"
#include "ui/state/history.hpp"

namespace sweepscope::ui {

/// What a command answers that the state of the explorer does not allow.
inline tl::unexpected<Error> not_now(std::string why) {
  return failure(ExitCode::kWrongUsage, std::move(why));
}

/// The explorer without pixels: the settings and their history, and the parts below, which it connects. Used
/// by one thread.
class Explorer {
 public:
  struct Options {
    ReadingChoices reading;  // of every file that is opened, but for what is chosen on the page
    std::optional<RigKind> assume;
    std::vector<std::filesystem::path> input_files;  // read before anything is opened: rig file, scripts
    FileRoots roots;                                 // what is opened and written lies below
    bool estimates_on_opening = false;               // unless the settings forbid it
  };
  Explorer() : Explorer(Options()) {}
  explicit Explorer(Options options);

  const Options& options() const { return options_; }
  const Settings& settings() const { return settings_; }
  /// Before anything is done: settings that undo does not go behind.
  void begin_with(const Settings& settings) { settings_ = settings; }

  /// Carries out a command; opening and exporting continue in the background, and a failure there gives a
  /// message. `gesture`: changes in a row with the same one are undone as one.
  Result<void> perform(const Call& call, const std::string& gesture = {});
  /// See parse_call.
  Result<void> perform(std::string_view line, const std::string& gesture = {});
  /// Carries out the commands of windows; null without one.
  Window* window = nullptr;

  // The handlers of commands.
  void change(Settings next, const std::string& gesture = {});
  const History& history() const { return history_; }
  void undo() { settings_ = history_.undo(settings_); }
  void redo() { settings_ = history_.redo(settings_); }
  /// In place of the recording that is open, once it is read.
  void load(ReadingChoices choices, std::optional<Restored> restored = {});
  void load_sample(const std::string& scene, double seconds, std::optional<Restored> restored = {});
  void close();
  void cancel();
  Result<void> fit_view();
  Result<void> play(bool on);
  void use_found_offset();
  /// As it is set and shown everywhere, to 0.01 ms; empty without one.
  std::optional<double> found_offset_ms() const;
  /// The thickness of walls at 0 and at the offset found, once both are measured: a sentence; else empty.
  std::string walls_in_words() const;

  /// Null without a recording.
  const Loaded* loaded() const { return recording.loaded().get(); }
  const Pane& pane(Side side) const { return maps.pane(side); }
  /// The place that the close-ups show; null without one.
  PlacePtr place() const { return settings_.close_up ? places.at(settings_.place) : nullptr; }
  /// Whether the places listed are those of the maps that are shown.
  bool places_hold() const { return maps.is_complete() && !background.has("places"); }
  /// Whether what opening began is not all there yet: the estimate, both maps, places and walls. Not while a
  /// handle is held, since nothing is solved then.
  bool is_answering() const { return answering_ && !maps.is_held(); }
  /// Whether the recording is being played.
  bool is_playing() const { return playing_; }
  /// The offsets that map A and map B can have. With a recording: as far as a search may go about 0, about
  /// the candidates that are set, and about the offset that was found.
  std::pair<double, double> offset_window_ms() const;
  /// The map whose offset was changed last.
  Side changed_side() const { return changed_side_; }

  /// The shape of a map's picture. A view that nobody moved is fitted to it again.
  void set_picture_shape(const PictureShape& shape);
  /// Once per frame: takes finished results, and starts the work that the settings require.
  void update(double seconds_since_last);
  /// Whether nothing is running and every pane shows everything that its settings require.
  bool at_rest() const { return !background.busy() && (loaded() == nullptr || maps.at_rest()); }

 private:
  Result<void> set(const Call& call, const std::string& gesture);
  Result<void> check_offsets(const Settings& next) const;
  void take(const Opened& opened);
  void take(std::vector<PlacePtr> found);
  void end_recording();
  void restore(const Restored& restored);
  void begin_anew();
  void answer();
  void update_places();
  void update_walls();
  bool shows_answer() const;
  void update_playback(double seconds_since_last);
  Settings with_fitted_view();
  void use_first_view();
  void use_answered_part();
  void refit_view();

  Options options_;
  Settings settings_;
  History history_;
  bool playing_ = false;
  Side changed_side_ = Side::kB;
  std::set<std::string> set_since_opening_;  // the fields that a person set since it was asked for
  bool colouring_was_chosen_ = false;        // by a person, at any time
  bool view_was_chosen_ = false;             // its direction or heights: the same
  bool answering_ = false;                   // see is_answering
  bool first_colouring_ = false;             // it is still to be chosen for the recording's first picture
  struct Walls {
    double offset_s = 0;
    MapThickness before, after;
    bool broken = false;  // a map does not agree with itself
  };
  std::optional<Walls> walls_;
  bool fitted_beside_ = false;  // whether the view leaves room for close-ups

 public:
  Messages messages;
  FittedView view;
  FileGuard files;
  OpenRecording recording;
  ChoicesPage page;
  RunningEstimate estimating;
  RigRecordings rig;
  MapPair maps;
  PlaceList places;
  KeptAnswers answers;
  Exports exports;
  Background background;  // last member: its threads end before the data that they use
};

}  // namespace sweepscope::ui
