// A recorded emulated machine whose viscous friction differs between the directions.

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "analysis/diagnosis/diagnose.h"
#include "tools/validation/hidden/draw_setting.h"
#include "tools/validation/hidden/hide_effect.h"
#include "tools/validation/hidden/record_case.h"

namespace contour::hidden {
namespace {

constexpr double kDifference = 0.4;

class AsymmetricViscous : public testing::Test {
 protected:
  AsymmetricViscous()
      : directory_(std::filesystem::temp_directory_path() /
                   ("asymmetric_viscous." + std::to_string(getpid()))) {
    std::filesystem::create_directories(directory_);
  }
  ~AsymmetricViscous() override { std::filesystem::remove_all(directory_); }

  /// `stood_in`: of the difference that a constant torque of the model stands for, as least squares without
  /// the other have it.
  diagnosis::Diagnosis DiagnosisAt(double difference_rel, double stood_in = 0.0) {
    const std::string kind = "asymmetric_viscous";
    const Setting setting = DrawSetting(11, {kind}, Misfit::kNone, Length::kShort);
    Hidden hidden = DrawEffect(11, kind, setting);
    hidden.size = difference_rel;
    Record(setting, {hidden}, directory_);
    Recorded recorded = ReadRecorded(directory_);
    const std::vector<double>& q = recorded.log.position;
    double travel = 0.0;
    for (std::size_t k = 1; k < q.size(); ++k) travel += std::fabs(q[k] - q[k - 1]);
    const double mean_speed = travel / (static_cast<double>(q.size()) * recorded.log.period_s);
    recorded.stated.offset = -stood_in * 0.5 * difference_rel * recorded.stated.friction.s2 * mean_speed;
    return diagnosis::Diagnose(recorded.log, recorded.stated, {});
  }

  std::filesystem::path directory_;
};

TEST_F(AsymmetricViscous, IsNamedWithItsSize) {
  const diagnosis::Diagnosis found = DiagnosisAt(kDifference);
  ASSERT_FALSE(found.causes.empty());
  const diagnosis::Cause& cause = found.causes[0];
  EXPECT_EQ(cause.kind, "asymmetric_viscous");
  EXPECT_EQ(found.causes.size(), 1u);
  const diagnosis::Interval size = cause.parameters.at("difference_rel");
  EXPECT_LE(size.low, kDifference);
  EXPECT_GE(size.high, kDifference);
  EXPECT_GT(cause.heldout_gain_low, 0.0);
  EXPECT_FALSE(cause.deciding_experiment.empty());
}

TEST_F(AsymmetricViscous, IsNamedWhereTheModelHasAConstantTorqueInItsPlace) {
  const diagnosis::Diagnosis found = DiagnosisAt(-0.5 * kDifference, 1.0);
  ASSERT_FALSE(found.causes.empty());
  EXPECT_EQ(found.causes[0].kind, "asymmetric_viscous");
  EXPECT_EQ(found.causes.size(), 1u);
  ASSERT_TRUE(found.fitted);
  const diagnosis::Interval size = found.causes[0].parameters.at("difference_rel");
  EXPECT_LE(size.low, -0.5 * kDifference);
  EXPECT_GE(size.high, -0.5 * kDifference);
}

TEST_F(AsymmetricViscous, IsNotNamedWhereThereIsNone) {
  for (const diagnosis::Cause& cause : DiagnosisAt(0.0).causes) EXPECT_NE(cause.kind, "asymmetric_viscous");
}

}  // namespace
}  // namespace contour::hidden
