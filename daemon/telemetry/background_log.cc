#include "daemon/telemetry/background_log.h"

#include <future>
#include <stdexcept>
#include <utility>

namespace contour {
namespace {

constexpr const char* kStalled =
    "the file took nothing for so long that there was no more room for what waited";

}  // namespace

BackgroundLog::BackgroundLog(const std::filesystem::path& file, const LogHeader& header, const Limits& limits)
    : limits_(limits), file_(file.string()), lane_("contour-log", {limits.max_bytes, limits.patience}) {
  // A pipe that nobody opens, or a server that does not answer, holds up whoever opens the file.
  const auto made = std::make_shared<std::promise<std::shared_ptr<LogWriter>>>();
  std::future<std::shared_ptr<LogWriter>> writer = made->get_future();
  lane_.Post(0, [made, file, header] {
    try {
      made->set_value(std::make_shared<LogWriter>(file, header));
    } catch (const std::exception&) {
      made->set_exception(std::current_exception());
    }
  });
  if (writer.wait_for(limits.opening) != std::future_status::ready)
    throw std::runtime_error("cannot write log " + file_ + ": it takes nothing for " +
                             std::to_string(limits.opening.count()) + " ms; does anybody read that pipe?");
  writer_ = writer.get();
}

void BackgroundLog::Report(LogWriter& writer, Lost& lost) noexcept {
  const std::lock_guard lock(lost.mutex);
  if (lost.cycles != 0 || lost.notes != 0) writer.Lose(lost.cycles, lost.notes, kStalled);
  lost.cycles = lost.notes = 0;
}

void BackgroundLog::OnEvent(const TelemetryEvent& event) noexcept {
  const auto cycles = static_cast<std::uint64_t>(event.cycles);
  bool taken = false;
  try {
    auto work = [writer = writer_, lost = lost_, channel = std::string(event.channel),
                 bytes = std::string(event.bytes), time_ns = event.grid_time_ns, count = event.cycles] {
      Report(*writer, *lost);
      writer->OnEvent({channel, bytes, time_ns, count});
    };
    taken = lane_.Post(event.channel.size() + event.bytes.size(), std::move(work));
  } catch (const std::exception&) {
    // No memory: lost like what finds no room.
  }
  {
    const std::lock_guard lock(mutex_);
    handed_over_ += cycles;
  }
  if (taken) return;
  const std::lock_guard lock(lost_->mutex);
  lost_->cycles += cycles;
}

void BackgroundLog::Note(const std::string& key, const std::string& text) noexcept {
  bool taken = false;
  try {
    taken = lane_.Post(
        key.size() + text.size(),
        [writer = writer_, lost = lost_, key, text] {
          Report(*writer, *lost);
          writer->Note(key, text);
        },
        limits_.max_note_bytes);
  } catch (const std::exception&) {
    // As above.
  }
  if (taken) return;
  const std::lock_guard lock(lost_->mutex);
  ++lost_->notes;
}

bool BackgroundLog::Close(std::chrono::steady_clock::time_point deadline) noexcept {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(closed_, true)) return true;
  }
  bool asked = false;
  try {
    asked = lane_.Post(
        0,
        [writer = writer_, lost = lost_] {
          Report(*writer, *lost);
          writer->Close();
        },
        2 * limits_.max_bytes + limits_.max_note_bytes);
  } catch (const std::exception&) {
    // The log stays without its end, and says so to whoever reads it.
  }
  if (lane_.Finish(deadline)) return asked;
  writer_->Abandon();
  return false;
}

LogStats BackgroundLog::stats() const {
  LogStats stats = writer_->stats();
  {
    const std::lock_guard lock(lost_->mutex);
    stats.lost_cycles += lost_->cycles;
    stats.lost_notes += lost_->notes;
    if (lost_->cycles != 0 || lost_->notes != 0) stats.last_error = kStalled;
  }
  const std::lock_guard lock(mutex_);
  const std::uint64_t settled = stats.cycles + stats.lost_cycles;
  stats.waiting_cycles = handed_over_ > settled ? handed_over_ - settled : 0;
  return stats;
}

}  // namespace contour
