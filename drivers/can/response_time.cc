#include "drivers/can/response_time.h"

#include <algorithm>

#include "drivers/can/frame_timing.h"

namespace contour {
namespace {

// Far beyond any period of a bus: a busy period this long does not end.
constexpr std::int64_t kEndless_ns = 1'000'000'000'000;

std::int64_t CeilDivide(std::int64_t a, std::int64_t b) noexcept { return (a + b - 1) / b; }

/// B: the longest message of lower priority, which may just have begun.
std::int64_t Blocking_ns(std::span<const CanMessage> messages, std::uint16_t id,
                         std::uint32_t bitrate) noexcept {
  std::int64_t longest = 0;
  for (const CanMessage& m : messages) {
    if (m.id > id) longest = std::max(longest, TransmissionTime_ns(m, bitrate));
  }
  return longest;
}

/// Sum over the messages of higher priority (and `own`, when asked for) of ceil((time + J) / T) C.
std::int64_t Interference_ns(std::span<const CanMessage> messages, std::size_t which, bool own,
                             std::int64_t time_ns, std::uint32_t bitrate) noexcept {
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < messages.size(); ++k) {
    const CanMessage& m = messages[k];
    if (k == which ? !own : m.id >= messages[which].id) continue;
    sum += CeilDivide(time_ns + m.jitter_ns, m.period_ns) * TransmissionTime_ns(m, bitrate);
  }
  return sum;
}

}  // namespace

std::int64_t TransmissionTime_ns(const CanMessage& message, std::uint32_t bitrate_bit_s) noexcept {
  return BitsToNs(WorstFrameBits(message.length), bitrate_bit_s);
}

double Load(std::span<const CanMessage> messages, std::uint32_t bitrate_bit_s) noexcept {
  double load = 0.0;
  for (const CanMessage& m : messages) {
    load += static_cast<double>(TransmissionTime_ns(m, bitrate_bit_s)) / static_cast<double>(m.period_ns);
  }
  return load;
}

std::optional<std::int64_t> ResponseTime_ns(std::span<const CanMessage> messages, std::size_t which,
                                            std::uint32_t bitrate_bit_s) {
  const CanMessage& m = messages[which];
  const std::int64_t own = TransmissionTime_ns(m, bitrate_bit_s);
  const std::int64_t blocking = Blocking_ns(messages, m.id, bitrate_bit_s);
  const std::int64_t bit = BitsToNs(1, bitrate_bit_s);

  std::int64_t busy = own;
  while (true) {
    const std::int64_t next = blocking + Interference_ns(messages, which, true, busy, bitrate_bit_s);
    if (next == busy) break;
    if (next > kEndless_ns) return std::nullopt;
    busy = next;
  }
  const std::int64_t instances = CeilDivide(busy + m.jitter_ns, m.period_ns);
  std::int64_t worst = 0;
  std::int64_t wait = blocking;
  for (std::int64_t q = 0; q < instances; ++q) {
    wait = std::max(wait, blocking + q * own);
    while (true) {
      const std::int64_t next =
          blocking + q * own + Interference_ns(messages, which, false, wait + bit, bitrate_bit_s);
      if (next == wait) break;
      wait = next;
    }
    worst = std::max(worst, m.jitter_ns + wait - q * m.period_ns + own);
  }
  return worst;
}

}  // namespace contour
