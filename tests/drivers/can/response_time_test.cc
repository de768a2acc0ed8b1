#include "drivers/can/response_time.h"

#include <gtest/gtest.h>

namespace contour {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(ResponseTime, DavisExample) {
  // Table 3 of the paper: three messages at 125 kbit/s, 7 data bytes (1 ms each). The first analysis of the
  // literature gave 3 ms for the third message; its second instance needs 3.5 ms.
  const std::vector<CanMessage> m{
      {"A", 1, 7, 2'500'000, 0}, {"B", 2, 7, 3'500'000, 0}, {"C", 3, 7, 3'500'000, 0}};
  EXPECT_EQ(TransmissionTime_ns(m[0], 125'000), kMs);
  EXPECT_EQ(ResponseTime_ns(m, 0, 125'000), 2 * kMs);
  EXPECT_EQ(ResponseTime_ns(m, 1, 125'000), 3 * kMs);
  EXPECT_EQ(ResponseTime_ns(m, 2, 125'000), 3'500'000);
}

TEST(ResponseTime, JitterOfOthersAndOfItsOwnAddsUp) {
  std::vector<CanMessage> m{{"A", 1, 0, kMs, 0}, {"B", 2, 0, kMs, 0}};
  EXPECT_EQ(ResponseTime_ns(m, 1, 1'000'000), 110'000);
  m[1].jitter_ns = 20'000;
  EXPECT_EQ(ResponseTime_ns(m, 1, 1'000'000), 130'000);
  m[0].jitter_ns = 990'000;  // a late A and the next one, back to back
  EXPECT_EQ(ResponseTime_ns(m, 1, 1'000'000), 185'000);
}

TEST(ResponseTime, NoBoundWhenOthersTakeTheWholeBus) {
  const std::vector<CanMessage> m{{"A", 1, 8, 135'000, 0}, {"B", 2, 8, kMs, 0}};
  EXPECT_FALSE(ResponseTime_ns(m, 1, 1'000'000).has_value());
  EXPECT_GT(Load(m, 1'000'000), 1.0);
}

// Servo layouts at 1 Mbit/s: SYNC, per axis an 8-byte TPDO and a 4-byte RPDO, SDO every 2 ms, heartbeats at
// 100 ms, and `emergencies` axes that send an 8-byte emergency message within the same cycle.
struct Worst {
  std::optional<std::int64_t> tpdo_ns;
  std::optional<std::int64_t> rpdo_ns;
};

Worst Servo(int axes, std::int64_t cycle_ns, int emergencies) {
  std::vector<CanMessage> m{{"SYNC", 0x80, 0, cycle_ns, 0}, {"SDO", 0x581, 8, 2 * kMs, 0}};
  const auto id = [](int base, int n) { return static_cast<std::uint16_t>(base + n); };
  for (int n = 1; n <= axes; ++n) {
    if (n <= emergencies) m.push_back({"EMCY", id(0x80, n), 8, 100 * kMs, 0});
    m.push_back({"TPDO", id(0x180, n), 8, cycle_ns, 0});
    m.push_back({"RPDO", id(0x200, n), 4, cycle_ns, 0});
    m.push_back({"heartbeat", id(0x700, n), 1, 100 * kMs, 0});
  }
  Worst w;
  for (std::size_t i = 0; i < m.size(); ++i) {
    if (m[i].id == id(0x180, axes)) w.tpdo_ns = ResponseTime_ns(m, i, 1'000'000);
    if (m[i].id == id(0x200, axes)) w.rpdo_ns = ResponseTime_ns(m, i, 1'000'000);
  }
  return w;
}

TEST(ResponseTime, ServoLayouts) {
  EXPECT_EQ(Servo(1, kMs, 0).tpdo_ns, 325'000);
  EXPECT_EQ(Servo(1, kMs, 0).rpdo_ns, 420'000);
  EXPECT_EQ(Servo(1, kMs, 1).tpdo_ns, 460'000);
  EXPECT_EQ(Servo(1, kMs, 1).rpdo_ns, 555'000);
  EXPECT_EQ(Servo(2, kMs, 0).tpdo_ns, 460'000);
  EXPECT_EQ(Servo(2, kMs, 0).rpdo_ns, 650'000);
  EXPECT_EQ(Servo(2, kMs, 1).rpdo_ns, 785'000);  // leaves 215 us of the cycle
  EXPECT_EQ(Servo(2, kMs, 2).tpdo_ns, 730'000);
  EXPECT_EQ(Servo(2, kMs, 2).rpdo_ns, 920'000);
  EXPECT_EQ(Servo(3, kMs, 0).tpdo_ns, 595'000);
  EXPECT_EQ(Servo(3, kMs, 0).rpdo_ns, 880'000);
  EXPECT_GT(Servo(3, kMs, 3).rpdo_ns.value_or(kMs * 10), kMs) << "misses";
  EXPECT_GT(Servo(4, kMs, 0).rpdo_ns.value_or(kMs * 10), kMs) << "misses";
  EXPECT_EQ(Servo(4, 2 * kMs, 4).tpdo_ns, 1'270'000);
  EXPECT_EQ(Servo(4, 2 * kMs, 4).rpdo_ns, 1'650'000);
  EXPECT_EQ(Servo(4, 2 * kMs, 1).rpdo_ns, 1'245'000);  // leaves 755 us
}

}  // namespace
}  // namespace contour
