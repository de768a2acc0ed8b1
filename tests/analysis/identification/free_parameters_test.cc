#include "analysis/identification/free_parameters.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/analysis/identification/generated_axis.h"

namespace contour::test {
namespace {

using identify::FreeParameter;
using identify::FreeParameters;

bool Has(const std::vector<FreeParameter>& free, const char* key) {
  return std::any_of(free.begin(), free.end(), [key](const FreeParameter& p) { return p.key == key; });
}

TEST(FreeParametersTest, ADrivesReportsHideTheBristlesDampingAndItsLoopAnswers) {
  const auto axis = Exactly(PlainAxis());
  const auto commanded = FreeParameters(axis, false, {});
  EXPECT_TRUE(Has(commanded, "sigma1_Ns_m"));
  EXPECT_FALSE(Has(commanded, "answer_gain"));
  const auto led = FreeParameters(axis, true, {});
  EXPECT_FALSE(Has(led, "sigma1_Ns_m"));
  EXPECT_FALSE(Has(led, "sigma1_decay_mm_s"));
  EXPECT_TRUE(Has(led, "answer_gain"));
}

TEST(FreeParametersTest, EachIsAtANumberOfItsOwn) {
  auto axis = Exactly(PlainAxis());
  axis.side = {0.1, 200.0, 0.02};
  std::vector<const double*> at;
  for (const FreeParameter& p : FreeParameters(axis, true, {})) at.push_back(p.at(axis));
  std::sort(at.begin(), at.end());
  EXPECT_EQ(std::adjacent_find(at.begin(), at.end()), at.end());
}

}  // namespace
}  // namespace contour::test
