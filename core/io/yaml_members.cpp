#include "core/io/yaml_members.hpp"

#include <cmath>
#include <set>

#include "core/io/input_file.hpp"

namespace sweepscope::yaml {

void refuse(const YAML::Node& node, std::string what) {
  throw Refusal{node.Mark(), std::move(what)};
}

void for_each_entry(
    const YAML::Node& node, const std::string& name,
    const std::function<void(const std::string&, const YAML::Node&, const YAML::Node&)>& visit) {
  if (!node.IsMap()) refuse(node, fmt::format("{} must be a map of keys to values", name));
  std::set<std::string> seen;
  for (const auto& entry : node) {
    const auto key = entry.first.IsScalar() ? entry.first.Scalar() : std::string();
    if (key.empty()) refuse(entry.first, fmt::format("a key in {} must be a name", name));
    if (!seen.insert(key).second) refuse(entry.first, fmt::format("duplicate key \"{}\" in {}", key, name));
    visit(key, entry.first, entry.second);
  }
}

void read_members(const YAML::Node& node, const std::string& name, const Members& members) {
  for_each_entry(
      node, name, [&](const std::string& key, const YAML::Node& key_node, const YAML::Node& value) {
        const auto member = members.find(key);
        if (member == members.end()) {
          std::string known;
          for (const auto& [known_key, reader] : members) known += (known.empty() ? "" : ", ") + known_key;
          refuse(key_node, fmt::format("unknown key \"{}\" in {}; known are: {}", key, name, known));
        }
        member->second(value);
      });
}

double read_number(const YAML::Node& node, const std::string& name) {
  double number = NAN;
  if (!node.IsScalar() || !YAML::convert<double>::decode(node, number) || !std::isfinite(number)) {
    refuse(node, fmt::format("{} must be a finite number", name));
  }
  return number;
}

bool read_switch(const YAML::Node& node, const std::string& name) {
  bool value = false;
  if (!node.IsScalar() || !YAML::convert<bool>::decode(node, value)) {
    refuse(node, fmt::format("{} must be true or false", name));
  }
  return value;
}

std::string read_text(const YAML::Node& node, const std::string& name) {
  if (!node.IsScalar() || node.Scalar().empty()) refuse(node, fmt::format("{} must be text", name));
  return node.Scalar();
}

std::vector<YAML::Node> read_list(const YAML::Node& node) {
  if (!node.IsSequence()) return {node};
  return {node.begin(), node.end()};
}

Result<void> read_file(const std::filesystem::path& path, const std::string& kind, std::uint64_t max_bytes,
                       const std::function<void(const YAML::Node&)>& read) {
  auto file = InputFile::open(path);
  if (!file) return tl::unexpected(file.error());
  if (file->size() > max_bytes) {
    return unreadable(fmt::format("{}: has {} bytes, too many for {}", path.string(), file->size(), kind));
  }
  std::string text(file->size(), '\0');
  text.resize(file->read(std::as_writable_bytes(std::span(text))));
  return read_document(text, path.string(), read);
}

Result<void> read_document(const std::string& text, const std::string& name,
                           const std::function<void(const YAML::Node&)>& read) {
  const auto at = [&](const YAML::Mark& mark, const std::string& what) {
    return unreadable(fmt::format("{}:{}:{}: {}", name, mark.line + 1, mark.column + 1, what));
  };
  try {
    read(YAML::Load(text));
    return {};
  } catch (const Refusal& refusal) {
    return at(refusal.mark, refusal.what);
  } catch (const YAML::Exception& error) {
    return at(error.mark, error.msg);
  }
}

}  // namespace sweepscope::yaml
