#include "app/look_texts.hpp"

namespace sweepscope::app {

void LookTexts::declare(CLI::App& command) {
  constexpr const char* kGroup = "Look";
  for (const LookOption& option : look_options()) {
    std::vector<std::string>& texts = values[option.name];
    if (option.type.empty()) {
      command
          .add_flag_callback(
              "--" + option.name, [&texts] { texts = {"true"}; }, option.help)
          ->group(kGroup);
      continue;
    }
    command.add_option("--" + option.name, texts, option.help)
        ->type_name(option.type)
        ->type_size(1)
        ->expected(option.repeats ? CLI::detail::expected_max_vector_size : 1)
        ->allow_extra_args(false)
        ->group(kGroup);
  }
}

Result<ComparisonOptions> LookTexts::parse() const {
  ComparisonOptions options;
  for (const LookOption& option : look_options()) {
    for (const std::string& text : values.at(option.name)) {
      if (auto set = set_look(options, option, text); !set) {
        set.error().message.insert(0, "--");
        return tl::unexpected(set.error());
      }
    }
  }
  return options;
}

}  // namespace sweepscope::app
