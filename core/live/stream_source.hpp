#pragma once

#include <string>

#include "core/live/live_source.hpp"
#include "core/recording/csv/csv_stream.hpp"

namespace sweepscope {

/// Lines (csv_stream.hpp) from an open file descriptor: a pipe, a terminal, a socket or a file. The last line
/// counts without a line end too, if it is complete.
class StreamSource : public LiveSource {
 public:
  /// The rig must outlive it; the descriptor stays the caller's.
  StreamSource(int descriptor, std::string name, const Rig& rig);

  Result<bool> listen(std::chrono::milliseconds max_wait) override;
  const RawRecording& so_far() const override { return stream_.so_far(); }
  RawRecording heard() override { return stream_.heard(); }
  RawRecording take() override { return stream_.take_lines(); }

 private:
  Result<void> take_lines();

  int descriptor_;
  std::string name_;
  CsvStream stream_;
  std::string pending_;       // the beginning of a line
  std::size_t searched_ = 0;  // this many bytes of it hold no line end
};

}  // namespace sweepscope
