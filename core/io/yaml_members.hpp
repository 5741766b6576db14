#pragma once

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "core/io/atomic_file.hpp"

namespace sweepscope::yaml {

/// An invalid value in a file. Thrown by the readers below and caught by read_file, which adds the
/// file's name, the line and the column.
struct Refusal {
  YAML::Mark mark;
  std::string what;
};

[[noreturn]] void refuse(const YAML::Node& node, std::string what);

using Members = std::map<std::string, std::function<void(const YAML::Node&)>>;

/// Calls the reader of every key in `node`; an unknown or duplicate key is refused. `name` describes the node
/// in messages.
void read_members(const YAML::Node& node, const std::string& name, const Members& members);

/// The keys and values of a map whose keys the user chooses; duplicate and empty keys are refused.
void for_each_entry(const YAML::Node& node, const std::string& name,
                    const std::function<void(const std::string& key, const YAML::Node& key_node,
                                             const YAML::Node& value)>& visit);

double read_number(const YAML::Node& node, const std::string& name);
bool read_switch(const YAML::Node& node, const std::string& name);
std::string read_text(const YAML::Node& node, const std::string& name);

/// The elements of a sequence, or a single value in place of a sequence of one.
std::vector<YAML::Node> read_list(const YAML::Node& node);

template <typename T>
T read_choice(const YAML::Node& node, const std::string& name, const std::map<std::string, T>& choices) {
  const auto choice = node.IsScalar() ? choices.find(node.Scalar()) : choices.end();
  if (choice != choices.end()) return choice->second;
  std::string known;
  for (const auto& [text, value] : choices) known += (known.empty() ? "" : ", ") + text;
  refuse(node, fmt::format("{} must be one of: {}", name, known));
}

/// Hands the file's document to `read`; `kind` is what it should be: "a rig file". Every failure is
/// ExitCode::kUnreadableInput with a sentence that names the file, the line and the column.
Result<void> read_file(const std::filesystem::path& path, const std::string& kind, std::uint64_t max_bytes,
                       const std::function<void(const YAML::Node&)>& read);
/// The same for a text; `name` is that of the file in messages.
Result<void> read_document(const std::string& text, const std::string& name,
                           const std::function<void(const YAML::Node&)>& read);

}  // namespace sweepscope::yaml
