#include "render/figures/recipe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/io/yaml_members.hpp"
#include "core/simulation/scene.hpp"
#include "render/comparison/look_options.hpp"

namespace sweepscope {
namespace {

using yaml::Members, yaml::read_choice, yaml::read_list, yaml::read_members, yaml::read_number,
    yaml::read_switch, yaml::read_text, yaml::refuse;
using YAML::Node;

constexpr std::uint64_t kMaxRecipe_bytes = std::uint64_t{1} << 20;

double read_within(const Node& node, const std::string& name, double least, double greatest) {
  const double number = read_number(node, name);
  if (number < least || number > greatest) {
    refuse(node, fmt::format("{} must be within {:g} to {:g}", name, least, greatest));
  }
  return number;
}

std::vector<double> read_numbers(const Node& node, const std::string& name, std::size_t count) {
  if (!node.IsSequence() || node.size() != count) {
    refuse(node, fmt::format("{} must be {} numbers", name, count));
  }
  std::vector<double> numbers;
  for (const Node& one : node) numbers.push_back(read_number(one, name));
  return numbers;
}

/// Names of files: nothing that would leave the folder.
void check_file_name(const std::string& name, const Node& node) {
  const bool plain = std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  });
  if (!plain || name.front() == '.') {
    refuse(node, fmt::format("\"{}\" is not a name of letters, digits, dots, dashes and underscores", name));
  }
}

template <typename T>
const T& find(const std::map<std::string, T>& all, const std::string& name, const std::string& what,
              const Node& node) {
  const auto found = all.find(name);
  if (found != all.end()) return found->second;
  std::string known;
  for (const auto& [key, value] : all) known += (known.empty() ? "" : ", ") + key;
  refuse(node, fmt::format("there is no {} \"{}\"; there are: {}", what, name, known));
}

class RecipeReader {
 public:
  explicit RecipeReader(const std::filesystem::path& path) : folder_(path.parent_path()) {
    recipe_.path = path;
  }

  Recipe read(const Node& document) {
    // Figures name estimates, and these name recordings: so in this order, whatever the file's.
    Node recordings, estimates, figures, tables, look;
    const auto keep = [](Node& into) { return [&into](const Node& node) { into.reset(node); }; };
    read_members(document, "the recipe",
                 {{"recordings", keep(recordings)},
                  {"estimates", keep(estimates)},
                  {"figures", keep(figures)},
                  {"tables", keep(tables)},
                  {"look", keep(look)}});
    if (look.IsDefined() && !look.IsNull()) read_look_map(look);
    entries(recordings, "recordings", [&](const std::string& name, const Node& node) {
      recipe_.recordings[name] = read_recording_spec(node, "recording " + name);
    });
    entries(estimates, "estimates", [&](const std::string& name, const Node& node) {
      recipe_.estimates[name] = read_estimate(node, "estimate " + name);
    });
    entries(figures, "figures", [&](const std::string& name, const Node& node) {
      recipe_.figures.push_back(read_figure(name, node));
    });
    entries(tables, "tables", [&](const std::string& name, const Node& node) {
      recipe_.tables.push_back(read_table(name, node));
    });
    if (recipe_.figures.empty() && recipe_.tables.empty()) {
      refuse(document, "the recipe makes nothing: figures or tables are needed");
    }
    return std::move(recipe_);
  }

 private:
  using Visit = std::function<void(const std::string&, const Node&)>;

  static void entries(const Node& node, const std::string& name, const Visit& visit) {
    if (!node.IsDefined() || node.IsNull()) return;
    yaml::for_each_entry(node, name, [&](const std::string& key, const Node& key_node, const Node& value) {
      check_file_name(key, key_node);
      visit(key, value);
    });
  }

  RecordingSpec read_recording_spec(const Node& node, const std::string& name) {
    RecordingSpec spec;
    RecordedFile file;
    SimulationOptions simulation;
    bool simulated = false, simulation_keys = false, file_keys = false;
    const auto number = [&](double& into, double least, double greatest, double unit) {
      return [&, least, greatest, unit](const Node& value) {
        into = unit * read_within(value, name, least, greatest);
        simulation_keys = true;
      };
    };
    read_members(
        node, name,
        {{"file", [&](const Node& v) { file.path = folder_ / read_text(v, name + ": file"); }},
         {"rig", [&](const Node& v) { file.rig = folder_ / read_text(v, name + ": rig"), file_keys = true; }},
         {"stamps",
          [&](const Node& v) {
            file.stamps = read_choice<StampSource>(
                v, name + ": stamps", {{"header", StampSource::kHeader}, {"receive", StampSource::kReceive}});
            file_keys = true;
          }},
         {"window_s",
          [&](const Node& v) {
            const auto window = read_numbers(v, name + ": window_s", 2);
            if (!(window[0] < window[1])) refuse(v, name + ": window_s must ascend");
            spec.window_s = {window[0], window[1]};
          }},
         {"simulate", [&](const Node& v) { simulation.scene = read_scene(v, name), simulated = true; }},
         {"offset_ms", number(simulation.offset_s, -10000, 10000, 1e-3)},
         {"noise_mm", number(simulation.noise_m, 0, 1000, 1e-3)},
         {"dropout", number(simulation.dropout, 0, 1, 1)},
         {"sweep_s", number(simulation.sweep_s, 0.05, 60, 1)},
         {"seed",
          [&](const Node& v) {
            simulation.seed = static_cast<std::uint64_t>(read_within(v, name + ": seed", 0, 9e15));
            simulation_keys = true;
          }},
         {"duration_s", [&](const Node& v) {
            simulation.duration_s = read_within(v, name + ": duration_s", 0.1, 1e5);
            simulation_keys = true;
          }}});
    if (simulated == !file.path.empty()) refuse(node, name + " needs either simulate or file");
    if (simulated ? file_keys : simulation_keys) {
      refuse(node, fmt::format("{}: {}", name,
                               simulated ? "rig and stamps belong to a file"
                                         : "offset, noise, seed and the like belong to a simulation"));
    }
    if (simulated) {
      spec.source = simulation;
    } else {
      spec.source = file;
    }
    return spec;
  }

  static std::string read_scene(const Node& node, const std::string& name) {
    const std::string scene = read_text(node, name + ": simulate");
    const auto& known = simulation::scene_names();
    if (std::find(known.begin(), known.end(), scene) == known.end()) {
      refuse(node, fmt::format("there is no scene \"{}\"; there are: {}", scene, fmt::join(known, ", ")));
    }
    return scene;
  }

  std::string read_reference(const Node& node, const auto& all, const std::string& what) {
    const std::string name = read_text(node, what);
    find(all, name, what, node);
    return name;
  }

  /// Members for all options of an estimate; what they set goes to `options`.
  static Members estimate_members(EstimateOptions& options, const std::string& name) {
    Members members;
    for (const EstimateOption& option : estimate_options()) {
      members[option.name] = [&options, &option, name](const Node& node) {
        const std::vector<Node> values = option.repeats ? read_list(node) : std::vector<Node>{node};
        for (const Node& value : values) {
          const std::string text = read_text(value, name + ": " + option.name);
          if (const auto set = option.set(options, text); !set)
            refuse(value, fmt::format("{}: {} {}, not \"{}\"", name, option.name, set.error().message, text));
        }
      };
    }
    return members;
  }

  EstimateSpec read_estimate(const Node& node, const std::string& name) {
    EstimateSpec spec;
    EstimateOptions& options = spec.options;
    const std::map<std::string, RigKind> kinds{{"stationary", RigKind::kStationary},
                                               {"moving", RigKind::kMoving}};
    Members members = estimate_members(options, name);
    members["recording"] = [&](const Node& v) {
      spec.recording = read_reference(v, recipe_.recordings, "recording");
    };
    members["file"] = [&](const Node& v) { spec.file = folder_ / read_text(v, name + ": file"); };
    members["assume"] = [&](const Node& v) {
      options.assume = read_choice<RigKind>(v, name + ": assume", kinds);
    };
    members["ranges_ms"] = [&](const Node& v) {
      for (const Node& one : read_list(v)) {
        const auto range = read_numbers(one, name + ": a range of ranges_ms", 3);
        if (!(range[0] <= range[1]) || !(range[2] > 0)) {
          refuse(one, name + ": a range must be [from, to, step] with from <= to and step > 0");
        }
        options.ranges.push_back({range[0] * 1e-3, range[1] * 1e-3, range[2] * 1e-3});
      }
    };
    read_members(node, name, members);
    if (spec.recording.empty()) refuse(node, name + " needs a recording");
    if (!spec.file.empty() && node.size() > 2)
      refuse(node, name + ": a file is not computed: it has no options");
    return spec;
  }

  /// Members for all look options; what they set goes to `look`.
  static Members look_members(ComparisonOptions& look) {
    Members members;
    for (const LookOption& option : look_options()) {
      members[option.name] = [&look, &option](const Node& node) {
        const std::vector<Node> values = option.repeats ? read_list(node) : std::vector<Node>{node};
        for (const Node& value : values) {
          if (!value.IsScalar()) refuse(value, fmt::format("{} must be text", option.name));
          if (const auto set = set_look(look, option, value.Scalar()); !set)
            refuse(value, set.error().message);
        }
      };
    }
    members["each-own-view"] = [&look](const Node& node) {
      look.each_own_view = read_switch(node, "each-own-view");
    };
    return members;
  }

  void read_look_map(const Node& node) { read_members(node, "look", look_members(look_)); }

  std::vector<MapSpec> read_maps(const Node& node, const std::string& name) {
    std::vector<MapSpec> maps;
    for (const Node& one : read_list(node)) {
      MapSpec& map = maps.emplace_back();
      bool has_offset = false;
      read_members(
          one, name + ": a map",
          {{"recording",
            [&](const Node& v) { map.recording = read_reference(v, recipe_.recordings, "recording"); }},
           {"offset_ms",
            [&](const Node& v) {
              map.offset_s = 1e-3 * read_within(v, name + ": offset_ms", -10000, 10000);
              has_offset = true;
            }},
           {"label", [&](const Node& v) { map.label = read_text(v, name + ": label"); }},
           {"points",
            [&](const Node& v) {
              map.features_only =
                  read_choice<bool>(v, name + ": points", {{"all", false}, {"features", true}});
            }},
           {"poses", [&](const Node& v) {
              map.true_poses = read_choice<bool>(v, name + ": poses", {{"solved", false}, {"truth", true}});
            }}});
      if (map.recording.empty() || !has_offset) refuse(one, name + ": a map needs recording and offset_ms");
      const bool simulated =
          std::holds_alternative<SimulationOptions>(recipe_.recordings.at(map.recording).source);
      if (map.true_poses && !simulated) refuse(one, name + ": only a simulation knows the true poses");
    }
    if (maps.empty() || maps.size() > 4) refuse(node, name + " shows one to four maps");
    return maps;
  }

  std::vector<std::string> read_estimates(const Node& node) {
    std::vector<std::string> names;
    for (const Node& one : read_list(node)) {
      names.push_back(read_reference(one, recipe_.estimates, "estimate"));
    }
    return names;
  }

  void add_maps_members(Members& members, MapsFigure& figure, const std::string& name) {
    members["maps"] = [this, &figure, name](const Node& v) { figure.maps = read_maps(v, name); };
    members["estimate"] = [this, &figure](const Node& v) {
      figure.estimate = read_reference(v, recipe_.estimates, "estimate");
    };
  }

  void add_curves_members(Members& members, CurvesFigure& figure, const std::string& name) {
    members["estimates"] = [this, &figure](const Node& v) { figure.estimates = read_estimates(v); };
    members["criteria"] = [&figure, name](const Node& v) {
      for (const Node& one : read_list(v)) {
        figure.criteria.push_back(read_choice<Criterion>(
            one, name + ": criteria",
            {{"d", Criterion::kD}, {"e", Criterion::kE}, {"n", Criterion::kN}, {"roll", Criterion::kRoll}}));
      }
    };
  }

  void add_profile_members(Members& members, ProfileFigure& figure, const std::string& name) {
    members["maps"] = [this, &figure, name](const Node& v) { figure.maps = read_maps(v, name); };
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

  void add_scan_members(Members& members, ScanFigure& figure, const std::string& name) {
    members["recording"] = [this, &figure](const Node& v) {
      figure.recording = read_reference(v, recipe_.recordings, "recording");
    };
    members["at_s"] = [&figure, name](const Node& v) {
      figure.at_s = read_within(v, name + ": at_s", 0, 1e6);
    };
  }

  void add_interactive_members(Members& members, InteractiveFigure& figure, const std::string& name) {
    members["maps"] = [this, &figure, name](const Node& v) { figure.maps = read_maps(v, name); };
    members["estimate"] = [this, &figure](const Node& v) {
      figure.estimate = read_reference(v, recipe_.estimates, "estimate");
    };
    members["points"] = [&figure, name](const Node& v) {
      const double points = read_within(v, name + ": points", 1000, double(kMaxLivePoints));
      figure.points = static_cast<std::size_t>(points);
    };
  }

  void add_over_time_members(Members& members, OverTimeFigure& figure) {
    members["estimate"] = [this, &figure](const Node& v) {
      figure.estimate = read_reference(v, recipe_.estimates, "estimate");
    };
  }

  void add_trend_members(Members& members, TrendFigure& figure, const std::string& name) {
    members["table"] = [this, &figure, name](const Node& v) {
      figure.table = folder_ / read_text(v, name + ": table");
    };
  }

  static std::string kind_of(const Node& node, const std::string& name) {
    if (!node.IsMap()) refuse(node, name + " must be a map of keys to values");
    const Node kind = node["kind"];
    if (!kind.IsDefined())
      refuse(node, name + " needs a kind: maps, curves, profile, scan, over-time, trend or interactive");
    return read_choice<std::string>(kind, name + ": kind",
                                    {{"maps", "maps"},
                                     {"curves", "curves"},
                                     {"profile", "profile"},
                                     {"scan", "scan"},
                                     {"over-time", "over-time"},
                                     {"trend", "trend"},
                                     {"interactive", "interactive"}});
  }

  FigureSpec read_figure(const std::string& figure_name, const Node& node) {
    const std::string name = "figure " + figure_name, kind = kind_of(node, name);
    FigureSpec spec;
    spec.name = figure_name;
    spec.look = look_;
    Members members = look_members(spec.look);
    members["kind"] = [](const Node&) {};
    members["formats"] = [&](const Node& v) {
      for (const Node& one : read_list(v)) {
        spec.formats.push_back(read_choice<PictureFormat>(
            one, name + ": formats",
            {{"png", PictureFormat::kPng}, {"svg", PictureFormat::kSvg}, {"pdf", PictureFormat::kPdf}}));
      }
    };
    MapsFigure maps;
    CurvesFigure curves;
    ProfileFigure profile;
    ScanFigure scan;
    OverTimeFigure over_time;
    TrendFigure trend;
    InteractiveFigure interactive;
    if (kind == "interactive") add_interactive_members(members, interactive, name);
    if (kind == "maps") add_maps_members(members, maps, name);
    if (kind == "curves") add_curves_members(members, curves, name);
    if (kind == "profile") add_profile_members(members, profile, name);
    if (kind == "scan") add_scan_members(members, scan, name);
    if (kind == "over-time") add_over_time_members(members, over_time);
    if (kind == "trend") add_trend_members(members, trend, name);
    read_members(node, name, members);
    if (kind == "trend") spec.what = trend;
    if (kind == "interactive") spec.what = interactive;
    if (kind == "over-time") spec.what = over_time;
    if (kind == "maps") spec.what = maps;
    if (kind == "curves") spec.what = curves;
    if (kind == "profile") spec.what = profile;
    if (kind == "scan") spec.what = scan;
    if (kind == "interactive" && !spec.formats.empty()) refuse(node, name + " is a page: it has no formats");
    if (spec.formats.empty() && kind != "interactive") spec.formats = {PictureFormat::kPng};
    check_complete(spec, node, name);
    return spec;
  }

  static void check_complete(const InteractiveFigure& figure, const Node& node, const std::string& name) {
    if (figure.maps.size() != 2 || figure.maps[0].recording != figure.maps[1].recording)
      refuse(node, name + " needs two maps of one recording");
    for (const MapSpec& map : figure.maps)
      if (map.true_poses || map.features_only)
        refuse(node, name + " shows all points along the solved trajectory");
  }

  static void check_complete(const FigureSpec& spec, const Node& node, const std::string& name) {
    const auto* maps = std::get_if<MapsFigure>(&spec.what);
    const auto* curves = std::get_if<CurvesFigure>(&spec.what);
    const auto* profile = std::get_if<ProfileFigure>(&spec.what);
    const auto* scan = std::get_if<ScanFigure>(&spec.what);
    if ((maps && maps->maps.empty()) || (profile && profile->maps.empty()))
      refuse(node, name + " needs maps");
    if (curves && curves->estimates.empty()) refuse(node, name + " needs estimates");
    const auto* over_time = std::get_if<OverTimeFigure>(&spec.what);
    if (scan && scan->recording.empty()) refuse(node, name + " needs a recording");
    if (over_time && over_time->estimate.empty()) refuse(node, name + " needs an estimate");
    const auto* trend = std::get_if<TrendFigure>(&spec.what);
    if (trend && trend->table.empty()) refuse(node, name + " needs a table");
    const auto* interactive = std::get_if<InteractiveFigure>(&spec.what);
    if (interactive) check_complete(*interactive, node, name);
    if (profile && profile->at_m && !profile->heights) refuse(node, name + ": at_m needs heights_m");
  }

  ColumnSpec read_column(const Node& node, const std::string& name, std::size_t rows) {
    ColumnSpec column;
    bool has_values = false;
    read_members(node, name + ": a column",
                 {{"title", [&](const Node& v) { column.title = read_text(v, name + ": title"); }},
                  {"unit", [&](const Node& v) { column.unit = read_text(v, name + ": unit"); }},
                  {"decimals",
                   [&](const Node& v) {
                     column.decimals = static_cast<int>(read_within(v, name + ": decimals", 0, 9));
                   }},
                  {"value",
                   [&](const Node& v) {
                     column.values = read_choice<TableValue>(v, name + ": value",
                                                             {{"offset", TableValue::kOffset},
                                                              {"sigma", TableValue::kSigma},
                                                              {"offset-by-d", TableValue::kOffsetByD},
                                                              {"d", TableValue::kD},
                                                              {"offset-by-n", TableValue::kOffsetByN},
                                                              {"offset-by-e", TableValue::kOffsetByE},
                                                              {"truth", TableValue::kTruth},
                                                              {"difference", TableValue::kDifference}});
                     has_values = true;
                   }},
                  {"values", [&](const Node& v) {
                     std::vector<std::string> texts;
                     for (const Node& one : read_list(v)) texts.push_back(read_text(one, name + ": values"));
                     if (texts.size() != rows) {
                       refuse(v, fmt::format("{}: {} values for {} estimates", name, texts.size(), rows));
                     }
                     column.values = std::move(texts);
                     has_values = true;
                   }}});
    if (!has_values) refuse(node, name + ": a column needs value or values");
    return column;
  }

  TableSpec read_table(const std::string& table_name, const Node& node) {
    const std::string name = "table " + table_name;
    TableSpec spec;
    spec.name = table_name;
    Node columns;
    read_members(node, name,
                 {{"title", [&](const Node& v) { spec.title = read_text(v, name + ": title"); }},
                  {"estimates", [&](const Node& v) { spec.estimates = read_estimates(v); }},
                  {"columns", [&](const Node& v) { columns.reset(v); }}});
    if (spec.estimates.empty()) refuse(node, name + " needs estimates");
    if (!columns.IsDefined() || !columns.IsSequence()) refuse(node, name + " needs a list of columns");
    for (const Node& column : columns) {
      spec.columns.push_back(read_column(column, name, spec.estimates.size()));
    }
    return spec;
  }

  std::filesystem::path folder_;
  Recipe recipe_;
  ComparisonOptions look_;  // what the recipe says of all figures
};

}  // namespace

Result<Recipe> read_recipe(const std::filesystem::path& path) {
  Recipe recipe;
  return yaml::read_file(path, "a recipe", kMaxRecipe_bytes,
                         [&](const Node& document) { recipe = RecipeReader(path).read(document); })
      .map([&] { return std::move(recipe); });
}

Result<Recipe> parse_recipe(const std::string& text, const std::string& name) {
  Recipe recipe;
  return yaml::read_document(text, name,
                             [&](const Node& document) { recipe = RecipeReader(name).read(document); })
      .map([&] { return std::move(recipe); });
}

}  // namespace sweepscope
