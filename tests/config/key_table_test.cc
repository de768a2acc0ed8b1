#include "config/key_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "config/key_hints.h"
#include "config/machine_config.h"

namespace contour {
namespace {

const KeyRow* Find(const std::vector<KeyRow>& rows, const std::string& key) {
  const auto it = std::find_if(rows.begin(), rows.end(), [&](const KeyRow& r) { return r.key == key; });
  return it == rows.end() ? nullptr : &*it;
}

TEST(KeyTable, ListsEveryKeyOfAMachineOnce) {
  const std::vector<KeyRow> rows = DescribeKeys<MachineConfig>();
  std::set<std::string> keys;
  for (const KeyRow& row : rows) {
    EXPECT_TRUE(keys.insert(row.key).second) << row.key << " twice";
    EXPECT_FALSE(row.text.empty()) << row.key;
  }
  EXPECT_TRUE(keys.contains("machine.cycle_us"));
  EXPECT_TRUE(keys.contains("buses.<name>.bitrate_bit_s"));
  EXPECT_TRUE(keys.contains("axes.<name>.model.lead_mm"));
  EXPECT_TRUE(keys.contains("io.modbus.inputs.screw_temperature.address"));
  EXPECT_FALSE(keys.contains("emulator"));
}

TEST(KeyTable, RowSaysTypeRangeDefaultAndText) {
  const std::vector<KeyRow> rows = DescribeKeys<MachineConfig>();
  const KeyRow* cycle = Find(rows, "machine.cycle_us");
  ASSERT_NE(cycle, nullptr);
  EXPECT_EQ(cycle->type, "whole number");
  EXPECT_EQ(cycle->range, "from 250 to 20000");
  EXPECT_EQ(cycle->value, "1000");
  const KeyRow* node = Find(rows, "axes.<name>.drive.node_id");
  ASSERT_NE(node, nullptr);
  EXPECT_EQ(node->value, "required");
  EXPECT_EQ(Find(rows, "realtime.send_deadline_us")->value, "none");
}

TEST(KeyTable, ListsTheKeysOfOtherVariants) {
  const std::vector<KeyRow> rows = DescribeKeys<FrictionConfig>("friction");
  ASSERT_NE(Find(rows, "friction.Fc_plus_N"), nullptr);
  ASSERT_NE(Find(rows, "friction.Fc_plus_Nm"), nullptr);
  EXPECT_EQ(Find(rows, "friction.Fc_plus_Nm")->only, "acts_on: motor");
  EXPECT_EQ(Find(rows, "friction.stribeck_exponent")->only, "");
}

TEST(KeyTable, TextLayout) {
  const std::vector<KeyRow> rows{{"a_mm", "number", "above 0", "2", "", "first"},
                                 {"long_key", "text", "", "required", "kind: b", "second"}};
  EXPECT_EQ(TextTable(rows),
            "KEY       UNIT  VALUE           DEFAULT   MEANING\n"
            "a_mm      mm    number above 0  2         first\n"
            "long_key        text            required  second (only with kind: b)\n");
}

TEST(KeyTable, MarkdownLayout) {
  const std::vector<KeyRow> rows{{"outer", "map", "", "required", "", "the outer map"},
                                 {"outer.<name>.inner", "map", "", "as below", "", "the inner map"},
                                 {"outer.<name>.inner.a_mm", "number", "above 0", "2", "", "first"},
                                 {"outer.<name>.late", "text", "", "required", "", "after the inner map"}};
  const std::string head = "| key | unit | value | default | meaning |\n|---|---|---|---|---|\n";
  EXPECT_EQ(MarkdownReference(rows), "## `outer`\n\nthe outer map (required)\n\n" + head +
                                         "| `<name>.late` |  | text | required | after the inner map |\n\n" +
                                         "## `outer.<name>.inner`\n\nthe inner map\n\n" + head +
                                         "| `a_mm` | mm | number above 0 | 2 | first |\n\n");
}

TEST(KeyHints, Units) {
  EXPECT_EQ(UnitText(SplitUnit("sigma0_N_m").unit), "N/m");
  EXPECT_EQ(UnitText(SplitUnit("sigma1_Ns_m").unit), "N s/m");
  EXPECT_EQ(UnitText(SplitUnit("acceleration_mm_s2").unit), "mm/s^2");
  EXPECT_EQ(UnitText(SplitUnit("motor_inertia_kgm2").unit), "kg m^2");
  EXPECT_EQ(UnitText(SplitUnit("torque_Nm").unit), "Nm");
  EXPECT_EQ(UnitText(SplitUnit("encoder_counts_per_rev").unit), "counts/rev");
  EXPECT_EQ(UnitText(SplitUnit("temperature_rate_1_K").unit), "1/K");
  EXPECT_EQ(UnitText(SplitUnit("degC_per_count").unit), "degC/count");
  EXPECT_EQ(UnitText(SplitUnit("counts_per_mm").unit), "counts/mm");
  EXPECT_EQ(UnitText(SplitUnit("seed").unit), "");
  EXPECT_EQ(UnitText(SplitUnit("priority").unit), "");
  EXPECT_EQ(UnitText(SplitUnit("order_per_rev").unit), "1/rev");
  // Of what has a unit after it, "per" belongs to the name.
  EXPECT_EQ(UnitText(SplitUnit("torque_per_acceleration_Nms2_m").unit), "Nm s^2/m");
  EXPECT_EQ(SplitUnit("torque_per_acceleration_Nms2_m").stem, "torque_per_acceleration");
  EXPECT_EQ(UnitText(SplitUnit("friction_per_torque_rel").unit), "");
}

TEST(KeyHints, OtherUnitBeforeSimilarName) {
  const std::vector<std::string> known{"velocity_mm_s", "velocity_noise_mm_s", "torque_Nm"};
  EXPECT_EQ(NearestKey("velocity_m_s", known).key, "velocity_mm_s");
  EXPECT_TRUE(NearestKey("velocity_m_s", known).other_unit);
  EXPECT_EQ(NearestKey("torqe_Nm", known).key, "torque_Nm");
  EXPECT_FALSE(NearestKey("torqe_Nm", known).other_unit);
  EXPECT_EQ(NearestKey("something_else", known).key, "");
}

}  // namespace
}  // namespace contour
