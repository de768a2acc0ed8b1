#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/daemon/program/walk_search.h"

// CONTOUR_LONG_TESTS=1: many more machines, programs and changes (tools/nightly).
namespace contour {
namespace {

unsigned Rounds(unsigned usual) { return std::getenv("CONTOUR_LONG_TESTS") != nullptr ? 100 * usual : usual; }

TEST(WalkSearch, FeedsFromOneToTwoKeepLimitsAndPath) {
  for (unsigned seed = 1000; seed < 1000 + Rounds(8) && !::testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    testing::WalkSearch(seed).Run(1.0);
  }
}

TEST(WalkSearch, HoldsAndAnyFeedsKeepLimitsAndPath) {
  for (unsigned seed = 1; seed < 1 + Rounds(4) && !::testing::Test::HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    testing::WalkSearch(seed).Run(-1.0);
  }
}

}  // namespace
}  // namespace contour
