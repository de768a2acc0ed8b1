#include "analysis/identification/identification.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

/// A log at the motor of what was driven in table units.
diagnosis::AxisLog AtTheMotor(const identify::Measured& record, double radius) {
  diagnosis::AxisLog log;
  log.period_s = record.period_s;
  log.present = record.present;
  for (std::size_t k = 0; k < record.size(); ++k) {
    log.command.push_back(record.force_N[k] * radius);
    log.position.push_back(record.position_m[k] / radius);
  }
  log.rows = record.size();
  return log;
}

/// What is stated of the plain axis: friction a fifth too low.
diagnosis::StatedAxis Stated() {
  const identify::TableAxis truth = Exactly(PlainAxis());
  const double r = truth.radius_m_rad;
  diagnosis::StatedAxis s;
  s.table_per_q = r;
  s.lead_m = truth.turn_m;
  s.two_inertia = s.friction_on_load = true;
  s.motor_inertia = truth.motor_inertia * r * r;
  s.load_inertia = truth.load_inertia * r * r;
  s.stiffness = truth.stiffness * r * r;
  s.damping = truth.damping * r * r;
  const diagnosis::StatedFriction& f = truth.friction;
  s.friction = {0.8 * f.Fc_plus * r,
                0.8 * f.Fc_minus * r,
                0.8 * f.Fs_plus * r,
                0.8 * f.Fs_minus * r,
                f.vs / r,
                1.0,
                f.s0 * r * r,
                f.s1 * r * r,
                f.vd / r,
                f.s2 * r * r};
  s.delay_s = truth.delay_s;
  s.lag_s = truth.lag_s;
  return s;
}

TEST(Identification, ARecordGoesToTableUnits) {
  diagnosis::AxisLog log;
  log.command = {2.0};
  log.position = {3.0};
  log.present = {1};
  identify::TableAxis axis;
  axis.radius_m_rad = 0.5;
  const identify::Measured m = identify::ToMeasured(log, axis, 0.1);
  EXPECT_DOUBLE_EQ(m.force_N[0], 4.0);
  EXPECT_DOUBLE_EQ(m.position_m[0], 1.5);
  EXPECT_DOUBLE_EQ(m.position_step_m, 0.05);
}

TEST(Identification, StepsFindFrictionAndSayWhatTheRecordDoesNotShow) {
  const double r = Exactly(PlainAxis()).radius_m_rad;
  identify::IdentifyOptions options;
  options.steps_only = true;
  const auto id = identify::Identify(Stated(), {AtTheMotor(SlidingRecord(), r)}, options);
  EXPECT_NEAR(id.fit.axis.friction.Fc_plus / 42.0, 1.0, 0.03);
  EXPECT_NEAR(id.fit.axis.friction.Fc_minus / 36.0, 1.0, 0.03);
  EXPECT_NEAR(id.stated.friction.Fc_plus, 0.8 * 42.0, 1e-6);
  EXPECT_FALSE(id.screw_identified);
  ASSERT_FALSE(id.notes.empty());
  EXPECT_NE(id.notes[0].find("chirp"), std::string::npos) << id.notes[0];
  // A step of the encoder is 5 mm over 2^20, a reading is off by its rounding and 0.3 steps.
  EXPECT_NEAR(id.encoder.step_m, 5e-3 / 1048576, 1e-12);
  EXPECT_NEAR(id.encoder.noise_m / id.encoder.step_m, std::sqrt(1.0 / 12 + 0.09), 0.1);
}

TEST(Identification, WithoutRecordsOrWithoutMotionItSaysSo) {
  EXPECT_THROW(identify::Identify(Stated(), {}, {}), std::runtime_error);
  diagnosis::AxisLog still;
  still.command.assign(3000, 0.0);
  still.position.assign(3000, 1.0);
  still.present.assign(3000, 1);
  try {
    identify::Identify(Stated(), {still}, {});
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("slide long enough"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace contour::test
