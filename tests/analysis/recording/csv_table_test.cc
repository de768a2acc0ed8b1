#include "analysis/recording/csv_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config/config_error.h"
#include "tests/config/test_files.h"

namespace contour::diagnosis {
namespace {

using Rows = std::vector<std::vector<std::string>>;

Rows RowsOf(const CsvTable& table, std::vector<std::size_t>* lines = nullptr) {
  Rows rows;
  table.ForEachRow([&](std::size_t line, const std::vector<std::string_view>& fields) {
    rows.emplace_back(fields.begin(), fields.end());
    if (lines != nullptr) lines->push_back(line);
  });
  return rows;
}

std::string Error(const std::string& text) {
  try {
    RowsOf(CsvTable(WriteTestFile("t.csv", text)));
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "";
}

TEST(CsvTable, HeaderAndRowsWithTheirLines) {
  const CsvTable table(
      WriteTestFile("t.csv", "\xEF\xBB\xBF# made by hand\n\n a , b\r\n1,2\r\n# more\n\n3 ,\t4\n"));
  EXPECT_EQ(table.header(), (std::vector<std::string>{"a", "b"}));
  std::vector<std::size_t> lines;
  EXPECT_EQ(RowsOf(table, &lines), (Rows{{"1", "2"}, {"3", "4"}}));
  EXPECT_EQ(lines, (std::vector<std::size_t>{4, 7}));
}

TEST(CsvTable, SemicolonsSeparateWhereTheHeaderHasNoComma) {
  EXPECT_EQ(RowsOf(CsvTable(WriteTestFile("t.csv", "a;b\n1,5;2\n"))), (Rows{{"1,5", "2"}}));
  EXPECT_EQ(RowsOf(CsvTable(WriteTestFile("t.csv", "a,b;c\n1,2\n"))), (Rows{{"1", "2"}}));
  // A comma inside quotes separates nothing.
  EXPECT_EQ(CsvTable(WriteTestFile("t.csv", "\"a,b\";c\n")).header(), (std::vector<std::string>{"a,b", "c"}));
}

TEST(CsvTable, QuotedFieldsHoldSeparatorsQuotesAndLineEnds) {
  const CsvTable table(WriteTestFile(
      "t.csv", "\"force, N\",note\n1,\"x, y\"\n\"2\" , \"he said \"\"no\"\"\"\n3,\"two\nlines\"\n4,\"\"\n"));
  EXPECT_EQ(table.header()[0], "force, N");
  std::vector<std::size_t> lines;
  EXPECT_EQ(RowsOf(table, &lines),
            (Rows{{"1", "x, y"}, {"2", "he said \"no\""}, {"3", "two\nlines"}, {"4", ""}}));
  EXPECT_EQ(lines, (std::vector<std::size_t>{2, 3, 4, 6}));
}

TEST(CsvTable, AQuoteInsideAFieldIsALetter) {
  EXPECT_EQ(RowsOf(CsvTable(WriteTestFile("t.csv", "a,b\n5\" tube,1\n"))), (Rows{{"5\" tube", "1"}}));
}

TEST(CsvTable, ErrorsNameTheLine) {
  EXPECT_NE(Error("a,b\n1,2\n1,2,3\n").find("t.csv:3: found 3 fields, expected 2"), std::string::npos);
  EXPECT_NE(Error("a,b\n1,2\n1,\"2\n3,4\n").find("t.csv:3: a field begins with a quote"), std::string::npos);
  EXPECT_NE(Error("a,b\n\"1\"x,2\n").find("t.csv:2: found 'x' behind a quoted field"), std::string::npos);
  EXPECT_NE(Error("# nothing\n\n").find("is empty"), std::string::npos);
  EXPECT_THROW(CsvTable("/nowhere.csv"), ConfigError);
}

TEST(CsvTable, LinesMayEndInACarriageReturnAlone) {
  const CsvTable t(WriteTestFile("t.csv", "a,b\r1,2\r3,4\r"));
  EXPECT_EQ(t.header(), (std::vector<std::string>{"a", "b"}));
}

TEST(CsvTable, WhatIsNoPlainTextIsSaidToBeNone) {
  EXPECT_NE(Error(std::string("\xFF\xFE"
                              "a\0,\0",
                              6))
                .find("UTF-16"),
            std::string::npos);
  EXPECT_NE(Error(std::string("a,b\n1,\0\n", 9)).find("is no text"), std::string::npos);
}

TEST(NumberOf, TakesNumbersAndNothingElse) {
  EXPECT_DOUBLE_EQ(NumberOf("-1.5e3", "f", 1, "c"), -1500.0);
  EXPECT_DOUBLE_EQ(NumberOf("+2", "f", 1, "c"), 2.0);
  for (const char* none : {"", "nan", "NaN", "NA"})
    EXPECT_TRUE(std::isnan(NumberOf(none, "f", 1, "c"))) << none;
  for (const char* wrong : {"1,5", "x", "1 2", "inf", "1e999"})
    EXPECT_THROW(NumberOf(wrong, "f", 7, "c"), ConfigError) << wrong;
}

std::vector<double> Numbers(const CsvTable& table) {
  std::vector<double> out;
  table.ForEachRow([&](std::size_t line, const std::vector<std::string_view>& fields) {
    for (std::size_t i = 0; i < fields.size(); ++i) out.push_back(table.Number(fields[i], line, i));
  });
  return out;
}

TEST(CsvTable, DecimalCommasBetweenSemicolonsTabsOrBlanks) {
  for (const char* text :
       {"t;u\n0,5;-1,25e1\n1;2\n", "t\tu\n0,5\t-1,25e1\n1\t2\n", " t  u \n 0,5   -1,25e1 \n1 2\n"}) {
    const CsvTable table(WriteTestFile("t.csv", text));
    EXPECT_EQ(table.header(), (std::vector<std::string>{"t", "u"})) << text;
    EXPECT_EQ(Numbers(table), (std::vector<double>{0.5, -12.5, 1, 2})) << text;
  }
}

TEST(CsvTable, WithoutAHeaderColumnsHaveTheirNumbers) {
  const CsvTable table(WriteTestFile("t.csv", "% a recorder's\n0,1.5,2\n1,,3\n"));
  EXPECT_EQ(table.header(), (std::vector<std::string>{"1", "2", "3"}));
  EXPECT_EQ(RowsOf(table).size(), 2U);
  EXPECT_EQ(RowsOf(CsvTable(WriteTestFile("t.csv", "0,5;1,5\n1;2\n"))).size(), 2U);
}

TEST(CsvTable, ACommentMayBeTheHeader) {
  const CsvTable table(WriteTestFile("t.csv", "# recorded by hand\n# t, q, u\n0,1.5,2\n1,2,3\n"));
  EXPECT_EQ(table.header(), (std::vector<std::string>{"t", "q", "u"}));
}

TEST(CsvTable, ALineOfUnitsIsNoRow) {
  const CsvTable table(WriteTestFile("t.csv", "t,q\ns,rad\n0,1\n1,2\n"));
  EXPECT_EQ(Numbers(table), (std::vector<double>{0, 1, 1, 2}));
  // Two lines without numbers before none at all are a table that is wrong.
  EXPECT_EQ(RowsOf(CsvTable(WriteTestFile("t.csv", "t,q\ns,rad\nx,y\n"))).size(), 2U);
}

}  // namespace
}  // namespace contour::diagnosis
