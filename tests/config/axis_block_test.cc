#include "config/axis_block.h"

#include <gtest/gtest.h>

#include "config/config_error.h"

namespace contour {
namespace {

const std::string kFile =
    "# a machine\n"
    "axes:\n"
    "  x:\n"
    "    drive: {bus: main}   # its drive\n"
    "    limits:\n"
    "      torque_Nm: 1\n"
    "\n"
    "  # the other\n"
    "  y:\n"
    "    drive: {bus: main}\n"
    "    loop:\n"
    "      regulator_Hz: 1\n"
    "      notch_ratio: 2\n"
    "    model: y.yaml\n"
    "control: {}\n";

TEST(WithAxisBlock, PutsAKeyAtTheEndOfTheAxis) {
  EXPECT_EQ(WithAxisBlock(kFile, "f", "x", "loop", "regulator_Hz: 20\nbias_Hz: 5\n"),
            "# a machine\n"
            "axes:\n"
            "  x:\n"
            "    drive: {bus: main}   # its drive\n"
            "    limits:\n"
            "      torque_Nm: 1\n"
            "    loop:\n"
            "      regulator_Hz: 20\n"
            "      bias_Hz: 5\n" +
                kFile.substr(kFile.find("\n  # the other")));
}

TEST(WithAxisBlock, PutsItInThePlaceOfAnOldOne) {
  const std::string out = WithAxisBlock(kFile, "f", "y", "loop", "regulator_Hz: 20\n");
  EXPECT_NE(out.find("    loop:\n      regulator_Hz: 20\n    model: y.yaml\n"), std::string::npos) << out;
  EXPECT_EQ(out.find("notch_ratio"), std::string::npos);
  EXPECT_EQ(out.substr(0, out.find("    loop:")), kFile.substr(0, kFile.find("    loop:")));
}

TEST(WithAxisBlock, RefusesWhatItCannotPlace) {
  EXPECT_THROW(WithAxisBlock(kFile, "f", "z", "loop", "a: 1\n"), ConfigError);
  try {
    WithAxisBlock("axes:\n  x: {drive: {bus: main}}\n", "f", "x", "loop", "a: 1\n");
    FAIL();
  } catch (const ConfigError& e) {
    EXPECT_EQ(std::string(e.what()),
              "f:2: axes.x: found a map on one line, expected one key a line to put 'loop' there");
  }
}

}  // namespace
}  // namespace contour
