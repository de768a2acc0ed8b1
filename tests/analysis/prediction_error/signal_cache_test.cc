#include "analysis/prediction_error/signal_cache.h"

#include <gtest/gtest.h>

#include <memory>

namespace contour::diagnosis {
namespace {

class SignalCacheTest : public testing::Test {
 protected:
  double Get(std::uint64_t owner, double number) {
    const auto make = [&] {
      ++made_;
      return SignalCache::Signals{
          std::make_shared<const Signal>(3, 10.0 * static_cast<double>(owner) + number)};
    };
    return (*cache_.For(owner, number, make)[0])[2];
  }

  SignalCache cache_;
  int made_ = 0;
};

TEST_F(SignalCacheTest, MakesAgainOnlyForAnotherNumberOrAnotherEffect) {
  const std::uint64_t a = cache_.NewOwner(), b = cache_.NewOwner();
  ASSERT_NE(a, b);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(Get(a, 0.5), 10.0 * static_cast<double>(a) + 0.5);
    EXPECT_EQ(Get(a, 0.0), 10.0 * static_cast<double>(a));
    EXPECT_EQ(Get(b, 0.5), 10.0 * static_cast<double>(b) + 0.5);
  }
  EXPECT_EQ(made_, 3);
}

TEST_F(SignalCacheTest, ForgetsWhatWasNotAskedForLongest) {
  const std::uint64_t a = cache_.NewOwner();
  constexpr int kMany = 40;
  for (int i = 0; i < kMany; ++i) {
    Get(a, i);
    Get(a, 0.0);
  }
  EXPECT_EQ(made_, kMany);  // the first one stays
  Get(a, 1.0);
  EXPECT_EQ(made_, kMany + 1);
}

}  // namespace
}  // namespace contour::diagnosis
