#include "core/results/candidate_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/io/atomic_file.hpp"
#include "core/results/fields.hpp"
#include "core/results/sealed_line.hpp"

namespace sweepscope {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kCandidatesSchema = "sweepscope.candidates/2";
constexpr std::string_view kOurs = "{\"schema\":\"sweepscope.candidates/";  // what every version begins with

std::string text_of(const Json& line) {
  return sealed_line(line.dump(-1, ' ', false, Json::error_handler_t::replace));
}

std::string header_line(const CandidateSearch& search) {
  Json line;
  line["schema"] = kCandidatesSchema;
  line["program"] = search.program;
  line["recording"] = search.recording;
  line["recording_hash"] = search.recording_hash;
  line["rig"] = search.rig;
  line["rig_hash"] = search.rig_hash;
  line["options"] = search.options;
  line["shard"] = search.shard ? Json({search.shard->number, search.shard->count}) : Json(nullptr);
  return text_of(line);
}

std::string point_line(const CurvePoint& point) {
  Json line;
  line["offset_ns"] = std::llround(point.offset_s * 1e9);
  for (const CurveColumn& column : kCurveColumns)
    if (const auto& value = point.*column.value)
      line[column.key] = std::isfinite(*value) ? Json(*value) : Json(fmt::format("{}", *value));
  return text_of(line);
}

std::optional<Shard> shard_of(const Json& value) {
  if (value.is_null()) return std::nullopt;
  constexpr int kMaxParts = std::numeric_limits<int>::max();
  const auto count = whole_number(value.at(1), 1, kMaxParts);
  const auto number = whole_number(value.at(0), 1, count.value_or(0));
  if (value.size() != 2 || !count || !number) throw std::runtime_error("no shard");
  return Shard{static_cast<int>(*number), static_cast<int>(*count)};
}

CandidateSearch search_of(const Json& line) {
  CandidateSearch search;
  search.program = line.at("program").get<std::string>();
  search.recording = line.at("recording").get<std::string>();
  search.recording_hash = line.at("recording_hash").get<std::string>();
  search.rig = line.at("rig").get<std::string>();
  search.rig_hash = line.at("rig_hash").get<std::string>();
  search.options = line.at("options").get<std::vector<std::string>>();
  search.shard = shard_of(line.at("shard"));
  return search;
}

CurvePoint point_of(const Json& line) {
  CurvePoint point;
  constexpr std::int64_t kMax_ns = 1'000'000'000'000;  // beyond a thousand seconds no clocks lie apart
  const auto offset_ns = whole_number(line.at("offset_ns"), -kMax_ns, kMax_ns);
  if (!offset_ns) throw std::runtime_error("no offset");
  point.offset_s = double(*offset_ns) * 1e-9;
  for (const CurveColumn& column : kCurveColumns)
    if (const auto found = line.find(column.key); found != line.end())
      point.*column.value =
          found->is_string() ? std::strtod(found->get<std::string>().c_str(), nullptr) : found->get<double>();
  return point;
}

bool ascends(const CurvePoint& a, const CurvePoint& b) {
  return a.offset_s < b.offset_s;
}

std::optional<CurvePoint> point_at(const std::vector<CurvePoint>& points, double offset_s) {
  const auto same = [&](const CurvePoint& point) { return point.offset_s == offset_s; };
  const auto found = std::find_if(points.begin(), points.end(), same);
  return found == points.end() ? std::nullopt : std::optional(*found);
}

// Offsets come once; a line that says the same again does no harm.
bool add_once(std::vector<CurvePoint>& points, const CurvePoint& point) {
  if (const auto there = point_at(points, point.offset_s)) return point_line(*there) == point_line(point);
  points.push_back(point);
  return true;
}

std::string shard_text(const std::optional<Shard>& shard) {
  return shard ? fmt::format("shard {}/{}", shard->number, shard->count) : std::string("the whole search");
}

std::string listed(const std::vector<std::string>& options) {
  std::string text;
  for (const std::string& option : options) text += (text.empty() ? "" : " ") + option;
  return text.empty() ? "no options" : text;
}

bool is_ours(std::string_view text) {
  return text.starts_with(kOurs) || kOurs.starts_with(text);
}

/// Whether a first line is that of a file of candidates, and of this version.
Result<void> check_header(std::string_view line, std::string_view name) {
  if (!line.starts_with(kOurs)) return unreadable(fmt::format("{}: is not a candidate file", name));
  if (line.substr(kOurs.find("sweepscope")).starts_with(fmt::format("{}\"", kCandidatesSchema))) return {};
  return unreadable(
      fmt::format("{}: line 1: another version of sweepscope wrote this candidate file. Delete it and run "
                  "the estimate again",
                  name));
}

}  // namespace

Result<Candidates> parse_candidates(std::string_view text, std::string_view name) {
  Candidates candidates;
  std::size_t number = 0;
  for (std::size_t begin = 0, end = 0; (end = text.find('\n', begin)) != text.npos; begin = end + 1) {
    const std::string_view line = text.substr(begin, end - begin);
    if (++number == 1) {
      if (auto checked = check_header(line, name); !checked) return tl::unexpected(checked.error());
    }
    if (!is_sound_line(line))
      return unreadable(
          fmt::format("{}: line {}: is damaged. Delete the file and run the estimate again", name, number));
    try {
      const Json values = Json::parse(line);
      if (number == 1)
        candidates.search = search_of(values);
      else if (!add_once(candidates.points, point_of(values)))
        return unreadable(fmt::format("{}: line {}: duplicate offset with other values", name, number));
    } catch (const std::exception&) {
      return unreadable(fmt::format("{}: line {}: is not a candidate", name, number));
    }
    candidates.whole_bytes = end + 1;
  }
  if (candidates.whole_bytes == 0) return unreadable(fmt::format("{}: is not a candidate file", name));
  std::sort(candidates.points.begin(), candidates.points.end(), ascends);
  return candidates;
}

Result<Candidates> read_candidates(const std::filesystem::path& path) {
  return read_file(path).and_then(
      [&](const std::string& text) { return parse_candidates(text, path.string()); });
}

std::string candidates_text(const CandidateSearch& search, const std::vector<CurvePoint>& points) {
  std::string text = header_line(search);
  for (const CurvePoint& point : points) text += point_line(point);
  return text;
}

std::string difference(const CandidateSearch& held, const CandidateSearch& wanted) {
  if (held.recording_hash != wanted.recording_hash)
    return fmt::format("it belongs to another recording: {}", held.recording);
  if (held.rig_hash != wanted.rig_hash)
    return held.rig.empty() ? "it was started without a rig file"
                            : fmt::format("it was started with another rig file: {}", held.rig);
  if (held.options != wanted.options)
    return fmt::format("it contains {}, and this is {}", listed(held.options), listed(wanted.options));
  if (held.program != wanted.program) return "it was started by another build of sweepscope";
  return {};
}

Result<std::unique_ptr<CandidateFile>> CandidateFile::open(const std::filesystem::path& path,
                                                           const CandidateSearch& search) {
  return open(path, search, Unusable::kRefused);
}

Result<std::unique_ptr<CandidateFile>> CandidateFile::open_while_working(const std::filesystem::path& path,
                                                                         const CandidateSearch& search) {
  return open(path, search, Unusable::kBegunAnew);
}

Result<std::unique_ptr<CandidateFile>> CandidateFile::open(const std::filesystem::path& path,
                                                           const CandidateSearch& search, Unusable unusable) {
  auto opened = SealedFile::open(path);
  if (!opened) return tl::unexpected(opened.error());
  std::unique_ptr<CandidateFile> file(new CandidateFile(std::move(*opened), search));
  if (auto taken = file->take_up(unusable); !taken) return tl::unexpected(taken.error());
  return file;
}

Result<Candidates> CandidateFile::parse_own(std::string_view text) const {
  auto there = parse_candidates(text, file_.path().string());
  if (!there) return there;
  std::string differs = difference(there->search, search_);
  if (differs.empty() && shard_text(there->search.shard) != shard_text(search_.shard))
    differs = fmt::format("it contains {}, and this is {}", shard_text(there->search.shard),
                          shard_text(search_.shard));
  if (!differs.empty())
    return failure(ExitCode::kWrongUsage, fmt::format("{}: {}", file_.path().string(), differs));
  return there;
}

Result<void> CandidateFile::take_up(Unusable unusable) {
  const auto text = file_.text();
  if (!text) return tl::unexpected(text.error());
  const std::string header = header_line(search_);
  if (SealedFile::is_begun(*text, header)) return file_.begin(header);
  auto there = parse_own(*text);
  if (!there && unusable == Unusable::kBegunAnew && is_ours(*text)) return file_.begin(header);
  if (!there) return tl::unexpected(there.error());
  if (auto cut = file_.cut(there->whole_bytes); !cut) return cut;
  points_ = std::move(there->points);
  taken_up_ = points_.size();
  return {};
}

std::optional<CurvePoint> CandidateFile::find(double offset_s) {
  const std::lock_guard lock(mutex_);
  return point_at(points_, offset_s);
}

void CandidateFile::keep(const CurvePoint& point) {
  const std::lock_guard lock(mutex_);
  if (failed_) return;
  if (auto appended = file_.append(point_line(point)); !appended) {
    failed_ = appended.error();
    failed_->message += fmt::format("; {} finished candidates are kept there", points_.size());
    return;
  }
  points_.push_back(point);
}

std::optional<Error> CandidateFile::failed() const {
  const std::lock_guard lock(mutex_);
  return failed_;
}

std::size_t CandidateFile::held() const {
  const std::lock_guard lock(mutex_);
  return points_.size();
}

std::string CandidateFile::interrupted_in_words() const {
  return fmt::format("interrupted; {} finished candidates are in {}; the same command continues from there",
                     held(), file_.path().string());
}

void CandidateFile::remove() {
  std::error_code ignored;
  std::filesystem::remove(file_.path(), ignored);
}

Result<void> CandidateFile::put_in_order() {
  const std::lock_guard lock(mutex_);
  std::sort(points_.begin(), points_.end(), ascends);
  return write_file(file_.path(), candidates_text(search_, points_));
}

MergedCandidates::MergedCandidates(MergedCandidates&& other) noexcept
    : names_(std::move(other.names_)),
      files_(std::move(other.files_)),
      points_(std::move(other.points_)),
      missing_s_(std::move(other.missing_s_)) {}

Result<MergedCandidates> MergedCandidates::read(const std::vector<std::filesystem::path>& paths) {
  MergedCandidates merged;
  for (const auto& path : paths) {
    auto file = read_candidates(path);
    if (!file) return tl::unexpected(file.error());
    if (!merged.files_.empty()) {
      const std::string differs = difference(file->search, merged.search());
      if (!differs.empty())
        return failure(ExitCode::kWrongUsage, fmt::format("{}: does not belong to {}: {}", path.string(),
                                                          merged.names_.front(), differs));
    }
    for (const CurvePoint& point : file->points)
      if (!add_once(merged.points_, point))
        return unreadable(fmt::format("{}: has other values at {:.6f} ms than another part", path.string(),
                                      point.offset_s * 1e3));
    merged.names_.push_back(path.string());
    merged.files_.push_back(std::move(*file));
  }
  return merged;
}

std::optional<CurvePoint> MergedCandidates::find(double offset_s) {
  if (auto point = point_at(points_, offset_s)) return point;
  const std::lock_guard lock(mutex_);
  missing_s_.push_back(offset_s);
  CurvePoint none;
  none.offset_s = offset_s;
  return none;
}

std::optional<Error> MergedCandidates::missing() const {
  if (missing_s_.empty()) return std::nullopt;
  const double first_s = *std::min_element(missing_s_.begin(), missing_s_.end());
  std::string parts;
  const int count = search().shard ? search().shard->count : 0;
  for (int number = 1; number <= count; ++number) {
    const auto is_it = [&](const Candidates& file) {
      return file.search.shard && file.search.shard->number == number;
    };
    if (std::none_of(files_.begin(), files_.end(), is_it))
      parts += fmt::format("{} {}/{}", parts.empty() ? "; no file has shard" : ",", number, count);
  }
  return Error{ExitCode::kUnreadableInput, fmt::format("{} candidates are missing, the first at {:g} ms{}: "
                                                       "run their estimates again",
                                                       missing_s_.size(), first_s * 1e3, parts)};
}

}  // namespace sweepscope
