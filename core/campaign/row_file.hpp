#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/campaign/campaign.hpp"
#include "core/error.hpp"
#include "core/results/sealed_file.hpp"

namespace sweepscope {

/// A row with what it belongs to: everything that it depends on, as one hash.
struct KeptRow {
  std::string key;
  CampaignRow row;
};

/// Finished rows, kept in a file beside the table ("sweepscope.rows/1": lines of JSON, see sealed_file.hpp),
/// so that a run that is killed loses only the recordings that it was working on. The file is locked against
/// a second run. Used from any thread.
class RowFile {
 public:
  /// Creates the file, or takes up the rows of an existing one; damaged lines are left out.
  /// ExitCode::kWrongUsage if it is in use or cannot be written; kUnreadableInput if it holds something else.
  static Result<std::unique_ptr<RowFile>> open(const std::filesystem::path& path);

  std::optional<CampaignRow> find(const std::string& key) const;
  void keep(const KeptRow& row);
  /// The error if keeping a row failed.
  std::optional<Error> failed() const;
  /// Makes these the only rows, so that the bytes of the file after a finished run do not depend on the order
  /// in which recordings were finished, and rows of other runs do not pile up.
  Result<void> replace(const std::vector<KeptRow>& rows);

 private:
  explicit RowFile(SealedFile file) : file_(std::move(file)) {}
  Result<void> take_up();

  SealedFile file_;
  mutable std::mutex mutex_;
  std::map<std::string, CampaignRow> rows_;
  std::optional<Error> failed_;
};

/// What identifies the content of a recording without reading it: path, size and time of change of each of
/// its files. Nothing where there are no files.
std::optional<std::string> recording_fingerprint(const std::filesystem::path& recording);

}  // namespace sweepscope
