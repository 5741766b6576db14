#include "render/page/page.hpp"

#include <fmt/format.h>

#include "render/page/html.hpp"
#include "render/page/page_files.hpp"

namespace sweepscope {
namespace {

/// A hash as a security policy names it.
std::string hash_source(std::string_view sha256_hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < sha256_hex.size(); i += 2)
    bytes += static_cast<char>(std::stoi(std::string(sha256_hex.substr(i, 2)), nullptr, 16));
  return "'sha256-" + html::base64(bytes) + "'";
}

std::string security_policy(bool with_scripts) {
  std::string policy = "default-src 'none'; img-src data:; base-uri 'none'; form-action 'none'; style-src " +
                       hash_source(page_style().sha256_hex);
  if (!with_scripts) return policy;
  policy += "; script-src";
  for (const PageFile& script : page_scripts()) policy += " " + hash_source(script.sha256_hex);
  return policy;
}

}  // namespace

std::string html_page(const std::string& title, const std::string& body, const std::string& live) {
  std::string scripts;
  if (!live.empty()) {
    scripts = live;
    for (const PageFile& script : page_scripts())
      scripts += fmt::format("<script>{}</script>\n", script.text);
  }
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}{}</body>\n</html>\n",
      security_policy(!live.empty()), html::escape(title), page_style().text, body, scripts);
}

}  // namespace sweepscope
