#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "core/offset/estimate.hpp"
#include "ui/state/reading_choices.hpp"
#include "ui/state/settings.hpp"

namespace sweepscope::ui {

/// The state that is kept between two runs: the recording, the settings, and the estimate if there is one.
struct Session {
  std::string source;      // the line that opens the recording: `open FILE` or `sample SCENE`
  ReadingChoices reading;  // how its file is read, without the file and the poses, which `source` names
  Settings settings;
  std::optional<Estimate> estimate;
};

/// A JSON object (schema "sweepscope.session/1"): a key for each field command, in their order. The same
/// session gives the same bytes.
std::string session_to_json(const Session& session);

/// Reads it back. Missing keys keep their defaults, unknown ones are skipped; an invalid value is
/// ExitCode::kUnreadableInput with a sentence that names `name` and the key.
Result<Session> parse_session(std::string_view text, std::string_view name);

}  // namespace sweepscope::ui
