#include "analysis/identification/result_files.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "config/load_machine.h"
#include "tests/config/test_files.h"

namespace contour::identify {
namespace {

/// Friction and the mass of an axis with a lead of 2 pi mm were found.
Identification Found() {
  Identification id;
  TableAxis& axis = id.fit.axis;
  axis.two_inertia = axis.friction_on_load = true;
  axis.radius_m_rad = 1e-3;
  axis.motor_inertia = 50.0;
  axis.load_inertia = 10.0;
  axis.stiffness = 40e6;
  axis.damping = 1100.0;
  axis.friction = {41.23456, 36.0, 52.0, 47.0, 2e-3, 1.0, 5e6, 3000.0, 2e-3, 500.0};
  axis.delay_s = 1e-3;
  axis.lag_s = 2e-4;
  axis.variation.high_m = 0.02;
  id.fit.parameters = {{"motor_inertia_kgm2", 50.0, 0.01, true},
                       {"Fc_plus_N", 41.23456, 0.02, true},
                       {"lag_s", 2e-4, 1e-6, false}};
  id.seconds = 12.0;
  id.stated = axis;
  return id;
}

TEST(ResultFiles, TheModelHasWhatWasFoundWithItsUncertainty) {
  ModelConfig stated;
  stated.friction.acts_on = FrictionSide::kTable;
  stated.uncertainty["sigma0_N_m"] = 0.2;
  const ModelConfig model = ToModel(Found(), stated);
  EXPECT_DOUBLE_EQ(model.mechanics.motor_inertia_kgm2, 5e-5);
  EXPECT_DOUBLE_EQ(model.friction.Fc_plus_N, 41.235);
  EXPECT_DOUBLE_EQ(model.uncertainty.at("Fc_plus_N"), 0.02);
  EXPECT_DOUBLE_EQ(model.uncertainty.at("sigma0_N_m"), 0.2);
  EXPECT_FALSE(model.uncertainty.contains("lag_s"));
  // Only the sum of the masses was seen: the table is known no better than the motor.
  EXPECT_DOUBLE_EQ(model.uncertainty.at("table_mass_kg"), 0.01);
}

TEST(ResultFiles, UncertaintyOfFrictionAtTheMotorHasTheMotorsKeys) {
  ModelConfig stated;
  stated.friction.acts_on = FrictionSide::kMotor;
  const ModelConfig model = ToModel(Found(), stated);
  EXPECT_TRUE(model.uncertainty.contains("Fc_plus_Nm"));
  EXPECT_FALSE(model.uncertainty.contains("Fc_plus_N"));
}

TEST(ResultFiles, TheModelFileSaysWhereItComesFromAndReadsBack) {
  ModelConfig stated = LoadMachine(ExampleMachine("xy_emulated.yaml")).axes.at("x").model;
  Identification id = Found();
  id.notes = {"no linear scale"};
  const ModelConfig model = ToModel(id, stated);
  const std::string file = WriteTestFile("model.yaml", "");
  WriteModelFile(file, model, id, {"run1.log"});
  const std::string text = ReadText(file);
  for (const char* part :
       {"run1.log", "12 s of record", "delay 1.000 ms", "lag 0.200 ms", "# Note: no linear scale"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
  EXPECT_DOUBLE_EQ(LoadModel(file).friction.Fc_plus_N, 41.235);
}

TEST(ResultFiles, TheJsonHasEveryParameter) {
  const std::string file = WriteTestFile("identification.json", "");
  WriteIdentificationJson(file, Found(), {"run1.log"});
  const auto json = nlohmann::json::parse(std::ifstream(file));
  EXPECT_DOUBLE_EQ(json.at("parameters").at("Fc_plus_N").at("sigma").get<double>(), 0.02);
  EXPECT_DOUBLE_EQ(json.at("identified").at("mass_kg").get<double>(), 60.0);
  EXPECT_THROW(WriteIdentificationJson("/nowhere/at/all.json", Found(), {}), std::runtime_error);
}

TEST(ResultFiles, TheTableSetsBeforeBesideAfter) {
  ModelConfig before;
  before.friction.acts_on = FrictionSide::kTable;
  before.friction.Fc_plus_N = 30.0;
  const std::string table = ResultTable(Found(), before, ToModel(Found(), before));
  EXPECT_NE(table.find("Fc_plus_N"), std::string::npos) << table;
  EXPECT_NE(table.find("41.2"), std::string::npos) << table;
  EXPECT_NE(table.find("30"), std::string::npos) << table;
}

}  // namespace
}  // namespace contour::identify
