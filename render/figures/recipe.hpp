#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/offset/estimator.hpp"
#include "core/recording/formats/read_recording.hpp"
#include "core/simulation/simulate.hpp"
#include "render/comparison/comparison.hpp"
#include "render/page/live_map.hpp"

namespace sweepscope {

/// A recording to read, with the options of the command line.
struct RecordedFile {
  std::filesystem::path path;
  std::optional<std::filesystem::path> rig;
  std::optional<StampSource> stamps;
};

/// The source of a recipe's data: a file, or a simulation that is made for it.
struct RecordingSpec {
  std::variant<RecordedFile, SimulationOptions> source;
  std::optional<std::pair<double, double>> window_s;
};

struct EstimateSpec {
  std::string recording;
  EstimateOptions options;
  std::filesystem::path file;  // written by `sweepscope estimate --json`; empty: computed
};

/// A map to draw: of a recording at an offset.
struct MapSpec {
  std::string recording;
  double offset_s = 0;
  std::string label;           // empty: the offset
  bool features_only = false;  // only its edge and plane points
  bool true_poses = false;     // placed by the simulation's own poses and not by LOAM's
};

enum class PictureFormat { kPng, kSvg, kPdf };
enum class Criterion { kD, kE, kN, kRoll };

/// Maps side by side, with the criteria below if an estimate is named.
struct MapsFigure {
  std::vector<MapSpec> maps;
  std::string estimate;
};

/// Criteria over the offset, a chart for each; several estimates share a chart.
struct CurvesFigure {
  std::vector<std::string> estimates;
  std::vector<Criterion> criteria;
};

/// Point density across a wall, for each of the maps.
struct ProfileFigure {
  std::vector<MapSpec> maps;
  std::optional<Eigen::Vector2d>
      at_m;               // a point on the face, in the map frame; absent: the face is searched for
  double normal_deg = 0;  // roughly across the face, 0 along x
  double length_m = 0.4;
  std::optional<HeightRange> heights;  // above the sensor's path
};

/// The edge and plane points of one scan, in the scanner's plane.
struct ScanFigure {
  std::string recording;
  double at_s = 0;  // since the first scan
};

/// The offset of windows over time, of an estimate with `over-time`.
struct OverTimeFigure {
  std::string estimate;
};

/// Distances from flat surfaces over motor angle and beam, before and after, of an estimate with `solve`.
struct ResidualsFigure {
  std::string estimate;
};

/// The offsets of many recordings, from a table that `estimate --table` wrote as JSON.
struct TrendFigure {
  std::filesystem::path table;
};

/// A page in which a recording's map is drawn at any offset: NAME.html.
struct InteractiveFigure {
  std::vector<MapSpec> maps;  // A and B, of one recording: what it shows at first, and as pictures on paper
  std::string estimate;       // its criteria below; may be empty
  std::size_t points = kDefaultLivePoints;
};

struct FigureSpec {
  std::string name;  // of the files
  std::variant<MapsFigure, CurvesFigure, ProfileFigure, ScanFigure, OverTimeFigure, ResidualsFigure,
               TrendFigure, InteractiveFigure>
      what;
  ComparisonOptions look;
  std::vector<PictureFormat> formats;  // empty for a page
};

/// The value that a column of a table shows for each estimate.
enum class TableValue { kOffset, kSigma, kOffsetByD, kD, kOffsetByN, kOffsetByE, kTruth, kDifference };

struct ColumnSpec {
  std::string title, unit;
  std::variant<TableValue, std::vector<std::string>> values;  // or one text for each row
  int decimals = 2;
};

struct TableSpec {
  std::string name;  // of the files
  std::string title;
  std::vector<std::string> estimates;  // a row each
  std::vector<ColumnSpec> columns;
};

/// What `sweepscope figures` makes: recordings, estimates of their offsets, and figures and tables of both.
struct Recipe {
  std::filesystem::path path;
  std::map<std::string, RecordingSpec> recordings;
  std::map<std::string, EstimateSpec> estimates;
  std::vector<FigureSpec> figures;
  std::vector<TableSpec> tables;
};

/// Reads a recipe (YAML; see assets/figures). Files that it names are relative to its folder. Unknown keys,
/// unknown names and invalid values are errors with line and column.
Result<Recipe> read_recipe(const std::filesystem::path& path);
/// The same for a recipe that is not in a file: files are relative to the current folder. `name` stands for
/// the file in messages; it names no folder.
Result<Recipe> parse_recipe(const std::string& text, const std::string& name);

}  // namespace sweepscope
