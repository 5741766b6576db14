#include "tests/screenshots/failure_page.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <set>
#include <string>

#include "core/io/atomic_file.hpp"
#include "core/io/printable_text.hpp"

namespace sweepscope::screenshots {
namespace {

constexpr const char* kHead =
    "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}</title>\n<style>\n"
    "body {{ font-family: sans-serif; margin: 1.5em; background: #fff; color: #222 }}\n"
    "div {{ display: flex; flex-wrap: wrap; gap: 1em }}\n"
    "figure {{ margin: 0; flex: 1 1 420px }}\n"
    "img {{ width: 100%; border: 1px solid #888; image-rendering: pixelated }}\n"
    "pre {{ white-space: pre-wrap; background: #f2f2f2; padding: .7em }}\n"
    "</style></head><body>\n<h1>{0}</h1>\n";

/// Held while it lives; other processes wait.
class FolderLock {
 public:
  explicit FolderLock(const std::filesystem::path& folder)
      : file_(open((folder / ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644)) {
    if (file_ >= 0) flock(file_, LOCK_EX);
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock() {
    if (file_ >= 0) close(file_);
  }

 private:
  int file_;
};

}  // namespace

Result<void> write_failure_page(const std::filesystem::path& folder, const Failure& failure) {
  std::string page = fmt::format(kHead, markup_escaped(failure.name));
  page += fmt::format("<pre>{}</pre>\n<div>\n", markup_escaped(failure.score));
  for (const char* picture : {"actual", "expected", "difference"}) {
    if (!std::filesystem::exists(folder / fmt::format("{}.png", picture))) continue;
    page += fmt::format(
        "<figure><figcaption>{0}</figcaption><a href=\"{0}.png\"><img src=\"{0}.png\" "
        "alt=\"{0}\"></a></figure>\n",
        picture);
  }
  page += fmt::format("</div>\n<pre>{}</pre>\n<pre>{}</pre>\n</body></html>\n",
                      markup_escaped("sweepscope " + failure.command), markup_escaped(failure.facts));
  return write_file(folder / "index.html", page)
      .and_then([&] { return write_file(folder / "facts.txt", failure.facts); })
      .and_then([&] { return write_file(folder / "score.txt", failure.score + "\n"); });
}

Result<void> write_failure_index(const std::filesystem::path& folder) {
  const FolderLock lock(folder);
  std::set<std::string> failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (std::filesystem::exists(entry.path() / "score.txt")) failed.insert(entry.path().filename().string());
  }
  std::string page = fmt::format(kHead, fmt::format("Screenshots: {} failed", failed.size()));
  for (const std::string& name : failed) {
    page += fmt::format("<p><a href=\"{0}/index.html\">{0}</a>: {1}</p>\n", markup_escaped(name),
                        markup_escaped(read_file(folder / name / "score.txt").value_or("")));
  }
  return write_file(folder / "index.html", page + "</body></html>\n");
}

}  // namespace sweepscope::screenshots
