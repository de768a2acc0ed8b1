#include "analysis/diagnosis/report/extended_file.h"

#include <gtest/gtest.h>

#include "analysis/axis_model/read_stated_axis.h"
#include "config/load_machine.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

Cause Cogging(double amplitude_Nm) {
  Cause c;
  c.kind = "cogging";
  c.parameters["amplitude_Nm"] = {amplitude_Nm, 0, 1};
  c.parameters["order_per_rev"] = {12, 12, 12};
  c.parameters["phase_rad"] = {0.7, 0.6, 0.8};
  return c;
}

Diagnosis Found(std::vector<Cause> causes) {
  Diagnosis d;
  d.verdict = Verdict::kCauseFound;
  d.causes = std::move(causes);
  return d;
}

TEST(ExtendedFileTest, AMachineFileKeepsEveryLineAndComment) {
  const std::string file = ExampleMachine("xy_emulated.yaml");
  const std::string text = ExtendedFile(file, "x", Found({Cogging(0.0191)}), {});
  const std::string written = WriteTestFile("machine.yaml", text);
  const MachineConfig machine = LoadMachine(written);
  ASSERT_TRUE(machine.axes.at("x").model.extensions.cogging);
  EXPECT_DOUBLE_EQ(machine.axes.at("x").model.extensions.cogging->amplitude_Nm, 0.0191);
  EXPECT_FALSE(machine.axes.at("y").model.extensions.cogging);
  // Without the new block it is the old file.
  const std::size_t from = text.find("      extensions:");
  const std::size_t to = text.find("\n    loop:", from);
  ASSERT_NE(from, std::string::npos);
  ASSERT_NE(to, std::string::npos);
  std::string without = text;
  without.erase(from, to - from);
  without.erase(from - 1, 1);
  EXPECT_EQ(without, ReadText(file));

  // A second diagnosis replaces the block and keeps what it does not know anew.
  Cause offset;
  offset.kind = "constant_torque";
  offset.parameters["torque_Nm"] = {0.01, 0, 0.02};
  const MachineConfig again =
      LoadMachine(WriteTestFile("again.yaml", ExtendedFile(written, "x", Found({offset}), {})));
  EXPECT_TRUE(again.axes.at("x").model.extensions.cogging);
  EXPECT_DOUBLE_EQ(again.axes.at("x").model.extensions.constant_torque->torque_Nm, 0.01);
}

Cause PitchError(std::vector<double> position_mm, std::vector<double> error_um) {
  Cause c;
  c.kind = "pitch_error";
  c.parameters["amplitude_um"] = {1, 0, 2};
  c.shapes.push_back({"position_mm", "error_um", std::move(position_mm), std::move(error_um), {}});
  return c;
}

// A second diagnosis of a model that has an effect of the kind already adds to it.
TEST(ExtendedFileTest, SeveralOfOneKind) {
  Cause other = Cogging(0.005);
  other.parameters["order_per_rev"] = {24, 24, 24};
  Cause same = Cogging(0.01);
  same.parameters["phase_rad"] = {0.7 + 3.14159265358979, 0, 4};
  Cause ripple = Cogging(0.0);
  ripple.kind = "friction_ripple";
  ripple.parameters["amplitude_rel"] = {0.1, 0, 1};
  Cause offset;
  offset.kind = "constant_torque";
  offset.parameters["torque_Nm"] = {0.01, 0, 0.02};
  const Diagnosis first = Found({Cogging(0.0191), PitchError({-10, 0, 10}, {0, 1, 0}), offset, ripple});
  const Diagnosis second = Found({other, same, PitchError({-20, 0, 20}, {2, 0, 2}), offset});
  const std::string once =
      WriteTestFile("once.yaml", ExtendedFile(ExampleMachine("xy_emulated.yaml"), "x", first, {}));
  const std::string twice = WriteTestFile("twice.yaml", ExtendedFile(once, "x", second, {}));
  const ExtensionsConfig e = LoadMachine(twice).axes.at("x").model.extensions;
  ASSERT_TRUE(e.cogging);
  EXPECT_NEAR(e.cogging->amplitude_Nm, 0.0091, 1e-9);  // in opposite phase
  ASSERT_EQ(e.cogging->further.size(), 1u);
  EXPECT_DOUBLE_EQ(e.cogging->further[0].order_per_rev, 24);
  EXPECT_DOUBLE_EQ(e.cogging->further[0].amplitude_Nm, 0.005);
  EXPECT_TRUE(e.friction_ripple);
  EXPECT_DOUBLE_EQ(e.constant_torque->torque_Nm, 0.02);
  EXPECT_EQ(e.pitch_error->position_mm, (std::vector<double>{-20, -10, 0, 10, 20}));
  EXPECT_EQ(e.pitch_error->error_um, (std::vector<double>{2, 1, 1, 1, 2}));
  EXPECT_DOUBLE_EQ(e.pitch_error->amplitude_um, 0.5);

  // And diagnosis has all of it in its base.
  const StatedAxis stated = ReadStatedAxis(twice, "x");
  EXPECT_EQ(stated.extras.cogging.size(), 2u);
  EXPECT_EQ(stated.extras.friction_ripple.size(), 1u);
  EXPECT_DOUBLE_EQ(stated.extras.pitch_error_m.value.back(), 2e-6);
  EXPECT_DOUBLE_EQ(stated.offset, 0.02);
  EXPECT_TRUE(ReadStatedAxis(twice, "y").extras.cogging.empty());
}

TEST(ExtendedFileTest, AModelAloneAndItsTables) {
  const std::string file = WriteTestFile("model.yaml",
                                         "model:\n  motor_inertia_kgm2: 5e-5   # measured\n  lead_mm: 5\n"
                                         "  friction: {acts_on: motor, Fc_plus_Nm: 0.03, Fc_minus_Nm: 0.03, "
                                         "sigma2_Nms_rad: 1e-4}\ndrive: {delay_ms: 1}\n");
  Cause map;
  map.kind = "position_friction";
  map.parameters["amplitude_rel"] = {0.25, 0.2, 0.3};
  map.shapes.push_back({"position_mm", "friction_rel", {-10, 0, 10}, {-0.25, 0, 0.25}, {0.01, 0.01, 0.01}});
  const std::string text = ExtendedFile(file, "", Found({map}), {});
  EXPECT_NE(text.find("# measured"), std::string::npos);
  EXPECT_NE(text.find("position_mm: [-10, 0, 10]"), std::string::npos);
  EXPECT_LT(text.find("friction_rel"), text.find("drive:"));
  const StatedAxis stated = ReadStatedAxis(WriteTestFile("extended.yaml", text), "");
  EXPECT_EQ(stated.extras.friction_rel.value, (std::vector<double>{-0.25, 0, 0.25}));
  EXPECT_DOUBLE_EQ(stated.extras.friction_rel.position_m.front(), -0.01);
}

// The constant torque that a model states is a number of it, wherever it stands; what is found adds to it
// once.
TEST(ExtendedFileTest, AFittedConstantTorqueIsWrittenOnce) {
  Cause offset;
  offset.kind = "constant_torque";
  offset.parameters["torque_Nm"] = {0.01, 0, 0.02};
  const std::string alone =
      "model:\n  motor_inertia_kgm2: 5e-5\n  constant_torque_Nm: 0.02\n"
      "  friction: {Fc_plus_Nm: 0.03, Fc_minus_Nm: 0.03, sigma2_Nms_rad: 1e-4}\n"
      "  extensions: {constant_torque: {torque_Nm: 0.005}}\n";
  const std::string machine = WriteTestFile(
      "machine.yaml", ExtendedFile(ExampleMachine("xy_emulated.yaml"), "x", Found({offset}), {}));
  for (const std::string& file : {WriteTestFile("alone.yaml", alone), machine}) {
    const std::string axis = file == machine ? "x" : "";
    Diagnosis found = Found({offset});
    found.in_model = found.causes;
    found.fitted = ReadStatedAxis(file, axis);
    found.fitted->offset = 0.03;
    const StatedAxis again =
        ReadStatedAxis(WriteTestFile("again.yaml", ExtendedFile(file, axis, found, {})), axis);
    EXPECT_NEAR(again.offset, 0.04, 1e-9) << file;
  }
}

TEST(ExtendedFileTest, NothingToAddIsNoFile) {
  const std::string file = ExampleMachine("xy_emulated.yaml");
  EXPECT_EQ(ExtendedFile(file, "x", Found({}), {}), "");
  Cause backlash;
  backlash.kind = "backlash";
  EXPECT_EQ(ExtendedFile(file, "x", Found({backlash}), {}), "");
}

}  // namespace
}  // namespace contour::diagnosis
