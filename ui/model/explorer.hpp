#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/offset/estimate.hpp"
#include "core/offset/estimate_options.hpp"
#include "ui/model/background.hpp"
#include "ui/model/file_roots.hpp"
#include "ui/model/growing_curve.hpp"
#include "ui/model/placed_cloud.hpp"
#include "ui/model/places.hpp"
#include "ui/model/reading_choices.hpp"
#include "ui/model/view_camera.hpp"
#include "ui/state/commands.hpp"
#include "ui/state/history.hpp"

namespace sweepscope::ui {

/// What a command answers that the state of the explorer does not allow.
inline tl::unexpected<Error> not_now(std::string why) {
  return failure(ExitCode::kWrongUsage, std::move(why));
}

enum class Side { kA, kB };
inline constexpr std::array kBothSides{Side::kA, Side::kB};

/// The state of the map of a pane.
enum class PaneState {
  kEmpty,        // no recording
  kProvisional,  // nothing solved yet: the first second, as if the rig were stationary
  kPreview,      // beams placed along the path that was solved for another offset
  kSolved,       // odometry and mapping at this offset
};

/// The points of a pane to place, their placement and their colours.
struct CloudRequest {
  Placement placement;
  CloudLook look;
  std::optional<Placement> other;  // for the difference: the placement that distances are measured from

  bool operator==(const CloudRequest&) const = default;
};

/// The content of a pane.
struct Pane {
  PaneState state = PaneState::kEmpty;
  std::optional<CloudRequest> request;
  PlacedCloudPtr coarse, full;  // full is null while it is being placed
  BeamValuesPtr slow;           // of a slow colouring; null for any other
  ColourBy slow_colouring = ColourBy::kElevation;
  std::optional<Placement> slow_placement;  // the placement whose values they are
  std::optional<MapThickness> thickness;    // of the map, with slow values that are its blur
  std::string problem;                      // why the map could not be solved
  bool lost = false;
  /// A close-up of the place that is looked at; null without one. Placed with what `request` asks for.
  PlacedCloudPtr close_up;
  PlacePtr close_up_place;
  std::optional<CloudRequest> close_up_request;
  BeamValuesPtr close_up_slow;
};

/// All points of a pane, and what came with them.
struct PlacedAll {
  PlacedCloudPtr full, coarse;  // coarse: where its colours had to wait for slow values, else null
  SlowValues slow;
};

struct Message {
  enum class Kind { kNote, kError };
  Kind kind = Kind::kNote;
  std::string text;
  double shown_s = 0;  // for how long already

  /// After this time it disappears.
  double lasts_s() const { return kind == Kind::kNote ? 8 : 30; }
};

/// A file's path from the root of the file system, for a person.
std::string whole_path(const std::filesystem::path& path);

/// The explorer without pixels: settings and their history, the recording, the maps, the estimate,
/// and the work in the background. Used by one thread.
class Explorer {
 public:
  struct Options {
    ReadingChoices reading;  // of every file that is opened, but for what is chosen on the page
    std::optional<RigKind> assume;
    std::vector<std::filesystem::path> input_files;  // read before anything is opened: rig file, scripts
    FileRoots roots;                                 // what is opened and written lies below
  };
  Explorer() : Explorer(Options()) {}
  explicit Explorer(Options options);

  const Settings& settings() const { return settings_; }
  /// Before anything is done: settings that undo does not go behind.
  void begin_with(const Settings& settings) { settings_ = settings; }
  const Loaded* loaded() const { return loaded_.get(); }
  /// Edge and plane points of the recording; null until they were requested and found.
  const FeatureSet* features() const { return loaded_ ? loaded_->prepared.features.get() : nullptr; }
  const Estimate* estimate() const { return estimate_ ? &*estimate_ : nullptr; }
  /// What the charts show: the candidates of an estimate while it is computed, or the estimate; null without
  /// either.
  const Estimate* charted() const;
  const Pane& pane(Side side) const { return panes_[static_cast<std::size_t>(side)]; }
  const std::optional<Message>& message() const { return message_; }
  bool is_loading() const { return background_.has("load"); }

  /// The page that is shown before a recording is opened: what can be chosen, and what is chosen.
  struct Choosing {
    ReadingChoices choices;
    std::optional<ReadingSurvey> survey;  // of these choices, or of the ones before while it is being made
    std::string problem;                  // why it could not be opened as it was asked for
  };
  const Choosing* choosing() const { return choosing_ ? &*choosing_ : nullptr; }
  bool is_surveying() const { return background_.has(kSurvey); }
  /// Leaves the page as if it had not been opened.
  void stop_choosing();
  bool can_undo() const { return history_.can_undo(); }
  bool can_redo() const { return history_.can_redo(); }
  Background& background() { return background_; }
  const Background& background() const { return background_; }
  /// Whether the recording is being played.
  bool is_playing() const { return playing_; }
  ColourSpan shown_span() const { return {look_.from, look_.to}; }

  /// Executes a command; opening and exporting continue in the background, and a failure gives a message.
  /// Commands of the window go to `at_window`. `gesture`: changes in a row with the same one are undone as
  /// one.
  Result<void> perform(const Call& call, const std::string& gesture = {});
  Result<void> perform(std::string_view line, const std::string& gesture = {});
  std::function<Result<void>(const Call&)> at_window;
  /// Called with each file that a command wrote.
  std::function<void(const std::filesystem::path&)> wrote;
  const FileRoots& roots() const { return options_.roots; }

  /// The shape of a map's picture. A view that nobody moved is fitted to it again.
  void set_picture_shape(const PictureShape& shape);

  /// Where the maps differ most, best first; empty until both are solved, and where they do not differ.
  const std::vector<PlacePtr>& places() const { return places_; }
  /// The one that the close-ups show; null without one.
  PlacePtr place() const;

  /// The offsets that map A and map B can have. With a recording: as far as a search may go about 0, about
  /// the candidates that are set, and about the offset that was found.
  std::pair<double, double> offset_window_ms() const;
  /// The map whose offset was changed last.
  Side changed_side() const { return changed_side_; }
  /// What the command "copy" copies, and in what words.
  struct Copied {
    std::string text, what;
  };
  Copied what_to_copy() const;

  /// While a handle is held, offsets are previewed and nothing is solved.
  void hold_handle(bool held) { handle_held_ = held; }

  /// What a line would write over, as a whole path; empty if nothing, or if it is the session that is open.
  std::string replaced_by(std::string_view line) const;
  /// Checks that none of these files is one that was opened (see check_run_files).
  Result<void> check_outputs(std::vector<std::filesystem::path> outputs) const;

  /// Writes a file in the background; a message reports when it is written.
  struct Export {
    std::string title, done;
    std::filesystem::path file;
    std::function<Result<void>(const Job&)> write;
    std::vector<TaskStep> steps = {};
  };
  void start_export(Export wanted);
  bool is_exporting() const { return background_.has(kExport); }
  /// Why the last recording could not be opened; empty if it was opened or is still being opened.
  const std::optional<Error>& load_failure() const { return load_failure_; }
  /// The error of the last export; returned once.
  std::optional<Error> take_export_failure() { return std::exchange(export_failure_, std::nullopt); }

  /// Once per frame: takes finished results, and starts the work that the settings require.
  void update(double seconds_since_last);
  /// Whether a pane waits for its settings to rest before all its points are placed.
  bool waits_to_place() const;
  /// Whether all points of both maps are placed.
  bool has_all_points() const { return panes_[0].full && panes_[1].full; }
  /// Whether nothing is running and every pane shows everything that its settings require.
  bool at_rest() const;
  void dismiss_message() { message_.reset(); }
  /// While it is held, because the mouse is on it, a message stays.
  void hold_message(bool held) { message_held_ = held; }
  void say(Message::Kind kind, std::string text) { message_ = Message{kind, std::move(text), 0}; }

  /// The status line: what is shown, in words.
  std::string status() const;
  /// A number or word of the current state, for scripts: see observables().
  std::optional<std::string> observe(std::string_view name) const;
  static std::vector<std::pair<std::string, std::string>> observables();

  std::string session_json() const;
  /// A name for the file that a command such as "save-session" writes, in the working folder; empty for
  /// "open". `what`: of an export of one map, "a" or "b".
  std::string suggested_file(const std::string& command, const std::string& what) const;
  /// The shell command that makes the current picture at this size.
  std::string command_line(int width_px, int height_px) const;

 private:
  Result<void> act(const Call& call);
  Result<void> check_offsets(const Settings& next) const;
  Result<void> check_outputs_of(const Call& call) const;
  Result<void> play(const Call& call);
  void update_playback(double seconds_since_last);
  Result<void> choose(const Call& call);
  Result<void> start_choosing(const std::string& file);
  Result<void> open_chosen();
  void start_survey();
  void take(ReadingSurvey survey);
  std::optional<std::string> observe_choices(std::string_view name) const;
  Result<void> check_roots(const Call& call) const;
  Result<void> check_recording_roots(const ReadingChoices& choices) const;
  void tell_written(const std::filesystem::path& file) const;
  void open(const std::string& path, const std::string& poses);
  Result<void> open_json(const std::string& path);
  Result<void> open_session(const std::string& text, const std::string& path);
  Result<void> open_estimate(const std::string& text, const std::string& path);
  void load(const ReadingChoices& choices);
  /// `file`: what is read, for the page that is shown if it needs choosing; null for a sample.
  void start_loading(const std::string& title, std::vector<TaskStep> steps,
                     std::function<Result<LoadedPtr>(const Job&)> load,
                     const std::optional<ReadingChoices>& file = std::nullopt);
  void give_up_loading(const Error& why);
  void take(LoadedPtr loaded, SolvedMapPtr first_map);
  void close();
  void cancel();
  void solve();
  Result<void> take_found();
  EstimateOptions wanted_estimate() const;
  Result<void> start_estimate();
  void take(Estimate estimate);
  Result<void> save_session(const std::string& path);
  Result<void> export_cloud(Side side, const std::string& path);
  Result<void> export_curve(const std::string& path);
  Result<void> export_rig(const std::string& path);
  Result<void> use_rig(const std::string& path);
  Result<void> export_report(const std::string& folder);
  void change_settings(Settings next, const std::string& gesture);
  Settings with_fitted_view() const;
  void fit_view();

  static constexpr const char *kExport = "export", *kSurvey = "survey";
  static bool stands(const Loaded& loaded, const std::optional<RigKind>& assume);
  bool without_solving() const;
  double offset_s(Side side) const;
  SolvedMapPtr solved_at(double offset_s) const;
  SolvedMapPtr nearest_solved(double offset_s) const;
  Pane& pane_of(Side side) { return panes_[static_cast<std::size_t>(side)]; }
  Placement placement_of(Side side) const;
  CloudLook wanted_look(const SolvedMap* a, const SolvedMap* b);
  void update_panes(double seconds_since_last);
  void update_places();
  void update_growing_curve();
  void start_places(const Placement& a, const Placement& b);
  void take(std::vector<PlacePtr> places);
  void place_close_up(Side side);
  Result<void> next_place(bool back);
  Result<void> look_at_place();
  void refit_view();
  void show(Side side, CloudRequest request);
  void start_full();
  void take(std::span<const Side> sides, std::span<const CloudRequest> requests,
            std::span<const PlacedAll> placed);
  void update_solving();
  void keep_solved(std::int64_t offset_ns, Result<SolvedMapPtr> solved);

  Options options_;
  Settings settings_;
  History history_;
  LoadedPtr loaded_;
  std::optional<Estimate> estimate_;
  std::shared_ptr<GrowingCurve> growing_;
  std::optional<Estimate> so_far_;  // of what grows; empty before its second candidate
  std::optional<Message> message_;
  std::map<std::int64_t, SolvedMapPtr> solved_;  // by the offset in nanoseconds
  std::map<std::int64_t, std::string> unsolvable_;
  std::set<std::int64_t> cancelled_;        // by a person: not restarted automatically
  std::vector<std::int64_t> solved_order_;  // oldest first
  SolvedMapPtr provisional_;
  CloudLook look_;
  ColourSpan span_;  // of the colouring, for the two maps below
  ColourBy span_colouring_ = ColourBy::kElevation;
  std::array<const SolvedMap*, 2> span_maps_{nullptr, nullptr};
  std::array<Pane, 2> panes_;
  double rest_s_ = 0;    // since the coarse points of a pane changed
  std::string placing_;  // key of the job that places all points
  std::size_t placings_ = 0;
  bool handle_held_ = false, message_held_ = false, playing_ = false;
  Side changed_side_ = Side::kB;  // whose offset was changed last
  bool b_was_set_ = false;        // by a person, since the recording was opened
  bool view_moved_ = false;       // by a person: no longer fitted when the pane changes its shape
  PictureShape picture_shape_;
  std::vector<PlacePtr> places_;
  std::optional<std::pair<Placement, Placement>> places_of_;  // the maps that they are of
  bool fitted_beside_ = false;                                // whether the view leaves room for close-ups
  std::optional<Error> export_failure_, load_failure_;
  std::optional<Choosing> choosing_;
  std::vector<std::filesystem::path> input_files_;  // that were opened, or named before
  std::filesystem::path session_file_;              // opened or saved last: saving it again is no harm
  std::optional<Settings> session_settings_;        // to apply once the recording is open
  std::optional<Estimate> session_estimate_;
  Background background_;  // last member: its threads end before the data that they use
};

/// Why it cannot be opened with the choices at hand, as far as it is known: sentences. A missing laser or
/// motor goes before anything that follows from it.
std::vector<std::string> problems_of(const Explorer::Choosing& choosing);

}  // namespace sweepscope::ui
