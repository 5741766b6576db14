#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "core/io/printable_text.hpp"
#include "ui/host/input.hpp"
#include "ui/panes/widgets.hpp"

namespace sweepscope::ui {
namespace {

constexpr double kWidth = 760, kHeight = 620;  // at 100 %

/// Of the titles, in pixels: on a phone no more than they need.
float titles_width(const PaneContext& context) {
  return context.pxf(ImGui::GetWindowWidth() < context.pxf(480) ? 84 : 120);
}

/// The title of what is chosen; its widget comes next.
void begin_choice(const PaneContext& context, const Command& command) {
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(command.title.c_str());
  tooltip(context, command.help);
  ImGui::SameLine(ImGui::GetWindowContentRegionMin().x + titles_width(context));
}

/// Under a widget: where its value comes from, or, marked, why there is none. Its lines are kept free where
/// there are fewer words: what comes below does not move under the mouse.
void note(const PaneContext& context, const std::string& words, bool problem = false, int lines = 1) {
  ImGui::PushFont(context.fonts.small);
  const float end = ImGui::GetCursorPosY() + static_cast<float>(lines) * ImGui::GetTextLineHeight();
  ImGui::PopFont();
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMin().x + titles_width(context));
  ImGui::PushFont(context.fonts.small);
  wrapped_text(problem ? colour_of_a(context.style) : context.style.faint_text,
               printable_text(words.empty() ? " " : words));
  ImGui::PopFont();
  const float gap = ImGui::GetStyle().ItemSpacing.y;
  if (ImGui::GetCursorPosY() < end + gap) ImGui::SetCursorPosY(end + gap);
}

std::string in_words(const LaserChoice& laser) {
  return fmt::format("{}   {} {} of up to {} beams{}", printable_line(laser.topic), laser.scans,
                     laser.of_clouds ? "lines of clouds" : "scans", laser.max_beams,
                     laser.rate_hz > 0 ? fmt::format(", {:.1f} Hz", laser.rate_hz) : "");
}

std::string in_words(const JointChoice& joint) {
  const char* source = joint.source == JointSource::kNumber       ? ", plain numbers"
                       : joint.source == JointSource::kController ? ", of a controller"
                       : joint.source == JointSource::kTransform  ? ", of transforms"
                                                                  : "";
  return fmt::format("{}   turns over {:.1f}°, {} samples on {}{}", printable_line(joint.joint),
                     joint.turned_deg, joint.samples, printable_line(joint.topic), source);
}

/// The numbers of the choices, the likeliest first; of equally likely ones in the order of the file.
template <typename Choice, typename Likelihood>
std::vector<std::size_t> likeliest_first(const std::vector<Choice>& choices, const Likelihood& likelihood) {
  std::vector<std::size_t> order(choices.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return likelihood(choices[i]); });
  return order;
}

/// A scanner of many beams that ran all the time; clouds are often made from its scans.
double likelihood(const LaserChoice& laser) {
  return static_cast<double>(laser.scans * laser.max_beams) * (laser.of_clouds ? 0.1 : 1);
}

/// A joint that turns, with a name as such motors have, often sampled. Wheels turn many times.
std::array<double, 3> likelihood(const JointChoice& joint) {
  constexpr std::array kNames{"laser", "lidar", "scan", "tilt", "servo", "hokuyo", "spin"};
  constexpr double kTurns_deg = 1, kManyTurns_deg = 4 * 360;
  std::string name = joint.joint + " " + joint.topic;
  std::ranges::transform(name, name.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const bool named =
      std::ranges::any_of(kNames, [&](const char* word) { return name.find(word) != name.npos; });
  const double turns = joint.turned_deg < kTurns_deg ? 0 : joint.turned_deg > kManyTurns_deg ? 1 : 2;
  return {turns, named ? 1.0 : 0.0, static_cast<double>(joint.samples)};
}

/// A list of choices, each with the line that it performs; `chosen` is marked.
struct Entries {
  std::vector<std::pair<std::string, std::string>> all;  // words, line
  std::optional<std::size_t> chosen;
  std::string without;  // what stands there while none is chosen
};

void combo(const PaneContext& context, const char* command, const Entries& entries) {
  ImGui::SetNextItemWidth(-1e-3f);
  const std::string now = entries.chosen ? entries.all[*entries.chosen].first : entries.without;
  if (ImGui::BeginCombo((std::string("##") + command).c_str(), now.c_str())) {
    for (std::size_t i = 0; i < entries.all.size(); ++i) {
      const auto& [words, line] = entries.all[i];
      if (ImGui::Selectable(words.c_str(), entries.chosen == i)) context.perform(line);
      if (entries.chosen == i) ImGui::SetItemDefaultFocus();
      context.anchor_last(line);
    }
    ImGui::EndCombo();
  }
  context.anchor_last(command);
  tooltip(context, find_command(command)->help);
}

std::string without(const PaneContext& context, bool none) {
  if (context.explorer.page.is_surveying()) return "Reading its streams …";
  return none ? "None in this recording" : "Not chosen yet";
}

void laser_choice(const PaneContext& context, const RecordingSurvey& streams) {
  begin_choice(context, *find_command("choose-laser"));
  Entries entries{{}, {}, without(context, streams.lasers.empty())};
  for (const std::size_t i : likeliest_first(streams.lasers, [](const auto& l) { return likelihood(l); })) {
    if (streams.laser == i) entries.chosen = entries.all.size();
    entries.all.emplace_back(in_words(streams.lasers[i]),
                             "choose-laser " + ui::quoted(streams.lasers[i].topic));
  }
  combo(context, "choose-laser", entries);
  note(context, streams.laser_problem, true);
}

void motor_choice(const PaneContext& context, const RecordingSurvey& streams, const std::string& motor_note) {
  begin_choice(context, *find_command("choose-motor"));
  Entries entries{{}, {}, without(context, streams.joints.empty())};
  for (const std::size_t i : likeliest_first(streams.joints, [](const auto& j) { return likelihood(j); })) {
    const JointChoice& joint = streams.joints[i];
    if (streams.joint == i) entries.chosen = entries.all.size();
    entries.all.emplace_back(
        in_words(joint), fmt::format("choose-motor {} {}", ui::quoted(joint.joint), ui::quoted(joint.topic)));
  }
  combo(context, "choose-motor", entries);
  note(context, streams.joint ? motor_note : streams.joint_problem, !streams.joint);
}

void stamps_choice(const PaneContext& context, const ChoicesPage::Choosing& choosing) {
  begin_choice(context, *find_command("choose-stamps"));
  const auto& stamps = choosing.choices.stamps;
  const std::size_t chosen = !stamps ? 0 : *stamps == StampSource::kHeader ? 1 : 2;
  combo(context, "choose-stamps",
        {{{"As detected", "choose-stamps detected"},
          {"Of the header, for both", "choose-stamps header"},
          {"Of receiving, for both", "choose-stamps receive"}},
         chosen,
         ""});
  note(context, choosing.survey ? choosing.survey->stamps_note : "");
}

/// A file, a button that asks for it, and one that takes it away.
void file_choice(const PaneContext& context, const char* command, const std::string& file,
                 const char* without) {
  begin_choice(context, *find_command(command));
  const std::string line = std::string("ask ") + command;
  const std::string name = file.empty() ? without : printable_line(file);
  const float button_width = context.pxf(90), gap = ImGui::GetStyle().ItemSpacing.x;
  const float room = ImGui::GetContentRegionAvail().x - (file.empty() ? 1.0f : 2.0f) * (button_width + gap);
  ImGui::AlignTextToFramePadding();
  const float x = ImGui::GetCursorPosX();
  ImGui::PushStyleColor(ImGuiCol_Text,
                        to_imgui(file.empty() ? context.style.faint_text : context.style.text));
  ImGui::TextUnformatted(
      fit_text(name, static_cast<double>(ImGui::GetFontSize()), static_cast<double>(room)).c_str());
  ImGui::PopStyleColor();
  if (!file.empty()) tooltip(context, file);
  ImGui::SameLine(x + room + gap);
  button(context, "Choose …", line, static_cast<double>(button_width));
  if (file.empty()) return;
  ImGui::SameLine();
  button(context, "None", command, static_cast<double>(button_width));
}

/// With a rig file, where the recording's transforms say how the laser is mounted as well.
void transforms_instead(const PaneContext& context, const ChoicesPage::Choosing& choosing) {
  if (choosing.choices.rig_file.empty() || !choosing.survey) return;
  const std::string says = with_named_axes(choosing.survey->streams.mount_note);
  const std::size_t about = says.find(" about ");
  if (about == says.npos) return;
  std::string axis = says.substr(about + 1);
  if (axis.ends_with('.')) axis.pop_back();
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMin().x + titles_width(context));
  button(context, fmt::format("Use the recording's transforms ({})", axis).c_str(), "choose-rig",
         context.px(380));
}

/// The recording from end to end: when the rig was stationary and when it moved, and a handle at either end
/// of the used part.
class PartStrip {
 public:
  PartStrip(const PaneContext& context, const ReadingSurvey& survey, const ReadingChoices& choices)
      : context_(context),
        survey_(survey),
        all_(!choices.window),
        from_s_(choices.window ? choices.window->from_s : 0),
        to_s_(choices.window ? std::min(choices.window->to_s, survey.duration_s) : survey.duration_s) {}

  void draw() {
    at_ = ImGui::GetCursorScreenPos();
    width_ = ImGui::GetContentRegionAvail().x;
    ImGui::InvisibleButton("choose-part", {width_, context_.pxf(kHigh)});
    context_.anchor_last("choose-part");
    tooltip(context_, find_command("choose-part")->help);
    use_mouse();
    draw_parts();
    for (const double end_s : {from_s_, to_s_}) draw_handle(end_s);
  }
  /// What is used.
  std::string words() const {
    std::string text =
        all_ ? fmt::format("All of {:.1f} s. Drag the ends to use a part.", survey_.duration_s)
             : fmt::format("{:.1f} to {:.1f} s of {:.1f} s.", from_s_, to_s_, survey_.duration_s);
    return text;
  }
  /// What the colours of the strip mean, and for how long each.
  void draw_legend() const {
    double moved_s = 0, stationary_s = 0;
    for (const MotionPart& part : survey_.motion)
      (part.moved ? moved_s : stationary_s) += part.end_s - part.begin_s;
    const double unknown_s = std::max(0.0, survey_.duration_s - moved_s - stationary_s);
    ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMin().x + titles_width(context_));
    ImGui::PushFont(context_.fonts.small);
    const ImU32 colours[] = {colour_of(false), colour_of(true), to_imgui(context_.style.frame)};
    const std::string words[] = {fmt::format("stationary {:.1f} s", stationary_s),
                                 fmt::format("moved {:.1f} s", moved_s),
                                 fmt::format("not known {:.1f} s", unknown_s)};
    const float side = context_.pxf(9);
    for (std::size_t i = 0; i < 3; ++i) {
      if (i == 2 && unknown_s < 0.05) continue;
      const ImVec2 at = ImGui::GetCursorScreenPos();
      const float top = at.y + (ImGui::GetTextLineHeight() - side) / 2;
      ImGui::GetWindowDrawList()->AddRectFilled({at.x, top}, {at.x + side, top + side}, colours[i]);
      ImGui::Dummy({side, side});
      ImGui::SameLine(0, context_.pxf(5));
      ImGui::TextDisabled("%s", words[i].c_str());
      ImGui::SameLine(0, context_.pxf(16));
    }
    ImGui::NewLine();
    ImGui::PopFont();
    context_.anchor_last("legend of choose-part");
  }

 private:
  static constexpr double kHigh = 26;

  float x_of(double s) const {
    const double share = std::clamp(s / std::max(survey_.duration_s, 1e-9), 0.0, 1.0);
    return at_.x + margin() + static_cast<float>(share) * (width_ - 2 * margin());
  }
  float margin() const { return context_.pxf(6); }
  ImU32 colour_of(bool moved) const {
    return to_imgui(moved ? colour_of_a(context_.style) : colour_of_b(context_.style), 0.75);
  }

  void use_mouse() {
    const double room = static_cast<double>(width_ - 2 * margin());
    const double mouse_s =
        std::clamp(static_cast<double>(ImGui::GetIO().MousePos.x - at_.x - margin()) / room, 0.0, 1.0) *
        survey_.duration_s;
    double& held = context_.transient.time_handle;
    if (ImGui::IsItemActivated()) held = std::abs(mouse_s - from_s_) <= std::abs(mouse_s - to_s_) ? 0 : 1;
    if (!ImGui::IsItemActive()) return;
    const double rounded_s = std::round(mouse_s * 10) / 10;
    if (held < 0.5)
      from_s_ = std::clamp(rounded_s, 0.0, std::max(0.0, to_s_ - 0.1));
    else
      to_s_ = std::max(rounded_s, from_s_ + 0.1);
    const bool whole = from_s_ < 0.05 && to_s_ > survey_.duration_s - 0.05;
    context_.perform(Call{find_command("choose-part"), {whole ? 0.0 : from_s_, whole ? 0.0 : to_s_}});
  }

  void draw_parts() const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float top = at_.y + context_.pxf(7), bottom = at_.y + context_.pxf(kHigh - 7);
    const auto bar = [&](double begin_s, double end_s, ImU32 colour) {
      list.AddRectFilled({x_of(begin_s), top}, {x_of(end_s), bottom}, colour);
    };
    bar(0, survey_.duration_s, to_imgui(context_.style.frame));
    for (const MotionPart& part : survey_.motion) bar(part.begin_s, part.end_s, colour_of(part.moved));
    const ImU32 veil = to_imgui(context_.style.page, 0.72);
    bar(0, from_s_, veil);
    bar(to_s_, survey_.duration_s, veil);
  }

  void draw_handle(double s) const {
    const float x = x_of(s), half = context_.pxf(3);
    ImGui::GetWindowDrawList()->AddRectFilled({x - half, at_.y + context_.pxf(2)},
                                              {x + half, at_.y + context_.pxf(kHigh - 2)},
                                              to_imgui(context_.style.text), context_.pxf(2));
  }

  const PaneContext& context_;
  const ReadingSurvey& survey_;
  bool all_;
  double from_s_, to_s_;
  ImVec2 at_{};
  float width_ = 0;
};

void part_choice(const PaneContext& context, const ChoicesPage::Choosing& choosing) {
  begin_choice(context, *find_command("choose-part"));
  const bool known = choosing.survey && choosing.survey->duration_s > 0;
  if (known) {
    PartStrip strip(context, *choosing.survey, choosing.choices);
    strip.draw();
    strip.draw_legend();
    return note(context, strip.words());
  }
  const auto& window = choosing.choices.window;
  ImGui::AlignTextToFramePadding();
  wrapped_text(context.style.faint_text,
               window ? fmt::format("{:.1f} to {:.1f} s", window->from_s, window->to_s)
                      : "All of it. The strip appears when laser and motor are known.");
}

void beginning(const PaneContext& context, const ChoicesPage::Choosing& choosing) {
  const std::filesystem::path file = choosing.choices.file;
  const float lines_end = ImGui::GetCursorPosY() + 4.4f * ImGui::GetTextLineHeightWithSpacing();
  text_in(context.fonts.heading, printable_line("Open " + file.filename().string()));
  wrapped_text(context.style.faint_text, printable_line(file.string()));
  tooltip(context, whole_path(choosing.choices.file));
  if (context.explorer.page.is_surveying() || !choosing.survey) {
    ImGui::TextDisabled("Reading its streams …");
  } else if (const auto problems = problems_of(choosing); problems.empty()) {
    ImGui::TextDisabled("Ready to open.");
  } else {
    const RecordingSurvey& streams = choosing.survey->streams;
    const bool nothing_to_choose = streams.lasers.empty() || streams.joints.empty();
    const std::string incomplete = nothing_to_choose ? "The marked items are missing in this recording."
                                                     : "Choose the marked items to continue.";
    wrapped_text(colour_of_a(context.style),
                 streams.complete() ? without_options(printable_message(problems.front())) : incomplete);
  }
  ImGui::SetCursorPosY(std::max(ImGui::GetCursorPosY(), lines_end));
}

/// Enter opens, unless a list is open or something in front has the keyboard.
bool entered(const Transient& transient) {
  const bool in_front = transient.palette || transient.help || transient.asks_for;
  const bool popup = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
  return !in_front && !popup && ImGui::IsKeyPressed(keys::kEnter, false);
}

}  // namespace

void draw_choices_page(const PaneContext& context, const PixelRect& place) {
  const ChoicesPage::Choosing choosing =
      *context.explorer.page.choosing();  // what is performed may replace it
  const double w = std::min(context.px(kWidth), place.width - context.px(24));
  const double h = std::min(context.px(kHeight), place.height - context.px(16));
  const PixelRect page{std::round(place.left + (place.width - w) / 2),
                       std::round(place.top + (place.height - h) / 2.4), w, h};
  if (!context.transient.on_choices_page) ImGui::SetNextWindowFocus();
  begin_panel(context, "choices", page, true, false, true);
  // The buttons stay in sight where the choices must be scrolled.
  const float buttons = ImGui::GetFrameHeight() + context.pxf(8) + ImGui::GetStyle().ItemSpacing.y;
  ImGui::BeginChild("all choices", {0, -buttons}, false, ImGuiWindowFlags_NavFlattened);
  beginning(context, choosing);
  heading(context, "Streams");
  const RecordingSurvey streams = choosing.survey ? choosing.survey->streams : RecordingSurvey();
  laser_choice(context, streams);
  motor_choice(context, streams, choosing.survey ? choosing.survey->motor_note : "");
  stamps_choice(context, choosing);
  heading(context, "Rig and trajectory");
  file_choice(context, "choose-rig", choosing.choices.rig_file, "No rig file");
  note(context, choosing.survey ? choosing.survey->mount_note : "");
  note(context, choosing.survey ? choosing.survey->reading_note : "");
  transforms_instead(context, choosing);
  file_choice(context, "choose-poses", choosing.choices.poses, "None: it is solved for");
  heading(context, "Time");
  part_choice(context, choosing);
  ImGui::EndChild();
  ImGui::Dummy({0, context.pxf(1)});
  const bool opens = entered(context.transient);
  button(context, "Open", "open-chosen", context.px(130), true);
  ImGui::SameLine();
  button(context, "Cancel", "dismiss", context.px(110));
  end_panel();
  if (opens) context.perform("open-chosen");
}

}  // namespace sweepscope::ui
