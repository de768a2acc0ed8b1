#include "tools/plant_emulator/tampering.h"

#include <gtest/gtest.h>

namespace contour::plant {
namespace {

TEST(Tampering, WithoutItTheCountIsTheCount) {
  Tampering t;
  EXPECT_EQ(t.Read(-5), -5);
  EXPECT_EQ(t.Read(1'000'000'007), 1'000'000'007);
  EXPECT_EQ(t.torque_share(), 1.0);
}

TEST(Tampering, FreezesWhereItIsAndFlickers) {
  Tampering t;
  t.Read(100);
  t.Freeze();
  EXPECT_EQ(t.Read(150), 100);
  t.MendEncoder();
  EXPECT_EQ(t.Read(151), 151);
  t.Freeze(2);
  const std::int64_t a = t.Read(160);
  const std::int64_t b = t.Read(170);
  EXPECT_EQ(a + b, 151 + 153);
  EXPECT_NE(a, b);
}

TEST(Tampering, JumpsAndGoesOnFromThere) {
  Tampering t;
  t.Read(10);
  t.Jump(-7);
  EXPECT_EQ(t.Read(11), 4);
  EXPECT_EQ(t.Read(12), 5);
}

TEST(Tampering, RunsTheWrongWayFromHere) {
  Tampering t;
  t.Read(1000);
  t.Scale(-1.0);
  EXPECT_EQ(t.Read(1000), 1000);
  EXPECT_EQ(t.Read(1010), 990);
}

TEST(Tampering, ReportsTheTorqueThatIsThereOrTheCurrents) {
  Tampering t;
  t.WeakenTorque(0.0, true);
  EXPECT_EQ(t.torque_share(), 0.0);
  EXPECT_EQ(t.reported_share(), 0.0);
  t.WeakenTorque(0.5, false);
  EXPECT_EQ(t.torque_share(), 0.5);
  EXPECT_EQ(t.reported_share(), 1.0);
  t.MendTorque();
  EXPECT_EQ(t.torque_share(), 1.0);
}

}  // namespace
}  // namespace contour::plant
