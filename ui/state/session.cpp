#include "ui/state/session.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/io/printable_text.hpp"
#include "core/results/estimate_json.hpp"
#include "ui/state/command.hpp"

namespace sweepscope::ui {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSchema = "sweepscope.session/1";

Json to_json(const Value& value) {
  return std::visit([](const auto& held) { return Json(held); }, value);
}

std::string word_of(const Json& json) {
  if (json.is_boolean()) return json.get<bool>() ? "on" : "off";
  if (json.is_number()) return ui::to_word(Value(json.get<double>()));
  return json.is_string() ? json.get<std::string>() : json.dump();
}

Result<void> read_field(const Command& command, const Json& json, Settings& settings) {
  const Json array = json.is_array() ? json : Json::array({json});
  Call call{&command, {}};
  if (array.size() != command.parameters.size())
    return unreadable(fmt::format("it holds {} values", array.size()));
  for (std::size_t i = 0; i < array.size(); ++i) {
    auto value = parse_value(command.parameters[i], word_of(array[i]));
    if (!value) return unreadable(value.error().message);
    call.values.push_back(std::move(*value));
  }
  settings = changed(settings, call);
  return {};
}

}  // namespace

std::string session_to_json(const Session& session) {
  Json settings = Json::object();
  for (const Command& command : setting_commands()) {
    if (!command.is_field()) continue;
    const auto values = command.get(session.settings);
    Json& field = settings[command.name];
    if (values.size() == 1) {
      field = to_json(values[0]);
    } else {
      for (const Value& value : values) field.push_back(to_json(value));
    }
  }
  Json json{{"schema", kSchema}, {"source", session.source}};
  if (Json reading = to_json(session.reading); !reading.is_null()) json["reading"] = std::move(reading);
  json["settings"] = std::move(settings);
  if (session.estimate) json["estimate"] = Json::parse(estimate_to_json(*session.estimate, Timing::kNull));
  return json_text(std::move(json));
}

Result<Session> parse_session(std::string_view text, std::string_view name) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return unreadable(fmt::format("{}: not a session: it is no JSON object", name));
  if (json.value("schema", Json()) != kSchema)
    return unreadable(fmt::format("{}: not a session of schema {}", name, kSchema));
  Session session;
  if (const auto source = json.find("source"); source != json.end() && source->is_string())
    session.source = source->get<std::string>();
  if (const auto reading = json.find("reading"); reading != json.end()) {
    auto read = reading_from_json(*reading, std::string(name));
    if (!read) return tl::unexpected(read.error());
    session.reading = std::move(*read);
  }
  const Json settings = json.value("settings", Json::object());
  if (!settings.is_object()) return unreadable(fmt::format("{}: settings: not a JSON object", name));
  for (const Command& command : setting_commands()) {
    if (!command.is_field() || !settings.contains(command.name)) continue;
    const auto read = read_field(command, settings[command.name], session.settings);
    if (!read)
      return unreadable(fmt::format("{}: settings.{}: {}", name, command.name, read.error().message));
  }
  if (json.contains("estimate") && json["estimate"].is_object()) {
    auto estimate = parse_estimate_json(json["estimate"].dump(), name);
    if (!estimate) return tl::unexpected(estimate.error());
    session.estimate = std::move(*estimate);
  }
  return session;
}

}  // namespace sweepscope::ui
