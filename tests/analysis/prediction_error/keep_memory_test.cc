#include "analysis/prediction_error/keep_memory.h"

#include <gtest/gtest.h>
#include <malloc.h>

#include <vector>

namespace contour::diagnosis {
namespace {

TEST(KeepMemory, AnArrayOfManyMegabytesIsNoMappingOfItsOwn) {
  const auto mapped = [] {
    const std::vector<double> array(8 << 20, 1.0);
    return mallinfo2().hblks;
  };
  const std::size_t before = mallinfo2().hblks;
  ASSERT_GT(mapped(), before) << "this libc maps nothing: the test shows nothing";
  KeepMemory();
  EXPECT_EQ(mapped(), before);
}

}  // namespace
}  // namespace contour::diagnosis
