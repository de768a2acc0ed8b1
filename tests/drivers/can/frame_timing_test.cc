#include "drivers/can/frame_timing.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace contour {
namespace {

std::string Binary(std::uint32_t value, int digits) {
  std::string s;
  for (int i = digits - 1; i >= 0; --i) s += ((value >> i) & 1u) != 0 ? '1' : '0';
  return s;
}

/// The same, written down as a person would: the bit string, polynomial long division, stuffing on the
/// string.
std::size_t BitsByHand(const CanFrame& f) {
  std::string bits = "0" + Binary(f.id, 11) + "000" + Binary(f.length, 4);
  for (std::size_t i = 0; i < f.length; ++i) bits += Binary(f.data[i], 8);

  const std::string divisor = "1100010110011001";  // x^15+x^14+x^10+x^8+x^7+x^4+x^3+1
  std::string remainder = bits + std::string(15, '0');
  for (std::size_t i = 0; i < bits.size(); ++i) {
    if (remainder[i] == '0') continue;
    for (std::size_t j = 0; j < divisor.size(); ++j)
      remainder[i + j] = remainder[i + j] == divisor[j] ? '0' : '1';
  }
  bits += remainder.substr(bits.size());

  std::string line;
  for (const char bit : bits) {
    line += bit;
    const std::size_t n = line.size();
    if (n >= 5 && line.substr(n - 5) == std::string(5, bit)) line += bit == '0' ? '1' : '0';
  }
  return line.size() + 1 + 2 + 7 + 3;
}

TEST(FrameTiming, WorstCaseIsThatOfTheLiterature) {
  for (std::uint32_t s = 0; s <= 8; ++s) EXPECT_EQ(WorstFrameBits(s), 55 + 10 * s);
}

TEST(FrameTiming, StuffBitsAreExact) {
  std::mt19937 random(7);
  for (int i = 0; i < 20000; ++i) {
    CanFrame f{static_cast<std::uint16_t>(random() & 0x7FF), static_cast<std::uint8_t>(random() % 9), {}};
    // Bytes of long runs are the interesting ones.
    constexpr std::uint8_t kRuns[] = {0x00, 0xFF, 0x1F, 0xF0, 0x83};
    for (auto& byte : f.data)
      byte = random() % 2 == 0 ? kRuns[random() % 5] : static_cast<std::uint8_t>(random());
    ASSERT_EQ(FrameBits(f), BitsByHand(f)) << "id " << f.id << " length " << int{f.length};
    ASSERT_LE(FrameBits(f), WorstFrameBits(f.length));
    ASSERT_GE(FrameBits(f), 47u + 8u * f.length);
  }
}

TEST(FrameTiming, DurationAtABitRate) {
  EXPECT_EQ(BitsToNs(135, 1'000'000), 135'000);
  EXPECT_EQ(BitsToNs(55, 500'000), 110'000);
  EXPECT_EQ(BitsToNs(1, 800'000), 1250);
}

}  // namespace
}  // namespace contour
