#include "core/rig_solve/rig_agreement.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

namespace sweepscope {
namespace {

// The information of a recording about the unknowns in common, and its weighted sum with others.
struct Information {
  Eigen::MatrixXd of;
  Eigen::VectorXd times_x;

  Information& operator+=(const Information& other) {
    of += other.of;
    times_x += other.times_x;
    return *this;
  }
  Eigen::VectorXd mean() const { return of.ldlt().solve(times_x); }
};

RigEvidence evidence_of(const OffsetProblem& problem, const RigUnknowns& all, const RigUnknowns& before,
                        const RigPriors& priors, const Job& job) {
  RigEvidence evidence;
  const RigRecordings alone{&problem, 1};
  const RigFit fit =
      with_scatter(alone, solve_rig_planes(alone, all, priors, near_the_solution(), job), priors, job);
  evidence.converged = nearly_converged(fit);
  evidence.found = fit.rig;
  evidence.covariance = fit.covariance;
  ResidualGridOptions grid;
  grid.loss_width_m = RigLeastSquaresOptions().loss_width_m(fit.residual_m);
  const RigResiduals residuals = rig_residuals(problem, before, all, grid);
  evidence.residual_before_m = residuals.before_m;
  evidence.residual_after_m = residuals.after_m;
  return evidence;
}

// The unknowns that are compared.
std::vector<int> common_unknowns(const RigPriors& priors, bool own_offsets) {
  std::vector<int> unknowns;
  for (int i = own_offsets ? kOffset + 1 : kOffset; i < kRigUnknowns; ++i)
    if (priors[i] > 0) unknowns.push_back(i);
  return unknowns;
}

Information information_of(const RigEvidence& evidence, const std::vector<int>& unknowns) {
  const Eigen::MatrixXd covariance = evidence.covariance(unknowns, unknowns);
  const auto n = Eigen::Index(unknowns.size());
  Information information{covariance.ldlt().solve(Eigen::MatrixXd::Identity(n, n)), {}};
  information.times_x = information.of * evidence.found.vector()(unknowns);
  return information;
}

Information sum_of(const std::vector<Information>& each, const std::vector<char>& counts) {
  const auto n = each[0].times_x.size();
  Information sum{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  for (std::size_t i = 0; i < each.size(); ++i)
    if (counts[i]) sum += each[i];
  return sum;
}

// The squared distances of the recordings from the mean of those that count.
double chi_square_of(const std::vector<Information>& each, const std::vector<char>& counts) {
  const Eigen::VectorXd mean = sum_of(each, counts).mean();
  double chi_square = 0;
  for (std::size_t i = 0; i < each.size(); ++i) {
    if (!counts[i]) continue;
    const Eigen::VectorXd apart = each[i].mean() - mean;
    chi_square += apart.dot(each[i].of * apart);
  }
  return chi_square;
}

// How far a recording lies from the mean of the others, with the uncertainty of both.
void set_apart(RigEvidence& evidence, const Information& own, const Information& others,
               const std::vector<int>& unknowns) {
  const Eigen::VectorXd apart = own.mean() - others.mean();
  RigVector x = RigVector::Zero();
  x(unknowns) = apart;
  evidence.apart = RigUnknowns::from(x);
}

void compare(RigAgreement& agreement, const std::vector<int>& unknowns) {
  std::vector<Information> each;
  std::vector<char> counts;
  for (const RigEvidence& evidence : agreement.recordings) {
    each.push_back(information_of(evidence, unknowns));
    counts.push_back(evidence.converged ? 1 : 0);
  }
  const auto counted = std::ranges::count(counts, 1);
  if (counted < 2 || unknowns.empty()) return;
  agreement.chi_square = chi_square_of(each, counts);
  agreement.degrees_of_freedom = int(unknowns.size()) * int(counted - 1);
  double min_without = agreement.chi_square;
  for (std::size_t i = 0; i < each.size(); ++i) {
    if (!counts[i]) continue;
    std::vector<char> others = counts;
    others[i] = 0;
    set_apart(agreement.recordings[i], each[i], sum_of(each, others), unknowns);
    const double without = chi_square_of(each, others);
    if (counted < 3 || without >= min_without) continue;
    min_without = without;
    agreement.odd_one = i;
  }
}

}  // namespace

RigAgreement agreement_of(RigRecordings recordings, const SolvedRig& solved, const Job& job) {
  RigAgreement agreement;
  RigPriors priors = solved.priors;
  if (!solved.play.identifiable) priors[kPlay] = 0;
  for (std::size_t i = 0; i < recordings.size() && !job.cancelled(); ++i)
    agreement.recordings.push_back(
        evidence_of(recordings[i], solved.found.of_recording(i), solved.before.of_recording(i), priors, job));
  if (!job.cancelled()) compare(agreement, common_unknowns(priors, !solved.found.apart_s.empty()));
  return agreement;
}

}  // namespace sweepscope
