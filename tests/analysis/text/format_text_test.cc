#include "analysis/text/format_text.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

TEST(FormatText, IsWhatPrintfWouldPrint) {
  EXPECT_EQ(FormatText("%s: %.2f of %d", "x", 1.005e1, 7), "x: 10.05 of 7");
}

TEST(FormatText, IsNeverCutOff) {
  const std::string text = FormatText("%5000d", 42);
  EXPECT_EQ(text.size(), 5000U);
  EXPECT_EQ(text.substr(4997), " 42");
}

TEST(FormatText, OfNothingIsNothing) { EXPECT_EQ(FormatText("%s", ""), ""); }

}  // namespace
}  // namespace contour
