#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "core/offset/prepared/kept_candidates.hpp"
#include "core/results/sealed_file.hpp"

namespace sweepscope {

/// The search that a candidate file belongs to: everything that a candidate's values depend on.
struct CandidateSearch {
  std::string program;               // content hash of the executable: another build may compute otherwise
  std::string recording;             // as it was named
  std::string recording_hash;        // of its content
  std::string rig, rig_hash;         // path and content hash of the rig file; empty: none
  std::vector<std::string> options;  // of `estimate`, such as "--range=19:29:1"
  std::optional<Shard> shard;
};

/// A file of candidates ("sweepscope.candidates/2"): a line of JSON that identifies the search, then one line
/// per candidate. Every line ends with the hash of its bytes, so that damage is detected.
struct Candidates {
  CandidateSearch search;
  std::vector<CurvePoint> points;  // offsets ascend
  std::size_t whole_bytes = 0;     // of the text; behind them a line that was not written to its end
};

/// Refuses a damaged line; an incomplete last line is ignored. `name` is the name of the file in messages,
/// which also give the line.
Result<Candidates> parse_candidates(std::string_view text, std::string_view name);
Result<Candidates> read_candidates(const std::filesystem::path& path);
/// The text of such a file.
std::string candidates_text(const CandidateSearch& search, const std::vector<CurvePoint>& points);

/// Why two searches are not the same, except for their shards: "it holds --weight-c=2, and this is
/// --weight-c=1". The folders of the files are not compared. Empty if the searches are the same.
std::string difference(const CandidateSearch& held, const CandidateSearch& wanted);

/// Candidates, kept in a file as they are finished: a run that is killed loses only those that it was
/// computing. The file is locked against a second run.
class CandidateFile final : public CandidateStore {
 public:
  /// Creates the file, or resumes an existing one. ExitCode::kWrongUsage if it belongs to another search or
  /// shard, is in use, or cannot be written; kUnreadableInput if it is not a candidate file.
  static Result<std::unique_ptr<CandidateFile>> open(const std::filesystem::path& path,
                                                     const CandidateSearch& search);
  /// The same for a file that a command keeps while it works, beside what it makes: a file of another search
  /// or version, or a damaged one, is started again. A file that is not a candidate file is refused.
  static Result<std::unique_ptr<CandidateFile>> open_while_working(const std::filesystem::path& path,
                                                                   const CandidateSearch& search);

  std::optional<CurvePoint> find(double offset_s) override;
  void keep(const CurvePoint& point) override;
  std::optional<Error> failed() const override;
  /// Rewrites the file in order, so that after a finished run its bytes do not depend on which thread was
  /// faster.
  Result<void> put_in_order();

  std::size_t taken_up() const { return taken_up_; }
  std::size_t held() const;
  /// The message after an interruption: how many candidates are kept, and where.
  std::string interrupted_in_words() const;
  /// Removes the file, once the result of its candidates is written.
  void remove();

 private:
  enum class Unusable { kRefused, kBegunAnew };

  CandidateFile(SealedFile file, const CandidateSearch& search) : file_(std::move(file)), search_(search) {}
  static Result<std::unique_ptr<CandidateFile>> open(const std::filesystem::path& path,
                                                     const CandidateSearch& search, Unusable unusable);
  Result<void> take_up(Unusable unusable);
  /// What a text holds that is to be of this search and shard.
  Result<Candidates> parse_own(std::string_view text) const;

  SealedFile file_;
  CandidateSearch search_;
  std::size_t taken_up_ = 0;
  mutable std::mutex mutex_;
  std::vector<CurvePoint> points_;
  std::optional<Error> failed_;
};

/// The candidates of the shards of one search.
class MergedCandidates final : public CandidateStore {
 public:
  /// Refuses files that do not belong together (ExitCode::kWrongUsage) or cannot be read.
  static Result<MergedCandidates> read(const std::vector<std::filesystem::path>& paths);
  MergedCandidates(MergedCandidates&& other) noexcept;

  /// A candidate that is in no file is remembered and counts as one that failed.
  std::optional<CurvePoint> find(double offset_s) override;
  void keep(const CurvePoint&) override {}
  std::optional<Error> failed() const override { return std::nullopt; }
  /// Which were asked for and not there, in a sentence that says which shard is not finished; nothing where
  /// all were.
  std::optional<Error> missing() const;

  /// The first file's.
  const CandidateSearch& search() const { return files_.front().search; }

 private:
  MergedCandidates() = default;

  std::vector<std::string> names_;
  std::vector<Candidates> files_;
  std::vector<CurvePoint> points_;
  mutable std::mutex mutex_;
  std::vector<double> missing_s_;
};

}  // namespace sweepscope
