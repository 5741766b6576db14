#include "ui/explorer/exports.hpp"

namespace sweepscope::ui {
namespace {

constexpr const char* kExport = "export";

}  // namespace

void Exports::start(Export wanted) {
  background_.start(
      kExport, kExport, wanted.title,
      [this, write = std::move(wanted.write), done = std::move(wanted.done),
       file = std::move(wanted.file)](const Job& job) -> Background::Finish {
        const auto end = write(job);
        if (end) return [this, done, file] { written(file, done); };
        return [this, why = end.error()] {
          failure_ = why;
          messages_.error(why);
        };
      },
      std::move(wanted.steps));
}

void Exports::written(const std::filesystem::path& file, const std::string& message) const {
  messages_.note(message);
  if (wrote) wrote(file);
}

bool Exports::is_running() const {
  return background_.has(kExport);
}

}  // namespace sweepscope::ui
