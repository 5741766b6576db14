#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ui/explorer/messages.hpp"
#include "ui/jobs/background.hpp"
#include "ui/state/reading_choices.hpp"

namespace sweepscope::ui {

/// The page that is shown before a recording is opened: what can be chosen, and what is chosen.
class ChoicesPage {
 public:
  struct Choosing {
    ReadingChoices choices;
    std::optional<ReadingSurvey> survey;  // of these choices, or of the ones before while it is being made
    std::string problem;                  // why it could not be opened as it was asked for
  };
  ChoicesPage(Background& background, Messages& messages) : background_(background), messages_(messages) {}

  /// Null while it is not shown.
  const Choosing* choosing() const { return choosing_ ? &*choosing_ : nullptr; }
  bool is_surveying() const;

  /// Shows it with a survey that is made in the background. A failure of that closes it with a message.
  void show(const ReadingChoices& choices);
  /// Shows it because the recording could not be opened.
  void show(const ReadingChoices& choices, ReadingSurvey survey, const std::string& problem);
  /// Other choices, while it is shown; looks at the file again where that is needed.
  void choose(const ReadingChoices& choices);
  /// While a recording is read.
  void close();
  /// A recording is open: what was left of a page ends.
  void forget() { left_.reset(); }
  /// By a person: its choices are there when it is shown again.
  void leave();
  /// Those that were left, of this file; null if there are none.
  const ReadingChoices* left(const std::string& file) const;

 private:
  void start_survey();

  Background& background_;
  Messages& messages_;
  std::optional<Choosing> choosing_;
  std::optional<ReadingChoices> left_;
};

/// Why it cannot be opened with the choices at hand, as far as it is known: sentences. A missing laser or
/// motor goes before anything that follows from it.
std::vector<std::string> problems_of(const ChoicesPage::Choosing& choosing);

}  // namespace sweepscope::ui
