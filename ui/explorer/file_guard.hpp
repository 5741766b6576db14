#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "ui/model/file_roots.hpp"
#include "ui/state/command.hpp"
#include "ui/state/reading_choices.hpp"

namespace sweepscope::ui {

/// A file's path from the root of the file system, for a person.
std::string whole_path(const std::filesystem::path& path);

/// Which files commands may read and write, and what would be lost. The use of a file is declared with the
/// parameter that names it (FileUse).
class FileGuard {
 public:
  /// `given`: what the program was started with, which may lie anywhere. `inputs`: what it read already.
  FileGuard(FileRoots roots, ReadingChoices given, std::vector<std::filesystem::path> inputs)
      : roots_(std::move(roots)), given_(std::move(given)), inputs_(std::move(inputs)) {}

  const FileRoots& roots() const { return roots_; }
  /// Checks all files that a command names, before it is carried out.
  Result<void> check(const Call& call) const;
  /// A session that may be read can name a recording that may not, and a folder can hold links.
  Result<void> check_reading(const ReadingChoices& choices) const;
  /// Checks that none of these files is one that was opened (see check_run_files).
  Result<void> check_outputs(std::vector<std::filesystem::path> outputs,
                             const std::filesystem::path& folder = {}) const;
  /// What a command would write over, as a whole path; empty if nothing, or if it is the session that is
  /// open.
  std::string replaced_by(const Call& call) const;

  /// What is opened is not written over from then on.
  void add_inputs(const ReadingChoices& choices);
  void add_input(const std::filesystem::path& file) { inputs_.push_back(file); }
  /// The session that was opened or saved last: saving it again is no harm.
  void set_session(const std::filesystem::path& file) { session_ = file; }

 private:
  Result<void> check_written(const std::string& name, FileUse use) const;
  bool is_session(const std::filesystem::path& file, FileUse use) const;

  FileRoots roots_;
  ReadingChoices given_;
  std::vector<std::filesystem::path> inputs_;
  std::filesystem::path session_;
};

}  // namespace sweepscope::ui
