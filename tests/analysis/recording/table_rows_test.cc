#include "analysis/recording/table_rows.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "config/config_error.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

TEST(TableRows, FactorsAndATimeOfTheirOwn) {
  const CsvTable table(WriteTestFile("t.csv", "u,q\n1,10\n2,20\n"));
  const LogColumns columns =
      FindColumns("t.csv", table.header(), "", ParseColumnNames("force_N=u*-2,position_m=q*0.001"), true);
  const TableRows rows = ReadTableRows(table, columns, 100.0);
  EXPECT_EQ(rows.command, (std::vector<double>{-2.0, -4.0}));
  EXPECT_DOUBLE_EQ(rows.position[1], 0.02);
  EXPECT_DOUBLE_EQ(rows.time_s[1], 0.01);
}

TEST(TableRows, ADateIsNoTimeAndSaysWhatIs) {
  const CsvTable table(WriteTestFile("t.csv", "time_s,u,q\n2026-11-28T10:00:00.001,1,10\n"));
  const LogColumns columns =
      FindColumns("t.csv", table.header(), "", ParseColumnNames("force_N=u,position_m=q"), false);
  try {
    ReadTableRows(table, columns, 0.0);
    ADD_FAILURE() << "read";
  } catch (const ConfigError& e) {
    const std::string what = e.what();
    EXPECT_NE(what.find(":2: time_s: found '2026-11-28T10:00:00.001'"), std::string::npos) << what;
    EXPECT_NE(what.find("--sample-rate HZ"), std::string::npos) << what;
  }
}

}  // namespace
}  // namespace contour::diagnosis
