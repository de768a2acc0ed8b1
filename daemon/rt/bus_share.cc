#include "daemon/rt/bus_share.h"

#include <algorithm>
#include <array>
#include <span>

namespace contour {
namespace {

constexpr std::size_t kNone = SIZE_MAX;

/// A newer frame of the same identifier is there, or is `news`.
bool ComesAgain(const ReceivedFrames& frames, std::size_t i, std::uint16_t news) noexcept {
  const StampedFrame& f = frames[i];
  return f.frame.id == news ||
         std::any_of(frames.begin() + i + 1, frames.end(), [&](const StampedFrame& later) {
           return later.bus == f.bus && later.frame.id == f.frame.id;
         });
}

/// The frame of this bus that is missed the least when `news` is to have its place; kNone when that is
/// `news`.
std::size_t Victim(const ReceivedFrames& frames, std::uint8_t bus, std::uint16_t news,
                   const BusNodes& nodes) noexcept {
  const Traffic kind = nodes.Of(news);
  if (kind == Traffic::kOther) return kNone;
  std::size_t lower = kNone;
  std::size_t repeated = kNone;  // of our drives
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].bus == bus && nodes.Of(frames[i].frame.id) == Traffic::kOther) return i;
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i].bus != bus) continue;
    const Traffic its = nodes.Of(frames[i].frame.id);
    if (its < kind && lower == kNone) lower = i;
    if (its == Traffic::kDrives && repeated != kNone) continue;
    if (!ComesAgain(frames, i, news)) continue;
    if (its == Traffic::kMasters) return i;
    repeated = i;
  }
  return repeated != kNone ? repeated : lower;
}

void Replace(ReceivedFrames& frames, std::size_t victim, const StampedFrame& news) noexcept {
  std::move(frames.begin() + victim + 1, frames.end(), frames.begin() + victim);
  frames.back() = news;
}

}  // namespace

std::size_t TakeShare(FrameBus& from, std::uint8_t bus, std::size_t share, const BusNodes& nodes,
                      std::int64_t bus_time_ns, ReceivedFrames& frames) noexcept {
  std::size_t had = 0;
  for (const StampedFrame& f : frames) had += f.bus == bus ? 1U : 0U;
  std::size_t room = std::min(share - std::min(share, had), frames.capacity() - frames.size());
  if (room != 0) {
    const std::size_t first = frames.size();
    const std::size_t got = from.Receive(bus_time_ns, {frames.data() + first, room});
    for (std::size_t i = 0; i < got; ++i) frames[first + i].bus = bus;
    frames.resize(first + got);
    if (got < room) return 0;
  }
  // More than its share: the rest is looked at frame by frame.
  std::size_t dropped = 0;
  std::array<StampedFrame, kMaxFramesPerCycle> more;
  for (std::size_t taken = 0; taken < kMostFramesTaken;) {
    const std::size_t got = from.Receive(bus_time_ns, more);
    taken += got;
    for (std::size_t i = 0; i < got; ++i) {
      ++dropped;
      more[i].bus = bus;
      const std::size_t victim = Victim(frames, bus, more[i].frame.id, nodes);
      if (victim != kNone) Replace(frames, victim, more[i]);
    }
    if (got < more.size()) break;
  }
  return dropped;
}

}  // namespace contour
