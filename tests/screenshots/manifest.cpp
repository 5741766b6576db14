#include "tests/screenshots/manifest.hpp"

#include <charconv>

#include "core/io/yaml_members.hpp"

namespace sweepscope::screenshots {
namespace {

using YAML::Node;
using yaml::read_list, yaml::read_members, yaml::read_text, yaml::refuse;

constexpr std::uint64_t kMaxManifest_bytes = std::uint64_t{1} << 20;

Screenshot read_screenshot(const std::string& name, const Node& node) {
  Screenshot picture;
  read_members(node, name,
               {{"command", [&](const Node& v) { picture.command = read_text(v, name + ": command"); }},
                {"made", [&](const Node& v) { picture.made = read_text(v, name + ": made"); }},
                {"size", [&](const Node& v) {
                   const std::string size = read_text(v, name + ": size");
                   const char* const end = size.data() + size.size();
                   const auto [x, first] = std::from_chars(size.data(), end, picture.width_px);
                   const bool separated = first == std::errc() && x != end && *x == 'x';
                   const auto [after, second] = separated ? std::from_chars(x + 1, end, picture.height_px)
                                                          : std::from_chars_result{x, first};
                   if (!separated || second != std::errc() || after != end || picture.width_px < 1 ||
                       picture.height_px < 1) {
                     refuse(v, name + ": size needs WIDTHxHEIGHT, such as 800x500");
                   }
                 }}});
  if (picture.command.empty() == picture.made.empty()) refuse(node, name + " needs either command or made");
  if (picture.width_px == 0) refuse(node, name + " needs a size");
  const bool writes_out = picture.command.find("{out}") != std::string::npos;
  if (!picture.command.empty() && !writes_out) refuse(node, name + ": the command does not write {out}");
  return picture;
}

Control read_control(const std::string& name, const Node& node, const Manifest& manifest) {
  Control control;
  read_members(node, name,
               {{"of", [&](const Node& v) { control.of = read_text(v, name + ": of"); }},
                {"replace", [&](const Node& v) { control.replace = read_text(v, name + ": replace"); }},
                {"by", [&](const Node& v) { control.by = read_text(v, name + ": by"); }}});
  const auto picture = manifest.pictures.find(control.of);
  if (picture == manifest.pictures.end()) refuse(node, name + " is of no picture of this manifest");
  if (control.replace.empty() || picture->second.command.find(control.replace) == std::string::npos) {
    refuse(node, name + ": replace is not in the picture's command");
  }
  return control;
}

}  // namespace

Result<Manifest> read_manifest(const std::filesystem::path& path) {
  Manifest manifest;
  const auto read = [&](const Node& document) {
    Node pictures, controls;
    read_members(document, "the manifest",
                 {{"preparation",
                   [&](const Node& node) {
                     for (const Node& one : read_list(node)) {
                       manifest.preparation.push_back(read_text(one, "preparation"));
                     }
                   }},
                  {"other-files",
                   [&](const Node& node) {
                     for (const Node& one : read_list(node)) {
                       manifest.other_files.insert(read_text(one, "other-files"));
                     }
                   }},
                  {"pictures", [&](const Node& node) { pictures.reset(node); }},
                  {"controls", [&](const Node& node) { controls.reset(node); }}});
    yaml::for_each_entry(pictures, "pictures", [&](const std::string& name, const Node&, const Node& node) {
      manifest.pictures[name] = read_screenshot(name, node);
    });
    yaml::for_each_entry(controls, "controls", [&](const std::string& name, const Node&, const Node& node) {
      manifest.controls[name] = read_control(name, node, manifest);
    });
  };
  return yaml::read_file(path, "a manifest", kMaxManifest_bytes, read).map([&] {
    return std::move(manifest);
  });
}

}  // namespace sweepscope::screenshots
