// How far estimates lie from the truth, and how often within the sigma that they claim: over simulated
// recordings of differing scene, noise, encoder, sweep, offset, length and faults. One line per recording and
// a table per family.
//
//   sweepscope_calibration [--methods direct,paper] [--fit none|parabola] [--only FAMILY] [--stride N]
//   [--lines]
//
// Families marked `held out` were not looked at while sigma was tuned. A constant play between encoder and
// laser turns both directions as an offset of play / (2 omega) would: no recording at constant speed can tell
// them apart. Those families are counted against truth plus that shift, and marked `play`.
#include <fmt/format.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/offset/estimator.hpp"
#include "core/recording/sweeps.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/simulate.hpp"

namespace sweepscope {
namespace {

using simulation::Random;

// What is drawn for the i-th recording of a family.
struct Draw {
  Random random;
  double uniform(double from, double to) { return from + (to - from) * random.uniform(); }
  template <typename T>
  T one_of(std::initializer_list<T> values) {
    const auto i = std::min(values.size() - 1, std::size_t(random.uniform() * double(values.size())));
    return values.begin()[i];
  }
};

struct Family {
  const char* name;
  bool held_out;
  int recordings;
  std::function<void(Draw&, SimulationOptions&)> choose;
};

// What all families share: each recording has its own offset, encoder and phase.
SimulationOptions drawn(const Family& family, int number) {
  std::uint64_t seed = 1469598103934665603ull;
  for (const char* c = family.name; *c != 0; ++c) seed = (seed ^ std::uint64_t(*c)) * 1099511628211ull;
  Draw draw{Random(seed % 1000003, 77, std::uint64_t(number))};
  SimulationOptions options;
  options.seed = std::uint64_t(number) + 1 + seed % 9973;
  options.offset_s = draw.uniform(-0.045, 0.045);
  options.encoder_step_deg = draw.one_of({0.088, 0.01, 0.3});
  options.encoder_hz = draw.one_of({50.0, 100.0, 200.0});
  options.encoder_jitter_s = draw.one_of({0.0, 0.0005, 0.001});
  family.choose(draw, options);
  return options;
}

void stand(Draw& draw, SimulationOptions& options, std::initializer_list<const char*> rooms) {
  options.scene = draw.one_of(rooms);
  options.duration_s = draw.uniform(3, 8);
  options.sweep_s = draw.one_of({0.3, 0.413, 0.5, 0.513, 0.8, 1.2});
  options.noise_m = draw.one_of({0.005, 0.01, 0.02, 0.03});
}

void walk(Draw& draw, SimulationOptions& options, std::initializer_list<const char*> scenes) {
  options.scene = draw.one_of(scenes);
  options.duration_s = draw.uniform(20, 60);
  options.sweep_s = draw.one_of({0.413, 0.5, 0.513, 0.63});
  options.noise_m = draw.one_of({0.01, 0.02});
}

const std::vector<Family>& families() {
  static const auto rooms = {"room-1", "room-2", "room-3"}, other_rooms = {"room-4", "room-5", "room-6"};
  static const auto walks = {"metro-station", "parking-area"}, other_walks = {"cemetery", "lecture-room"};
  static const std::vector<Family> all{
      {"room 4 s, 10 mm, 1 Hz", false, 40,
       [](Draw& d, SimulationOptions& o) {
         stand(d, o, {"room-1", "room-2", "room-3", "room-4", "room-5", "room-6"});
         o.duration_s = 4, o.noise_m = 0.01, o.sweep_s = d.one_of({0.5, 0.513});
       }},
      {"room", false, 50, [](Draw& d, SimulationOptions& o) { stand(d, o, rooms); }},
      {"room, stamp jitter", false, 30,
       [](Draw& d, SimulationOptions& o) {
         stand(d, o, rooms);
         o.stamp_jitter_s = d.uniform(0.0002, 0.002);
       }},
      {"other rooms", true, 50, [](Draw& d, SimulationOptions& o) { stand(d, o, other_rooms); }},
      {"other rooms, other motors", true, 24,
       [](Draw& d, SimulationOptions& o) {
         stand(d, o, other_rooms);
         o.motor = d.one_of({simulation::MotorKind::kTriangle, simulation::MotorKind::kSine});
       }},
      {"other rooms, stamp jitter", true, 24,
       [](Draw& d, SimulationOptions& o) {
         stand(d, o, other_rooms);
         o.stamp_jitter_s = d.uniform(0.0002, 0.002);
       }},
      {"other rooms, mixed pixels", true, 20,
       [](Draw& d, SimulationOptions& o) {
         stand(d, o, other_rooms);
         o.mixed_pixels = d.uniform(0.2, 1);
       }},
      {"other rooms, grazing bias", true, 20,
       [](Draw& d, SimulationOptions& o) {
         stand(d, o, other_rooms);
         o.grazing_bias_m = d.uniform(-0.05, 0.05);
       }},
      {"other rooms, backlash (play)", true, 20,
       [](Draw& d, SimulationOptions& o) {
         stand(d, o, other_rooms);
         o.backlash_deg = d.uniform(0.02, 0.3);
       }},
      {"room, lost beams", false, 20,
       [](Draw& d, SimulationOptions& o) {
         stand(d, o, rooms);
         o.dropout = d.uniform(0.02, 0.5);
       }},
      {"room, sparse encoder", false, 24,
       [](Draw& d, SimulationOptions& o) {
         stand(d, o, rooms);
         o.motor = d.one_of({simulation::MotorKind::kTriangle, simulation::MotorKind::kTrapezoid,
                             simulation::MotorKind::kSine});
         o.encoder_hz = d.one_of({8.0, 10.0, 15.0, 20.0});
       }},
      {"walk", false, 20, [](Draw& d, SimulationOptions& o) { walk(d, o, walks); }},
      {"walk 60 s, 10 mm", false, 8,
       [](Draw& d, SimulationOptions& o) {
         walk(d, o, {"metro-station", "parking-area", "cemetery", "lecture-room"});
         o.duration_s = 60, o.noise_m = 0.01, o.sweep_s = d.one_of({0.5, 0.513});
       }},
      {"walk in step with the motor", false, 8,
       [](Draw& d, SimulationOptions& o) {
         walk(d, o, {"metro-station", "parking-area", "cemetery", "lecture-room"});
         o.sweep_s = d.uniform(0.54, 0.57);
       }},
      {"other walks", true, 16, [](Draw& d, SimulationOptions& o) { walk(d, o, other_walks); }},
      {"other walks, faults", true, 12, [](Draw& d, SimulationOptions& o) {
         walk(d, o, other_walks);
         o.stamp_jitter_s = d.one_of({0.0, 0.001});
         o.mixed_pixels = d.one_of({0.0, 0.5});
         o.grazing_bias_m = d.one_of({0.0, 0.03});
       }}};
  return all;
}

// One method on one recording.
struct Outcome {
  bool answered = false;
  double error_s = 0, sigma_s = 0;
  std::string reason;  // for no answer, or to doubt it
};

Outcome outcome_of(const Simulation& made, std::optional<Method> method, std::optional<Fit> fit) {
  EstimateOptions options;
  options.method = method;
  if (method != Method::kDirect) options.fit = fit;
  const Estimate found = estimate(made.recording, options, Job()).value();
  Outcome outcome;
  outcome.answered = found.identifiable;
  if (!found.identifiable) {
    outcome.reason = found.refusals.empty() ? "" : found.refusals.front().text;
    return outcome;
  }
  // Upwards the laser hangs back by half the play, as it would if it fired earlier.
  const double speed_rad_s = find_sweeps(made.recording.motor).median_speed_rad_s;
  const double play_s = made.options.backlash_deg * simulation::kPi / 180 / 2 / speed_rad_s;
  outcome.error_s = *found.offset_s - (made.options.offset_s - play_s);
  outcome.sigma_s = found.sigma_s.value_or(0);
  for (const std::string& warning : found.warnings)
    if (warning.find("depends on the motor's angle") != std::string::npos) outcome.reason = warning;
  return outcome;
}

double quantile_ms(std::vector<double> errors_s, double part) {
  if (errors_s.empty()) return 0;
  std::sort(errors_s.begin(), errors_s.end());
  return errors_s[std::min(errors_s.size() - 1, std::size_t(part * double(errors_s.size())))] * 1e3;
}

void print_row(const std::string& name, const std::vector<Outcome>& outcomes) {
  std::vector<double> errors_s;
  double one = 0, three = 0, answered = 0;
  for (const Outcome& outcome : outcomes) {
    if (!outcome.answered) continue;
    const double error_s = std::abs(outcome.error_s);
    errors_s.push_back(error_s);
    answered += 1;
    one += error_s < outcome.sigma_s;
    three += error_s < 3 * outcome.sigma_s;
  }
  const double percent = 100 / std::max(1.0, answered);
  fmt::print("{:<44} {:>4} {:>7} {:>8.3f} {:>8.3f} {:>8.3f} {:>7.0f} % {:>6.1f} %\n", name, outcomes.size(),
             outcomes.size() - errors_s.size(), quantile_ms(errors_s, 0.5), quantile_ms(errors_s, 0.95),
             quantile_ms(errors_s, 1), one * percent, three * percent);
}

struct Arguments {
  bool paper = false, lines = false;
  std::optional<Fit> fit;  // of the paper's methods; none: the default
  int stride = 1;
  std::string only;
};

using Table = std::map<std::string, std::vector<Outcome>>;

void run(const Family& family, const Arguments& arguments, Table& table) {
  std::map<std::string, std::vector<Outcome>> rows;
  for (int i = 0; i < family.recordings; i += arguments.stride) {
    const SimulationOptions options = drawn(family, i);
    const Simulation made = simulate(options, Job()).value();
    std::vector<std::pair<std::string, std::optional<Method>>> methods{{"direct", Method::kDirect}};
    if (arguments.paper) methods.emplace_back("paper", made.moving ? Method::kMoving : Method::kStationary);
    for (const auto& [name, method] : methods) {
      const Outcome outcome = outcome_of(made, method, arguments.fit);
      rows[name].push_back(outcome);
      if (arguments.lines)
        fmt::print(stderr,
                   "{} {} {}: {:.1f} s sweep {} noise {:.0f} mm step {} hz {} jit {:.1f} offset {:+.2f}: err "
                   "{:+.4f} sigma {:.4f} z {:+.2f} {}\n",
                   family.name, options.scene, name, *options.duration_s, options.sweep_s,
                   options.noise_m.value_or(options.scanner.noise_m) * 1e3, options.encoder_step_deg,
                   options.encoder_hz, options.stamp_jitter_s * 1e3, options.offset_s * 1e3,
                   outcome.error_s * 1e3, outcome.sigma_s * 1e3,
                   outcome.sigma_s > 0 ? outcome.error_s / outcome.sigma_s : 0, outcome.reason);
    }
  }
  for (const auto& [name, outcomes] : rows) {
    print_row(fmt::format("{}{}, {}", family.name, family.held_out ? " (held out)" : "", name), outcomes);
    for (const std::string& total :
         {"all, " + name, (family.held_out ? "all held out, " : "all tuned on, ") + name})
      table[total].insert(table[total].end(), outcomes.begin(), outcomes.end());
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace sweepscope

int main(int argc, char** argv) {
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  sweepscope::Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string name = argv[i];
    if (name == "--lines") arguments.lines = true;
    if (name == "--fit" && i + 1 < argc)
      arguments.fit =
          std::string(argv[++i]) == "parabola" ? sweepscope::Fit::kParabola : sweepscope::Fit::kNone;
    if (name == "--methods" && i + 1 < argc)
      arguments.paper = std::string(argv[++i]).find("paper") != std::string::npos;
    if (name == "--only" && i + 1 < argc) arguments.only = argv[++i];
    if (name == "--stride" && i + 1 < argc) {
      const std::string_view stride = argv[++i];
      std::from_chars(stride.data(), stride.data() + stride.size(), arguments.stride);
      arguments.stride = std::max(1, arguments.stride);
    }
  }
  fmt::print("{:<44} {:>4} {:>7} {:>8} {:>8} {:>8} {:>9} {:>8}\n", "family, method", "n", "refused", "median",
             "95 %", "most ms", "< 1 sigma", "< 3");
  sweepscope::Table table;
  for (const sweepscope::Family& family : sweepscope::families())
    if (std::string(family.name).find(arguments.only) != std::string::npos) run(family, arguments, table);
  for (const auto& [name, outcomes] : table) print_row(name, outcomes);
}
