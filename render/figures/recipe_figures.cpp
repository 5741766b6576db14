#include "render/comparison/look_options.hpp"
#include "render/figures/recipe_parts.hpp"

namespace sweepscope::recipe_parts {
namespace {

using yaml::Members, yaml::read_choice, yaml::read_list, yaml::read_members, yaml::read_switch,
    yaml::read_text, yaml::refuse;
using YAML::Node;

std::vector<MapSpec> read_maps(const Node& node, const std::string& name, const Recipe& recipe) {
  std::vector<MapSpec> maps;
  for (const Node& one : read_list(node)) {
    MapSpec& map = maps.emplace_back();
    bool has_offset = false;
    read_members(
        one, name + ": a map",
        {{"recording",
          [&](const Node& v) { map.recording = read_reference(v, recipe.recordings, "recording"); }},
         {"offset_ms",
          [&](const Node& v) {
            map.offset_s = 1e-3 * read_within(v, name + ": offset_ms", -10000, 10000);
            has_offset = true;
          }},
         {"label", [&](const Node& v) { map.label = read_text(v, name + ": label"); }},
         {"points",
          [&](const Node& v) {
            map.features_only = read_choice<bool>(v, name + ": points", {{"all", false}, {"features", true}});
          }},
         {"poses", [&](const Node& v) {
            map.true_poses = read_choice<bool>(v, name + ": poses", {{"solved", false}, {"truth", true}});
          }}});
    if (map.recording.empty() || !has_offset) refuse(one, name + ": a map needs recording and offset_ms");
    const bool simulated =
        std::holds_alternative<SimulationOptions>(recipe.recordings.at(map.recording).source);
    if (map.true_poses && !simulated) refuse(one, name + ": only a simulation knows the true poses");
  }
  if (maps.empty() || maps.size() > 4) refuse(node, name + " shows one to four maps");
  return maps;
}

void add_members(Members& members, MapsFigure& figure, const std::string& name, const Recipe& recipe) {
  members["maps"] = [&recipe, &figure, name](const Node& v) { figure.maps = read_maps(v, name, recipe); };
  members["estimate"] = [&recipe, &figure](const Node& v) {
    figure.estimate = read_reference(v, recipe.estimates, "estimate");
  };
}

void add_members(Members& members, CurvesFigure& figure, const std::string& name, const Recipe& recipe) {
  members["estimates"] = [&recipe, &figure](const Node& v) {
    figure.estimates = read_estimate_names(v, recipe);
  };
  members["criteria"] = [&figure, name](const Node& v) {
    for (const Node& one : read_list(v)) {
      figure.criteria.push_back(read_choice<Criterion>(
          one, name + ": criteria",
          {{"d", Criterion::kD}, {"e", Criterion::kE}, {"n", Criterion::kN}, {"roll", Criterion::kRoll}}));
    }
  };
}

void add_members(Members& members, ProfileFigure& figure, const std::string& name, const Recipe& recipe) {
  members["maps"] = [&recipe, &figure, name](const Node& v) { figure.maps = read_maps(v, name, recipe); };
  members["at_m"] = [&figure, name](const Node& v) {
    const auto at = read_numbers(v, name + ": at_m", 2);
    figure.at_m = Eigen::Vector2d(at[0], at[1]);
  };
  members["normal_deg"] = [&figure, name](const Node& v) {
    figure.normal_deg = read_within(v, name + ": normal_deg", -360, 360);
  };
  members["length_m"] = [&figure, name](const Node& v) {
    figure.length_m = read_within(v, name + ": length_m", 0.01, 100);
  };
  members["heights_m"] = [&figure, name](const Node& v) {
    const auto heights = read_numbers(v, name + ": heights_m", 2);
    if (!(heights[0] < heights[1])) refuse(v, name + ": heights_m must ascend");
    figure.heights = HeightRange{heights[0], heights[1]};
  };
}

void add_members(Members& members, ScanFigure& figure, const std::string& name, const Recipe& recipe) {
  members["recording"] = [&recipe, &figure](const Node& v) {
    figure.recording = read_reference(v, recipe.recordings, "recording");
  };
  members["at_s"] = [&figure, name](const Node& v) { figure.at_s = read_within(v, name + ": at_s", 0, 1e6); };
}

void add_members(Members& members, InteractiveFigure& figure, const std::string& name, const Recipe& recipe) {
  members["maps"] = [&recipe, &figure, name](const Node& v) { figure.maps = read_maps(v, name, recipe); };
  members["estimate"] = [&recipe, &figure](const Node& v) {
    figure.estimate = read_reference(v, recipe.estimates, "estimate");
  };
  members["points"] = [&figure, name](const Node& v) {
    const double points = read_within(v, name + ": points", 1000, double(kMaxLivePoints));
    figure.points = static_cast<std::size_t>(points);
  };
}

void add_members(Members& members, OverTimeFigure& figure, const std::string&, const Recipe& recipe) {
  members["estimate"] = [&recipe, &figure](const Node& v) {
    figure.estimate = read_reference(v, recipe.estimates, "estimate");
  };
}

void add_members(Members& members, ResidualsFigure& figure, const std::string&, const Recipe& recipe) {
  members["estimate"] = [&recipe, &figure](const Node& v) {
    figure.estimate = read_reference(v, recipe.estimates, "estimate");
  };
}

void add_members(Members& members, TrendFigure& figure, const std::string& name, const Recipe& recipe) {
  members["table"] = [&recipe, &figure, name](const Node& v) {
    figure.table = recipe.path.parent_path() / read_text(v, name + ": table");
  };
}

using Shown = decltype(FigureSpec::what);

/// The figure as it is before its members are read: the kind alone.
Shown read_kind(const Node& node, const std::string& name) {
  static const std::map<std::string, Shown> kinds{
      {"maps", MapsFigure{}},   {"curves", CurvesFigure{}},          {"profile", ProfileFigure{}},
      {"scan", ScanFigure{}},   {"over-time", OverTimeFigure{}},     {"residuals", ResidualsFigure{}},
      {"trend", TrendFigure{}}, {"interactive", InteractiveFigure{}}};
  if (!node.IsMap()) refuse(node, name + " must be a map of keys to values");
  const Node kind = node["kind"];
  return read_choice<Shown>(kind.IsDefined() ? kind : node, name + ": kind", kinds);
}

void check_complete(const MapsFigure& figure, const Node& node, const std::string& name) {
  if (figure.maps.empty()) refuse(node, name + " needs maps");
}

void check_complete(const CurvesFigure& figure, const Node& node, const std::string& name) {
  if (figure.estimates.empty()) refuse(node, name + " needs estimates");
}

void check_complete(const ProfileFigure& figure, const Node& node, const std::string& name) {
  if (figure.maps.empty()) refuse(node, name + " needs maps");
  if (figure.at_m && !figure.heights) refuse(node, name + ": at_m needs heights_m");
}

void check_complete(const ScanFigure& figure, const Node& node, const std::string& name) {
  if (figure.recording.empty()) refuse(node, name + " needs a recording");
}

void check_complete(const OverTimeFigure& figure, const Node& node, const std::string& name) {
  if (figure.estimate.empty()) refuse(node, name + " needs an estimate");
}

void check_complete(const ResidualsFigure& figure, const Node& node, const std::string& name) {
  if (figure.estimate.empty()) refuse(node, name + " needs an estimate");
}

void check_complete(const TrendFigure& figure, const Node& node, const std::string& name) {
  if (figure.table.empty()) refuse(node, name + " needs a table");
}

void check_complete(const InteractiveFigure& figure, const Node& node, const std::string& name) {
  if (figure.maps.size() != 2 || figure.maps[0].recording != figure.maps[1].recording)
    refuse(node, name + " needs two maps of one recording");
  for (const MapSpec& map : figure.maps)
    if (map.true_poses || map.features_only)
      refuse(node, name + " shows all points along the solved trajectory");
}

std::vector<PictureFormat> read_formats(const Node& node, const std::string& name) {
  std::vector<PictureFormat> formats;
  for (const Node& one : read_list(node)) {
    formats.push_back(read_choice<PictureFormat>(
        one, name + ": formats",
        {{"png", PictureFormat::kPng}, {"svg", PictureFormat::kSvg}, {"pdf", PictureFormat::kPdf}}));
  }
  return formats;
}

}  // namespace

/// Members for all look options; what they set goes to `look`.
Members look_members(ComparisonOptions& look) {
  Members members;
  for (const LookOption& option : look_options()) {
    members[option.name] = [&look, &option](const Node& node) {
      const std::vector<Node> values = option.repeats ? read_list(node) : std::vector<Node>{node};
      for (const Node& value : values) {
        if (!value.IsScalar()) refuse(value, fmt::format("{} must be text", option.name));
        if (const auto set = set_look(look, option, value.Scalar()); !set) refuse(value, set.error().message);
      }
    };
  }
  members["each-own-view"] = [&look](const Node& node) {
    look.each_own_view = read_switch(node, "each-own-view");
  };
  return members;
}

FigureSpec read_figure(const std::string& key, const Node& node, const Recipe& recipe,
                       const ComparisonOptions& look) {
  const std::string name = "figure " + key;
  FigureSpec spec{key, read_kind(node, name), look, {}};
  Members members = look_members(spec.look);
  members["kind"] = [](const Node&) {};  // read above
  members["formats"] = [&](const Node& v) { spec.formats = read_formats(v, name); };
  std::visit([&](auto& figure) { add_members(members, figure, name, recipe); }, spec.what);
  read_members(node, name, members);
  const bool page = std::holds_alternative<InteractiveFigure>(spec.what);
  if (page && !spec.formats.empty()) refuse(node, name + " is a page: it has no formats");
  if (!page && spec.formats.empty()) spec.formats = {PictureFormat::kPng};
  std::visit([&](const auto& figure) { check_complete(figure, node, name); }, spec.what);
  return spec;
}

}  // namespace sweepscope::recipe_parts
