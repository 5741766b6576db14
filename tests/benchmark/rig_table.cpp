// How well `estimate --solve` finds a rig: simulated stationary recordings whose mount, gear and
// encoder are wrong by amounts drawn at random, always beginning with the default rig. One line per
// recording, and two per family, for the scenes that were tuned on and for those held out: medians and 95th
// percentiles of the errors, and of each parameter how many errors lie within three sigmas. Then, of rigs
// that nothing is solved for, how many `estimate` warns of: none of the perfect ones should be, and of the
// others all.
//
//   rig_table [--recordings N] [--only FAMILY] [--walks FOLDER] [--noise-mm X] [--duration-s X] [--limit 1]
//
// With --limit one more line per family and kind of scene has what range noise and the unevenness of the
// surfaces leave of each parameter by themselves, from the information of the surfaces about the rig found.
//
// FOLDER holds house.ply and office.ply, which are used beside the project's own scenes where it is given.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/numbers.hpp"
#include "core/offset/estimator.hpp"
#include "core/results/rig_json.hpp"
#include "core/rig_solve/rig_check.hpp"
#include "core/rig_solve/rig_least_squares.hpp"
#include "core/rig_solve/rig_solve.hpp"
#include "core/simulation/math/portable_math.hpp"
#include "core/simulation/simulate.hpp"
#include "tests/scene_mesh.hpp"
#include "tests/scratch_folder.hpp"

namespace sweepscope {
namespace {

using simulation::Random;

struct Settings {
  int recordings = 12;
  double noise_mm = 10, duration_s = 8;
  std::string only, walks;
  int limit = 0;
};

struct Draw {
  Random random;
  double uniform(double from, double to) { return from + (to - from) * random.uniform(); }
};

struct Family {
  const char* name;
  simulation::MotorKind motor;
  RigSolve solve;
  double mount_deg, mount_m, play_deg, encoder_deg;  // at most
  bool faults;
  bool at_most = false;  // all are as large as they may be
};

const std::vector<Family>& families() {
  using simulation::MotorKind;
  constexpr RigSolve kEverything{.mount = true, .play = true, .encoder = true};
  static const std::vector<Family> all{
      {"mount, triangle", MotorKind::kTriangle, {.mount = true}, 9.9, 0.2, 0, 0, false},
      {"mount, sine", MotorKind::kSine, {.mount = true}, 9.9, 0.2, 0, 0, false},
      {"mount, trapezoid, faults", MotorKind::kTrapezoid, {.mount = true}, 3, 0.05, 0, 0, true},
      {"encoder, trapezoid", MotorKind::kTrapezoid, {.encoder = true}, 0, 0, 0, 0.5, false},
      {"play, sine", MotorKind::kSine, {.play = true}, 0, 0, 0.5, 0, false},
      {"play, triangle", MotorKind::kTriangle, {.play = true}, 0, 0, 0.5, 0, false},
      {"all, sine", MotorKind::kSine, kEverything, 5, 0.1, 0.5, 0.5, false},
      {"everything, triangle", MotorKind::kTriangle, kEverything, 3, 0.05, 0.5, 0.5, true},
      {"everything, trapezoid", MotorKind::kTrapezoid, kEverything, 3, 0.05, 0.5, 0.5, true},
      {"everything, sine", MotorKind::kSine, kEverything, 3, 0.05, 0.5, 0.5, true},
      {"perfect", MotorKind::kTrapezoid, {}, 0, 0, 0, 0, false},
      {"perfect, sine", MotorKind::kSine, {}, 0, 0, 0, 0, false},
      {"mount 1 deg", MotorKind::kTrapezoid, {}, 1, 0, 0, 0, false, true},
      {"encoder 0.2 deg", MotorKind::kTrapezoid, {}, 0, 0, 0, 0.2, false, true},
      {"mount, eccentric", MotorKind::kSine, {.mount = true}, 5, 0.1, 0, 0.3, false}};
  return all;
}

double size(Draw& draw, const Family& family, double most) {
  return draw.uniform(family.at_most ? 1 : 0.1, 1) * most;
}

Eigen::Vector3d across_x(Draw& draw, double size) {
  const double angle_rad = draw.uniform(0, 2 * std::numbers::pi);
  return {0, size * std::cos(angle_rad), size * std::sin(angle_rad)};
}

// Where a rig stands. The rooms have a place each; in the other scenes it is turned about the vertical at
// random.
struct StandingScene {
  const char* name;
  std::vector<Eigen::Vector3d> places_m;
};

constexpr std::size_t kFromFolder = 2;  // the last scenes, whose meshes are in --walks

const std::vector<StandingScene>& standing_scenes() {
  static const std::vector<StandingScene> scenes{
      {"room-1", {}},
      {"room-2", {}},
      {"room-3", {}},
      {"room-4", {}},
      {"room-5", {}},
      {"room-6", {}},
      {"metro-station", {{0.4, -4.4, 1.5}, {3.5, 0.6, 1.5}}},
      {"parking-area", {{1.3, 6, 1.5}}},
      {"cemetery", {{2.4, -1, 1.5}}},
      {"lecture-room", {{1.9, 2.4, 1.5}}},
      {"house", {{-6, -4, 1.35}, {3, 0, 1.35}, {6, -2.5, 1.35}}},
      {"office", {{0, -1, 0.2}, {-1.5, 1, 0.2}}},
  };
  return scenes;
}

std::filesystem::path mesh_of(const std::string& scene, const std::filesystem::path& walks) {
  static const test::ScratchFolder folder;
  if (exists(walks / (scene + ".ply"))) return walks / (scene + ".ply");
  const std::filesystem::path mesh = folder.path() / (scene + ".ply");
  if (!exists(mesh)) test::write_scene_mesh(scene, mesh);
  return mesh;
}

SimulationOptions drawn(const Family& family, int number, const Settings& settings) {
  Draw draw{Random(9176, std::uint64_t(&family - families().data()), std::uint64_t(number))};
  SimulationOptions options;
  options.duration_s = settings.duration_s;
  options.noise_m = settings.noise_mm * 1e-3;
  options.seed = std::uint64_t(number) + 1;
  options.motor = family.motor;
  options.offset_s = draw.uniform(-0.04, 0.04);
  options.mount_error_deg = across_x(draw, size(draw, family, family.mount_deg));
  options.mount_error_m = across_x(draw, size(draw, family, family.mount_m));
  options.backlash_deg = family.play_deg > 0 ? draw.uniform(0.1, family.play_deg) : 0;
  options.eccentricity_deg = size(draw, family, family.encoder_deg);
  options.eccentricity_phase_deg = draw.uniform(-180, 180);
  if (family.faults) {
    options.grazing_bias_m = 0.01;
    options.stamp_jitter_s = 0.0005;
    options.people = 2;
    options.mixed_pixels = 0.1;
    options.uneven_motor = 0.03;
  }
  const auto& scenes = standing_scenes();
  const std::size_t used = settings.walks.empty() ? scenes.size() - kFromFolder : scenes.size();
  const StandingScene& scene = scenes[std::size_t(number) % used];
  options.scene = scene.name;
  if (scene.places_m.empty()) return options;
  options.own.mesh = mesh_of(scene.name, settings.walks);
  options.own.placement.at_m = scene.places_m[std::size_t(number) / used % scene.places_m.size()];
  options.own.placement.yaw_deg = draw.uniform(-180, 180);
  return options;
}

// Rooms 4 to 6 and the meshes: nothing was tuned on them.
bool held_out(const SimulationOptions& options) {
  return !options.own.mesh.empty() || options.scene > "room-3";
}

// The errors of one parameter.
struct Errors {
  std::vector<double> sizes;
  int within = 0;  // three sigmas

  void add(double size, double in_sigmas) {
    sizes.push_back(size);
    within += in_sigmas <= 3 ? 1 : 0;
  }
};

struct Table {
  Errors offset_ms, turn_deg, shift_mm, play_deg, encoder_deg;
  int refused = 0, encoder_shown = 0;  // without being solved for
};

// Sizes in units of their sigma; a vector counts by its greatest part.
double in_sigmas(const Eigen::Vector3d& error, const Eigen::Vector3d& sigma) {
  double most = 0;
  for (int i = 0; i < 3; ++i)
    if (sigma[i] > 1e-12) most = std::max(most, std::abs(error[i]) / sigma[i]);
  return most;
}

void compare(const SimulationOptions& truth, const Estimate& found, Table& table) {
  const double offset_ms = std::abs(*found.offset_s - truth.offset_s) * 1e3;
  table.offset_ms.add(offset_ms, offset_ms / (*found.sigma_s * 1e3));
  const SolvedRig& rig = *found.rig;
  std::string line =
      fmt::format("offset {:.3f} ms {:.1f} sigma", offset_ms, offset_ms / (*found.sigma_s * 1e3));
  const auto add = [&line](Errors& errors, const char* name, double size, const char* unit, double sigmas) {
    errors.add(size, sigmas);
    line += fmt::format(", {} {:.4f} {} {:.1f} sigma", name, size, unit, sigmas);
  };
  if (rig.mount.identifiable) {
    const MountSigma sigma = mount_sigma(rig);
    const Eigen::Vector3d turn_deg = rig.rig.mount.laser_in_motor_rpy_deg - truth.mount_error_deg,
                          shift_m = rig.rig.mount.laser_in_motor_xyz_m - truth.mount_error_m;
    add(table.turn_deg, "turn", turn_deg.norm(), "deg", in_sigmas(turn_deg, sigma.rpy_deg));
    add(table.shift_mm, "shift", shift_m.norm() * 1e3, "mm", in_sigmas(shift_m, sigma.xyz_m));
  }
  if (rig.play.identifiable) {
    const double off_deg = std::abs(rig.rig.gear.play_deg - truth.backlash_deg);
    add(table.play_deg, "play", off_deg, "deg",
        off_deg * kRadPerDeg / std::sqrt(rig.covariance(kPlay, kPlay)));
  }
  if (rig.encoder.identifiable) {
    const Eigen::Vector2d off_rad =
        rig.rig.gear.angles().encoder_rad -
        Rig::Gear{0, truth.eccentricity_deg, truth.eccentricity_phase_deg}.angles().encoder_rad;
    double sigmas = 0;
    for (int i = 0; i < 2; ++i)
      sigmas = std::max(sigmas,
                        std::abs(off_rad[i]) / std::sqrt(rig.covariance(kEncoderSine + i, kEncoderSine + i)));
    add(table.encoder_deg, "encoder", off_rad.norm() * kDegPerRad, "deg", sigmas);
  }
  const bool encoder_shown = !rig.encoder.solved && !rig.encoder.reason.empty();
  table.encoder_shown += encoder_shown ? 1 : 0;
  if (encoder_shown) line += ", encoder shown";
  fmt::print("{}; {:.1f} CPU-s; {:.2f} mm thick, {} surfaces, {} points; {}\n", line, found.cpu_s,
             rig.residual_after_m * 1e3, rig.surfaces, rig.points,
             rig.converged ? "converged" : "not converged");
}

std::string summary(Errors errors, const char* name, int digits) {
  if (errors.sizes.empty()) return "";
  return fmt::format("; {} {:.{}f} / {:.{}f} ({} of {})", name, quantile(errors.sizes, 0.5), digits,
                     quantile(errors.sizes, 0.95), digits, errors.within, errors.sizes.size());
}

// The standard deviations that noise and unevenness leave.
struct Limits {
  std::vector<double> turn_deg, shift_mm, play_deg, encoder_deg;
};

void add_limit(const Recording& recording, const RigSolve& solve, const RigUnknowns& found, Limits& limits) {
  const auto prepared = prepare(recording, {}, Job());
  const OffsetProblem problem = problem_for(*prepared, found.offset_s, found.offset_s);
  const RigFit fit = solve_rig_planes({&problem, 1}, found, priors_of(solve), {}, Job());
  std::vector<int> unknowns;
  for (int i = 0; i < kRigUnknowns; ++i)
    if (priors_of(solve)[i] > 0) unknowns.push_back(i);
  const Eigen::MatrixXd information = fit.information(unknowns, unknowns);
  const Eigen::MatrixXd covariance = points_per_independent(problem.feature_options) * information.inverse();
  const auto sigma = [&](int first_unknown, int count) {
    double sum = 0;
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      if (unknowns[i] >= first_unknown && unknowns[i] < first_unknown + count)
        sum += covariance(Eigen::Index(i), Eigen::Index(i));
    return std::sqrt(sum);
  };
  if (solve.mount) limits.turn_deg.push_back(sigma(kTurnU, 2) * kDegPerRad);
  if (solve.mount) limits.shift_mm.push_back(sigma(kShiftU, 2) * 1e3);
  if (solve.play) limits.play_deg.push_back(sigma(kPlay, 1) * kDegPerRad);
  if (solve.encoder) limits.encoder_deg.push_back(sigma(kEncoderSine, 2) * kDegPerRad);
}

void print(const Family& family, const char* scenes, const Limits& limits) {
  std::string line;
  const auto add = [&](const char* name, std::vector<double> values, int digits) {
    if (!values.empty())
      line += fmt::format("; {} {:.{}f} / {:.{}f}", name, quantile(values, 0.5), digits,
                          quantile(values, 0.95), digits);
  };
  add("turn deg", limits.turn_deg, 4);
  add("shift mm", limits.shift_mm, 2);
  add("play deg", limits.play_deg, 4);
  add("encoder deg", limits.encoder_deg, 4);
  if (!line.empty())
    fmt::print("== {:22} {:8} noise and unevenness leave +-, median / 95 %{}\n", family.name, scenes, line);
}

void print(const Family& family, const char* scenes, const Table& table) {
  const std::size_t answered = table.offset_ms.sizes.size();
  if (answered + std::size_t(table.refused) == 0) return;
  fmt::print(
      "== {:22} {:8} {} answered, {} refused, {} with an encoder shown; median / 95 % (within 3 "
      "sigma){}{}{}{}{}\n",
      family.name, scenes, answered, table.refused, table.encoder_shown,
      summary(table.offset_ms, "offset ms", 3), summary(table.turn_deg, "turn deg", 4),
      summary(table.shift_mm, "shift mm", 2), summary(table.play_deg, "play deg", 4),
      summary(table.encoder_deg, "encoder deg", 4));
}

void run_check(const Family& family, const Settings& settings) {
  int warned = 0, checked = 0;
  std::vector<double> mount, encoder;
  for (int i = 0; i < settings.recordings; ++i) {
    const SimulationOptions options = drawn(family, i, settings);
    const auto simulation = simulate(options, Job());
    if (!simulation) continue;
    const auto prepared = prepare(simulation->recording, {}, Job());
    const double at_s = options.offset_s;
    const RigCheck check = check_rig(problem_for(*prepared, at_s, at_s), at_s, Job());
    ++checked;
    warned += check.warning ? 1 : 0;
    mount.push_back(check.mount_evidence);
    encoder.push_back(check.encoder_evidence);
  }
  if (checked == 0) return;
  const auto range = [](std::vector<double> values) {
    return fmt::format("{:.0f} / {:.0f} / {:.0f}", quantile(values, 0), quantile(values, 0.5),
                       quantile(values, 1));
  };
  fmt::print("== {:24} {} of {} warned of; evidence, least / median / most: mount {}; encoder {}\n",
             family.name, warned, checked, range(mount), range(encoder));
}

void run(const Family& family, const Settings& settings) {
  Table tuned, others;
  std::map<std::string, Limits> limits;  // by the kind of scene
  for (int i = 0; i < settings.recordings; ++i) {
    const SimulationOptions options = drawn(family, i, settings);
    const auto simulation = simulate(options, Job());
    if (!simulation) {
      fmt::print("{}\n", simulation.error().message);
      continue;
    }
    EstimateOptions estimate_options;
    estimate_options.solve = family.solve;
    const auto found = estimate(simulation->recording, estimate_options, Job());
    fmt::print("{:22} {:2} {:8} ", family.name, i, options.scene);
    Table& table = held_out(options) ? others : tuned;
    if (found && found->identifiable && found->rig) {
      compare(options, *found, table);
      if (settings.limit)
        add_limit(simulation->recording, family.solve, found->rig->found,
                  limits[options.own.mesh.empty() ? "rooms" : options.scene]);
      continue;
    }
    ++table.refused;
    fmt::print("refused: {}\n", found && !found->reasons().empty() ? found->reasons().front() : "");
  }
  print(family, "tuned on", tuned);
  print(family, "held out", others);
  for (const auto& [scenes, of_scenes] : limits) print(family, scenes.c_str(), of_scenes);
}

}  // namespace
}  // namespace sweepscope

int main(int argc, char** argv) {
  sweepscope::Settings settings;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string_view name = argv[i], value = argv[i + 1];
    const auto read = [&](auto& number) {
      std::from_chars(value.data(), value.data() + value.size(), number);
    };
    if (name == "--recordings") read(settings.recordings);
    if (name == "--noise-mm") read(settings.noise_mm);
    if (name == "--duration-s") read(settings.duration_s);
    if (name == "--limit") read(settings.limit);
    if (name == "--only") settings.only = value;
    if (name == "--walks") settings.walks = value;
  }
  for (const auto& family : sweepscope::families())
    if (std::string_view(family.name).find(settings.only) != std::string_view::npos)
      (family.solve.any() ? sweepscope::run : sweepscope::run_check)(family, settings);
}
