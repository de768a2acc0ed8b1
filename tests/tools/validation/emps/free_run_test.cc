#include "tools/validation/emps/free_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "tools/validation/emps/fit_free_run.h"
#include "tools/validation/emps/inverse_dynamics.h"
#include "tools/validation/emps/models.h"

namespace contour::emps {
namespace {

/// A made-up recording: the model itself on a force that goes back and forth.
Recording MadeUp(const Parameters& p, std::size_t rows) {
  Recording r;
  r.filtered_m.assign(1, 0.05);
  r.velocity_m_s.assign(1, 0.0);
  for (std::size_t k = 0; k < rows; ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    r.time_s.push_back(t);
    r.force_N.push_back(45.0 * std::sin(2.0 * t) + 15.0 * std::sin(13.0 * t));
  }
  r.position_m = FreeRun(p, r, 0, rows);
  r.filtered_m = r.position_m;
  r.velocity_m_s.assign(rows, 0.0);
  for (std::size_t k = 1; k + 1 < rows; ++k)
    r.velocity_m_s[k] = 500.0 * (r.position_m[k + 1] - r.position_m[k - 1]);
  return r;
}

TEST(EmpsTest, AFreeRunUnderConstantForceIsTheTextbooks) {
  Parameters p = AuthorsAsymmetric();
  Recording r;
  r.filtered_m.assign(2000, 0.1);
  r.velocity_m_s.assign(2000, 0.0);
  r.force_N.assign(2000, 80.0);
  const std::vector<double> x = FreeRun(p, r, 0, 2000);
  const double v_end = (80.0 - p.Fc_plus_N) / p.Fv_plus_Ns_m;
  const double tau = p.mass_kg / p.Fv_plus_Ns_m;
  const double t = 1.9;
  EXPECT_NEAR(x[1900], 0.1 + v_end * (t - tau * (1.0 - std::exp(-t / tau))), 1e-4);
}

TEST(EmpsTest, AFitFindsTheParametersOfAMadeUpRecording) {
  Parameters truth = AuthorsAsymmetric();
  truth.x1 = 0.05;
  const Recording r = MadeUp(truth, 8000);
  Parameters start = AuthorsSymmetric();
  start.offset_N = 0.0;
  const Parameters found = FitFreeRun(start, StrokeTerms(), r, {100, 8000}, 1000);
  EXPECT_NEAR(found.mass_kg, truth.mass_kg, 0.5);
  EXPECT_NEAR(found.Fv_plus_Ns_m, truth.Fv_plus_Ns_m, 3.0);
  EXPECT_NEAR(found.Fv_minus_Ns_m, truth.Fv_minus_Ns_m, 3.0);
  EXPECT_NEAR(found.Fc_plus_N, truth.Fc_plus_N, 0.3);
  EXPECT_LT(FreeRunRmse_m(found, r, {100, 8000}), 0.05 * FreeRunRmse_m(start, r, {100, 8000}));
}

/// The published scores of the published models; only where the recordings are.
TEST(EmpsTest, ThePublishedModelsScoreWhatIsPublished) {
  const char* directory = std::getenv("CONTOUR_EMPS");
  if (directory == nullptr) GTEST_SKIP() << "CONTOUR_EMPS names no directory with the recordings";
  const Recording train = ReadRecording(std::string(directory) + "/emps_train.csv", "train");
  const Recording pulses = ReadRecording(std::string(directory) + "/emps_pulses.csv", "pulses");
  const ScoredModel symmetric = Score("", AuthorsSymmetric(), train, pulses);
  const ScoredModel asymmetric = Score("", AuthorsAsymmetric(), train, pulses);
  EXPECT_NEAR(1e6 * symmetric.second_m, 1787.0, 1.0);
  EXPECT_NEAR(1e6 * symmetric.pulses_m, 2171.0, 1.0);
  EXPECT_NEAR(1e6 * asymmetric.second_m, 418.0, 1.0);
  EXPECT_NEAR(1e6 * asymmetric.pulses_m, 1535.0, 1.0);
  Parameters p = FitFreeRun(AuthorsAsymmetric(), DirectionTerms(), train, kFirstHalf, kFitWindow);
  p = FitFreeRun(p, StrokeTerms(), train, kFirstHalf, kFitWindow);
  const ScoredModel fitted = Score("", p, train, pulses);
  EXPECT_LE(1e6 * fitted.second_m, 420.0);
  EXPECT_LE(1e6 * fitted.pulses_m, 1350.0);
}

}  // namespace
}  // namespace contour::emps
