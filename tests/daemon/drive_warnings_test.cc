#include "daemon/drive_warnings.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace contour {
namespace {

TEST(DriveWarnings, NameTheAxisWhoseDriveWarns) {
  CycleRecord record;
  record.axes.resize(2);
  const std::vector<std::string> names = {"x", "y"};
  record.axes[0].feedback.statusword = record.axes[1].feedback.statusword = 0x1237;
  EXPECT_TRUE(DriveWarnings(record, names).empty());
  record.axes[1].feedback.statusword |= 0x0080;
  const std::vector<std::string> told = DriveWarnings(record, names);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_EQ(told[0].rfind("axis y: its drive warns", 0), 0U) << told[0];
}

}  // namespace
}  // namespace contour
