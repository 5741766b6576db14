#include "ui/explorer/running_estimate.hpp"

#include "core/offset/estimator.hpp"
#include "core/offset/prepared/search_window.hpp"
#include "ui/jobs/task_plans.hpp"
#include "ui/state/value.hpp"

namespace sweepscope::ui {
namespace {

constexpr const char* kEstimate = "estimate";

}  // namespace

EstimateOptions estimate_asked_for(const Settings& settings, std::optional<RigKind> assume) {
  EstimateOptions options;
  options.assume = assume;
  // Commands take no other values than these options do.
  (void)find_estimate_option("solve")->set(options, settings.solve_for);
  (void)find_estimate_option("prior")->set(options, settings.prior());
  if (settings.search == Search::kOverTime)
    (void)find_estimate_option("over-time")
        ->set(options, settings.window_s < 1 ? std::string() : to_word(Value(settings.window_s)));
  if (settings.method != "automatic") (void)find_estimate_option("method")->set(options, settings.method);
  if (settings.fit != "automatic") (void)find_estimate_option("fit")->set(options, settings.fit);
  if (settings.search == Search::kRange) {
    options.ranges = {
        {settings.search_from_ms * 1e-3, settings.search_to_ms * 1e-3, settings.search_step_ms * 1e-3}};
  }
  return options;
}

void RunningEstimate::start(LoadedPtr loaded, const EstimateOptions& options) {
  background_.cancel(kEstimate);
  constexpr double kNear = 4;  // times the half-width of the default search
  growing_ = options.ranges.empty()
                 ? std::make_shared<GrowingCurve>(kNear * search_scale(loaded->prepared.motor).half_width_s)
                 : std::make_shared<GrowingCurve>();
  background_.start(
      kEstimate, kEstimate, "Estimating the offset",
      [this, options, loaded = std::move(loaded), growing = growing_](const Job& job) -> Background::Finish {
        EstimateOptions along = options;
        along.walk = loaded->walk->get();
        const KeptCandidates candidates{
            nullptr,
            {},
            {[growing] { growing->begin(); }, [growing](const CurvePoint& p) { growing->add(p); }}};
        auto found = std::make_shared<Result<Estimate>>(
            sweepscope::estimate(loaded->prepared, along, candidates, job));
        if (*found && (*found)->walk) loaded->walk->keep((*found)->walk);
        return [this, found] {
          if (!*found) return messages_.error(found->error());
          estimate_ = std::move(**found);
          found_(true);
        };
      },
      steps_of_estimating());
}

bool RunningEstimate::is_running() const {
  return background_.has(kEstimate);
}

void RunningEstimate::set(Estimate estimate) {
  background_.cancel(kEstimate);
  estimate_ = std::move(estimate);
  found_(false);
}

void RunningEstimate::restore(std::optional<Estimate> estimate) {
  background_.cancel(kEstimate);
  estimate_ = std::move(estimate);
  growing_.reset();
  so_far_.reset();
}

void RunningEstimate::update() {
  if (!is_running()) growing_.reset();
  if (!growing_) so_far_.reset();
  if (!growing_ || growing_->size() < 2) return;
  if (!so_far_ || so_far_->curve.size() != growing_->size()) so_far_ = growing_->so_far();
}

}  // namespace sweepscope::ui
