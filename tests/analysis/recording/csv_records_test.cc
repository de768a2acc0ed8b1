#include "analysis/recording/csv_records.h"

#include <gtest/gtest.h>

namespace contour::diagnosis {
namespace {

TEST(CsvRecords, PassesCommentsAndKeepsTheLast) {
  const std::string file = "t.csv";
  CsvRecords records(file, "# one\n%% t u\n\n1 2\n", 0, 1);
  EXPECT_EQ(TrimmedField(records.Peek()), "1 2");
  EXPECT_EQ(TrimmedField(records.comment()), "t u");
  EXPECT_EQ(records.line(), 4U);
}

TEST(CsvRecords, ABlankStandsForAnyRunOfThem) {
  const std::string file = "t.csv";
  CsvRecords records(file, "  1 \t 2   3 \r\n", 0, 1);
  std::vector<std::string_view> fields;
  Unquoted unquoted;
  records.Take(' ', fields, unquoted);
  EXPECT_EQ(fields, (std::vector<std::string_view>{"1", "2", "3"}));
}

}  // namespace
}  // namespace contour::diagnosis
