#include "daemon/program/spool.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <random>
#include <string>
#include <thread>

#include "daemon/program/spooled_list.h"

namespace contour {
namespace {

struct Odd {
  std::uint64_t number = 0;
  char more[13] = {};
};

constexpr std::uint64_t kMany = 200'000;  // 4.8 MB: most of it is not in memory

SpooledList<Odd> Numbers(std::uint64_t count) {
  SpooledList<Odd> list;
  for (std::uint64_t i = 0; i < count; ++i) list.push_back({i * i, {}});
  return list;
}

TEST(Spool, GivesBackAnythingFromAnywhere) {
  const SpooledList<Odd> list = Numbers(kMany);
  ASSERT_EQ(list.size(), kMany);
  EXPECT_TRUE(list.on_disk());
  std::mt19937 random(7);
  for (int n = 0; n < 20000; ++n) {
    const std::uint64_t i = random() % kMany;
    ASSERT_EQ(list[i].number, i * i);
  }
}

TEST(Spool, MemoryDoesNotGrow) {
  const std::size_t some = Numbers(kMany).bytes_in_memory(), most = Numbers(4 * kMany).bytes_in_memory();
  EXPECT_LT(some, 1.1 * Spool::kPagesHeld * Spool::kPageBytes);
  EXPECT_LT(most, 1.01 * static_cast<double>(some));
  EXPECT_LT(Numbers(10).bytes_in_memory(), 2 * Spool::kPageBytes) << "a short one needs little";
  EXPECT_FALSE(Numbers(10).on_disk());
}

TEST(Spool, CopiesAreApart) {
  SpooledList<Odd> list = Numbers(kMany);
  const SpooledList<Odd> copy = list;
  list.push_back({1, {}});
  list = Numbers(3);
  ASSERT_EQ(copy.size(), kMany);
  EXPECT_EQ(copy[kMany - 2].number, (kMany - 2) * (kMany - 2));
  EXPECT_EQ(list[1].number, 1u);
}

TEST(Spool, ThreadsReadAtOnce) {
  const SpooledList<Odd> list = Numbers(kMany);
  std::vector<std::jthread> readers;
  std::atomic<int> wrong{0};
  for (unsigned k = 0; k < 3; ++k)
    readers.emplace_back([&, k] {
      for (std::uint64_t i = k; i < kMany; i += 7)
        if (list[i].number != i * i) ++wrong;
    });
  readers.clear();
  EXPECT_EQ(wrong, 0);
}

TEST(Spool, LeavesNoFileAndSaysWhereOneCannotBeMade) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "spool_here";
  std::filesystem::create_directories(folder);
  const char* const before = std::getenv("TMPDIR");
  const std::string was = before != nullptr ? before : "";
  setenv("TMPDIR", folder.c_str(), 1);
  {
    const SpooledList<Odd> list = Numbers(kMany);
    EXPECT_TRUE(list.on_disk());
    EXPECT_TRUE(std::filesystem::is_empty(folder)) << "it has no name";
  }
  setenv("TMPDIR", "/nowhere/at/all", 1);
  try {
    Numbers(kMany);
    ADD_FAILURE() << "there is no such folder";
  } catch (const SpoolError& e) {
    EXPECT_NE(std::string(e.what()).find("/nowhere/at/all (TMPDIR)"), std::string::npos) << e.what();
  }
  before != nullptr ? setenv("TMPDIR", was.c_str(), 1) : unsetenv("TMPDIR");
}

}  // namespace
}  // namespace contour
