#include "ui/ui.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <malloc.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>

#include "render/gl/default_framebuffer.hpp"
#include "ui/asked_pictures.hpp"
#include "ui/commands/commands.hpp"
#include "ui/explorer/observables.hpp"
#include "ui/host/imgui_host.hpp"
#include "ui/host/input_queue.hpp"
#include "ui/panes/fronts/figure_preview.hpp"
#include "ui/panes/fronts/file_dialog.hpp"
#include "ui/panes/number_box.hpp"
#include "ui/panes/pane_context.hpp"
#include "ui/preferences.hpp"
#include "ui/recent.hpp"

namespace sweepscope::ui {

namespace {

/// Whether a tool left something on the maps.
bool marked(const Settings& s) {
  return s.asked_scan >= 0 || s.measure_from_m != s.measure_to_m || s.profile_from_m != s.profile_to_m;
}

/// A key that was pressed, or a "?", which is on another key of every keyboard.
std::optional<Chord> chord_of_event(const InputEvent& event) {
  if (event.what == InputEvent::What::kText && event.text == "?") return Chord{'?', 0};
  if (event.what == InputEvent::What::kKey && event.down) return Chord{event.key, event.modifiers};
  return std::nullopt;
}

}  // namespace

struct Ui::Parts final : Window {
  Parts(gl::Context& gl_context, Options with)
      : options(std::move(with)),
        context(gl_context),
        explorer(options.explorer),
        host(gl_context),
        view_a(gl_context),
        view_b(gl_context),
        close_up_a(gl_context),
        close_up_b(gl_context),
        preview(gl_context) {
    transient.recent = read_recent(options.recent_list);
    Settings look = read_preferences(options.preferences).look;
    kept_ui_scale = look.ui_scale;
    if (options.scale_given) look.ui_scale = 0;
    explorer.begin_with(look);
    explorer.window = this;
  }

  ~Parts() override {
    Settings look = look_of(explorer.settings());
    if (options.scale_given && look.ui_scale == 0) look.ui_scale = kept_ui_scale;  // it was of this run alone
    write_preferences(options.preferences, {look, context.width_px(), context.height_px()});
  }

  double scale() const {
    const double wanted = explorer.settings().ui_scale;
    return wanted > 0 ? wanted : options.display_scale;
  }
  const Style& style() const { return style_of(explorer.settings().theme); }
  bool something_in_front() const {
    return transient.palette || transient.help || transient.asks_for.has_value();
  }

  /// A menu, or a list of choices.
  static bool menu_is_open() {
    return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  }

  void quit() override;
  void toggle_palette() override { show_alone(&Transient::palette); }
  void toggle_keys() override { show_alone(&Transient::help); }
  void ask(const std::string& command, const std::string& what) override;
  void dismiss() override;
  void open_menu(const std::string& name) override { transient.opens_menu = name; }
  void type_into_next_field(bool back) override { type_into_next_box(transient, back ? -1 : 1); }
  void copy(const std::string& text) override { host.clipboard = text; }
  std::string command_line() const override {
    return ui::command_line(explorer, context.width_px(), context.height_px());
  }
  Result<void> export_picture(const std::string& file, const std::string& what,
                              const std::string& size) override {
    return pictures.ask(file, what, size);
  }
  Result<void> export_figure(const std::string& file, const std::string& size,
                             const std::string& parts) override {
    return pictures.ask_figure(file, size, parts);
  }

  void clear_front();
  void show_alone(bool Transient::*front);
  std::string first_text(const Transient::Asked& asked);
  void perform(const std::string& line, const std::string& gesture);
  bool is_command_now(const Chord& chord) const;
  bool use_start_page(const Chord& chord);
  void use_keys(std::span<const InputEvent> events);
  void use_drops(std::span<const InputEvent> events);
  void frame(std::span<const InputEvent> all_events, double seconds_since_last);
  void paint();
  Image screenshot();
  void draw(const PaneContext& panes);
  void let_go();
  PictureShape picture_shape() const;
  void remember_opened();
  bool shows_all_points() const;
  bool is_exporting() const { return pictures.waits() || explorer.exports.is_running(); }
  bool maps_are_shown() const { return explorer.loaded() != nullptr && explorer.page.choosing() == nullptr; }
  double kept_ui_scale = 0;  // of the preferences
  tbb::task_arena alone{1};
  Options options;
  gl::Context& context;
  Explorer explorer;
  ImGuiHost host;
  InputQueue input;
  LiveView view_a, view_b, close_up_a, close_up_b;
  FigurePreview preview;
  bool holds_recording = false;  // or what is left of one that was closed
  Transient transient;
  std::map<std::string, PixelRect> anchors;
  std::string remembered;  // the source that the recent list knows already
  PixelRect maps_place;    // as drawn last
  AskedPictures pictures{explorer};
};

/// For what comes in front in place of it.
void Ui::Parts::clear_front() {
  transient.palette = transient.help = false;
  transient.asks_for.reset();
  transient.replaces.clear();
  transient.palette_query.clear();
  transient.palette_choice = 0;
  transient.browsing = {};
  transient.asked_text.clear();
  transient.just_opened = true;
}

void Ui::Parts::show_alone(bool Transient::*front) {
  const bool was = transient.*front;
  clear_front();
  transient.*front = !was;
}

void Ui::Parts::ask(const std::string& command, const std::string& what) {
  clear_front();
  transient.asks_for = Transient::Asked{command, what};
  transient.asked_text = first_text(*transient.asks_for);
}

/// What stands in the field of a dialog at first.
std::string Ui::Parts::first_text(const Transient::Asked& asked) {
  if (asked.command == "open" || asked.command == "choose") return first_path(transient.recent);
  if (!is_opening(asked.command)) return suggested_file(explorer, asked.command, asked.what);
  transient.browsing.all = true;
  return explorer.page.choosing() != nullptr ? first_path({explorer.page.choosing()->choices.file}) : "";
}

void Ui::Parts::dismiss() {
  if (something_in_front()) {
    transient.palette = transient.help = false;
    transient.asks_for.reset();
  } else if (explorer.messages.shown()) {
    explorer.messages.dismiss();
  } else if (explorer.page.choosing() != nullptr) {
    explorer.page.leave();
  } else if (explorer.settings().sheet != Sheet::kNone) {
    (void)explorer.perform("open-panel none");
  } else if (explorer.settings().tool != Tool::kLook || marked(explorer.settings())) {
    transient.measure_from_m.reset();
    const std::string gesture = "dismiss " + std::to_string(++transient.gestures);
    for (const char* line : {"tool look", "pick -1 -1", "measure 0 0 0 0 0 0", "profile 0 0 0 0"})
      (void)explorer.perform(line, gesture);
  } else if (explorer.settings().scan_view) {
    (void)explorer.perform("scan-view off");
  }
}

/// Whether a chord is a command now, rather than part of what is typed, or of what a menu does with it.
bool Ui::Parts::is_command_now(const Chord& chord) const {
  const bool ctrl = (chord.modifiers & kCtrl) != 0, escape = chord.key == keys::kEscape;
  if (ImGui::GetIO().WantTextInput || transient.typing) {
    const bool tab = chord.key == keys::kTab && transient.typing;
    return escape || tab || (ctrl && (chord.key == 'P' || chord.key == 'Q'));
  }
  if (menu_is_open()) return ctrl;
  // On the page of choices, arrows and Space go through its widgets, and letters mean maps that are not seen.
  if (explorer.page.choosing() != nullptr && !ctrl)
    return escape || chord.key == keys::kF1 || chord.key == keys::kF10;
  const bool keys_again = transient.help && (chord.key == 'H' || chord.key == '?');  // they go as they came
  return ctrl || escape || chord.key == keys::kF1 || keys_again || !something_in_front();
}

/// The start page by keyboard: arrows and Tab choose, Enter does it. Whether the key was its own.
bool Ui::Parts::use_start_page(const Chord& chord) {
  const auto count = static_cast<int>(transient.start_lines.size());
  if (explorer.loaded() != nullptr || explorer.recording.is_opening() ||
      explorer.page.choosing() != nullptr || something_in_front() || menu_is_open() || count == 0)
    return false;
  const bool tab = chord.key == keys::kTab, back = tab && (chord.modifiers & kShift) != 0;
  int& choice = transient.start_choice;
  if (chord.key == keys::kDown || (tab && !back))
    choice = (choice + 1) % count;
  else if (chord.key == keys::kUp || back)
    choice = (std::max(choice, 0) + count - 1) % count;
  else if (chord.key == keys::kEnter && choice >= 0)
    perform(transient.start_lines[static_cast<std::size_t>(choice)], {});
  else
    return false;
  return true;
}

void Ui::Parts::perform(const std::string& line, const std::string& gesture) {
  explorer.messages.show_failure(explorer.perform(line, gesture));
}

void Ui::Parts::use_keys(std::span<const InputEvent> events) {
  for (const InputEvent& event : events) {
    const auto chord = chord_of_event(event);
    if (!chord || !is_command_now(*chord) || use_start_page(*chord)) continue;
    if (transient.typing && chord->key == keys::kEscape) {
      transient.typing.reset();  // the number stays as it was, and nothing else is closed
      continue;
    }
    for (const Shortcut& shortcut : shortcuts()) {
      if (parse_chord(shortcut.chord) == chord) perform(shortcut.line, "key " + shortcut.line);
    }
  }
}

void Ui::Parts::use_drops(std::span<const InputEvent> events) {
  for (const InputEvent& event : events) {
    if (event.what != InputEvent::What::kDrop) continue;
    transient.asks_for.reset();
    perform("open " + ui::quoted(event.text), {});
  }
}

void Ui::Parts::draw(const PaneContext& panes) {
  const double width = context.width_px(), height = context.height_px();
  const bool choosing = explorer.page.choosing() != nullptr;
  const bool open = explorer.loaded() != nullptr && !choosing;
  const double message_px = message_height(panes, width);
  const Places places = lay_out(width, height, panes.scale, explorer.settings(), open, message_px);
  const PixelRect whole{0, 0, width, height};
  maps_place = places.maps;
  if (explorer.loaded() != nullptr) holds_recording = true;
  if (choosing) {
    draw_choices_page(panes, places.maps);
  } else if (open) {
    const Sheet sheet = places.sheet.width > 0 ? explorer.settings().sheet : Sheet::kNone;
    draw_recording_panel(panes, sheet == Sheet::kRecording ? places.sheet : places.left,
                         sheet != Sheet::kNone);
    draw_maps(panes, places.maps);
    draw_criteria(panes, places.criteria);
    draw_display_panel(panes, sheet == Sheet::kDisplay ? places.sheet : places.right, sheet != Sheet::kNone);
    draw_cards(panes, places.maps);
    draw_playback(panes, places.playback);
    draw_tabs(panes, places.tabs);
    if (!something_in_front() && places.sheet.width == 0) draw_splitters(panes, places, whole);
  } else if (explorer.recording.is_opening()) {
    draw_loading_page(panes, places.maps);
  } else {
    draw_start_page(panes, places.maps);
  }
  transient.on_choices_page = choosing;
  explorer.messages.hold(false);
  draw_message(panes, places.message);
  draw_status_bar(panes, places.status);
  draw_menu_bar(panes, places.menu);
  const bool opened = transient.just_opened;
  draw_palette(panes, whole);
  draw_help(panes, whole);
  draw_ask(panes, whole);
  if (opened) transient.just_opened = false;
  if (!ImGui::IsMouseDown(0)) transient.handle.reset();
  // A field that is typed into is active too, and changes nothing until it is left.
  const bool dragged = ImGui::IsAnyItemActive() && !ImGui::GetIO().WantTextInput;
  explorer.maps.hold(transient.handle.has_value() || dragged);
}

/// Once what still worked on a closed recording has ended, its memory goes back to the system, small pieces
/// too.
void Ui::Parts::let_go() {
  if (explorer.loaded() != nullptr || !holds_recording || !explorer.background.status().empty()) return;
  for (LiveView* view : {&view_a, &view_b, &close_up_a, &close_up_b}) view->show(nullptr, nullptr);
  transient.profiles = {};
  preview.forget();
  malloc_trim(0);
  holds_recording = false;
}

/// Of a map's picture, once a recording is open.
PictureShape Ui::Parts::picture_shape() const {
  const Settings& settings = explorer.settings();
  const PixelRect maps = lay_out(context.width_px(), context.height_px(), scale(), settings, true, 0).maps;
  const Layout layout = shown_layout(settings.layout, maps, scale());
  const MapPlaces places = lay_out_maps(maps, scale(), layout, settings.map_share);
  const PixelRect& picture = places.picture_b.width > 0 ? places.picture_b : places.picture_a;
  PictureShape shape{picture.width / std::max(picture.height, 1.0), 0, 0};
  const auto close_ups = close_up_places(picture, scale(), settings.layout, explorer.view.spare_height());
  if (close_ups.empty()) return shape;
  shape.covered_width = (picture.right() - close_ups.front().left) / picture.width;
  shape.covered_height = (picture.bottom() - close_ups.front().top) / picture.height;
  return shape;
}

void Ui::Parts::remember_opened() {
  const Loaded* loaded = explorer.loaded();
  if (loaded == nullptr || loaded->source == remembered) return;
  remembered = loaded->source;
  const auto call = parse_call(remembered);
  if (call && call->command->name == "open")
    transient.recent = remember_recent(options.recent_list, transient.recent, call->text(0));
}

Ui::Ui(gl::Context& context, Options options)
    : parts_(std::make_unique<Parts>(context, std::move(options))) {}
Ui::~Ui() = default;

Explorer& Ui::explorer() {
  return parts_->explorer;
}

const Explorer& Ui::explorer() const {
  return parts_->explorer;
}

void Ui::frame(std::span<const InputEvent> events, double seconds_since_last) {
  // By this thread alone: shared with threads that come after it, a part of the frame would wait for them.
  parts_->alone.execute([&] { parts_->frame(events, seconds_since_last); });
}

void Ui::Parts::frame(std::span<const InputEvent> all_events, double seconds_since_last) {
  host.use(explorer.settings().theme, scale());
  input.add(all_events);
  const std::vector<InputEvent> events = input.take(!ImGui::GetIO().WantTextInput);
  use_keys(events);
  use_drops(events);
  transient.camera_moved_s += seconds_since_last;
  explorer.set_picture_shape(picture_shape());
  explorer.update(seconds_since_last);
  explorer.set_picture_shape(picture_shape());  // close-ups that come take what the view spares at once
  remember_opened();
  let_go();
  // The keyboard is ImGui's in its menus and on the page of choices: elsewhere arrows move the view.
  host.enter_chooses = menu_is_open();
  host.navigate_by_keys(menu_is_open() || (explorer.page.choosing() != nullptr && !something_in_front()));
  host.begin_frame(events, seconds_since_last);
  anchors.clear();
  begin_number_boxes(transient);
  transient.pane_aspect = picture_shape().aspect;
  transient.for_picture = pictures.waits_for_maps();
  const PaneContext panes{explorer,
                          transient,
                          host.fonts(),
                          style(),
                          scale(),
                          {&view_a, &view_b},
                          {&close_up_a, &close_up_b},
                          preview,
                          options.draw_budget_s,
                          anchors};
  draw(panes);
  host.end_frame(style().page);
  // A software renderer would let frames pile up, hundreds of megabytes of them, until one must wait for all.
  gl::finish_drawing(context);
  const bool with_maps = maps_are_shown();
  pictures.take([&] { return screenshot(); },
                {!with_maps || shows_all_points(), with_maps ? std::optional(maps_place) : std::nullopt,
                 transient.pane_aspect});
}

void Ui::Parts::paint() {
  host.paint();
  gl::finish_drawing(context);
}

Image Ui::Parts::screenshot() {
  paint();
  return gl::read_default_framebuffer(context);
}

void Ui::paint() {
  parts_->alone.execute([&] { parts_->paint(); });
}

Image Ui::screenshot() {
  return parts_->screenshot();
}

void Ui::Parts::quit() {
  transient.quits_at_once = transient.quit || !is_exporting();
  if (!transient.quits_at_once)
    explorer.messages.note("The window closes when the file is written. Quit again to stop writing it.");
  transient.quit = true;
}

void Ui::quit() {
  parts_->quit();
}

bool Ui::wants_quit() const {
  return parts_->transient.quit && (parts_->transient.quits_at_once || !is_exporting());
}

bool Ui::pictures_done() const {
  const Parts& p = *parts_;
  if (p.pictures.waits()) return false;
  if (p.transient.camera_moved_s < 0.5) return false;
  if (!p.maps_are_shown()) return true;
  const auto sides = sides_of(p.explorer.settings().layout);
  const auto done = [&](Side side) { return (side == Side::kA ? p.view_a : p.view_b).done(); };
  return std::all_of(sides.begin(), sides.end(), done);
}

bool Ui::Parts::shows_all_points() const {
  if (explorer.loaded() == nullptr) return false;
  const auto has = [&](Side side) { return (side == Side::kA ? view_a : view_b).has_all_points(); };
  const auto sides = sides_of(explorer.settings().layout);
  return std::all_of(sides.begin(), sides.end(), has);
}

bool Ui::shows_all_points() const {
  return parts_->shows_all_points();
}

bool Ui::has_input() const {
  return !parts_->input.empty();
}

bool Ui::is_exporting() const {
  return parts_->is_exporting();
}

bool Ui::animates() const {
  const Parts& p = *parts_;
  return !pictures_done() || has_input() || p.transient.just_opened || p.explorer.maps.waits_to_place() ||
         p.explorer.is_playing();
}

std::optional<PixelRect> Ui::anchor(const std::string& name) const {
  const auto found = parts_->anchors.find(name);
  if (found == parts_->anchors.end()) return std::nullopt;
  return found->second;
}

std::vector<std::string> Ui::anchor_names() const {
  std::vector<std::string> names;
  for (const auto& [name, place] : parts_->anchors) names.push_back(name);
  return names;
}

std::string& Ui::clipboard() {
  return parts_->host.clipboard;
}

void Ui::set_display_scale(double scale) {
  parts_->options.display_scale = scale;
}

}  // namespace sweepscope::ui
