#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "core/job.hpp"

namespace sweepscope::app {

/// "reading    [#########           ]  45 %   0:12 left", `width` columns wide at most.
std::string progress_line(std::string_view phase, double fraction, std::chrono::duration<double> elapsed,
                          int width);

/// A progress bar on stderr, drawn only if that is a terminal, and removed at the end. Its job obeys Ctrl-C.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  const Job& job() const { return job_; }
  /// A line on stderr, above the bar.
  void say(const std::string& line) const;

 private:
  struct Bar;
  std::unique_ptr<Bar> bar_;
  Job job_;
};

}  // namespace sweepscope::app
