#include "analysis/recording/table_rows.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace contour::diagnosis
