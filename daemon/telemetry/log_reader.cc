#include "daemon/telemetry/log_reader.h"

#include <contour_lcm/log_footer.hpp>
#include <contour_lcm/log_header.hpp>
#include <contour_lcm/log_note.hpp>
#include <contour_lcm/log_state.hpp>
#include <string_view>

#include "daemon/telemetry/log_format.h"
#include "drivers/lcm/batch_checksums.h"
#include "drivers/lcm/cycle_messages.h"
#include "drivers/lcm/telemetry_encoder.h"

namespace contour {
namespace {

constexpr std::uint64_t kNowhere = 0;

/// By its type, whatever its channel is called.
bool IsFooter(const LogEvent& event) {
  contour_lcm::log_footer footer{};
  return DecodeChecked(event.bytes, footer);
}

}  // namespace

LogReader::LogReader(const std::filesystem::path& file) : file_(file.string()) {
  try {
    events_.emplace(file_);
  } catch (const std::runtime_error& e) {
    Fail(e.what());
  }
  ReadHeader();
}

void LogReader::ReadHeader() {
  LogEvent event;
  if (events_->Next(event) != EventFile::Result::kEvent || event.channel != kHeaderChannel)
    Fail("is not a log of contourd");
  contour_lcm::log_header m{};
  if (!DecodeChecked(event.bytes, m)) Fail("has a damaged header, or one of another format");
  if (m.format_version < kOldestReadFormat || m.format_version > kLogFormatVersion) {
    Fail("has format " + std::to_string(m.format_version) + "; this program reads format " +
         std::to_string(kOldestReadFormat) + " to " + std::to_string(kLogFormatVersion));
  }
  header_ = {m.build,       m.machine,     m.controller, m.clock, m.start_unix_us, m.cycle_us, m.axis_names,
             m.config_name, m.config_text, m.overrides,  {}};
  for (std::size_t i = 0; i < m.file_names.size(); ++i)
    header_.files.push_back({m.file_names[i], m.file_texts[i]});
  header_.format_version = m.format_version;
}

bool LogReader::Next(CycleEntry& entry) {
  while (next_in_batch_ >= batch_.entries.size()) {
    if (!ReadBatch()) return false;
  }
  if (!FromMessage(batch_.entries[next_in_batch_++], entry)) Fail("holds more axes or frames than fit");
  const std::uint64_t cycle = entry.input.cycle;
  if (cycles_ > 0 || state_) {
    if (cycle <= last_cycle_) Fail("goes back in time at cycle " + std::to_string(cycle));
    // A grid point that the loop skipped was never a cycle; any other gap is a cycle that got lost.
    const std::uint64_t gap = cycle - last_cycle_ - 1;
    const std::uint64_t skipped = entry.timing.skipped_grid_points;
    if (gap > skipped) missing_cycles_ += gap - skipped;
  }
  ++cycles_;
  last_cycle_ = cycle;
  return true;
}

bool LogReader::ReadBatch() {
  next_in_batch_ = 0;
  batch_.entries.clear();
  LogEvent event;
  while (batch_.entries.empty()) {
    switch (events_->Next(event)) {
      case EventFile::Result::kEnd:
        if (!complete_ && IsFooter(event)) FailAt(last_cycle_, "has a damaged end");
        return false;
      case EventFile::Result::kCutShort:
        return false;
      case EventFile::Result::kDamaged:
        FailAt(last_cycle_ + 1, "is damaged after cycle " + std::to_string(last_cycle_));
      case EventFile::Result::kEvent:
        break;
    }
    if (complete_) Fail("goes on behind its end");
    if (event.channel == kCyclesChannel) OnBatch(event.bytes);
    if (event.channel == kNoteChannel) OnNote(event.bytes);
    if (event.channel == kStateChannel) OnState(event.bytes);
    if (event.channel == kFooterChannel) OnFooter(event.bytes, event.unix_us);
  }
  return true;
}

void LogReader::OnBatch(std::string_view bytes) {
  if (!DecodeChecked(bytes, batch_)) {
    const std::uint64_t cycle = last_cycle_ + 1 + FirstDamagedEntry(bytes);
    FailAt(cycle, "is damaged at cycle " + std::to_string(cycle));
  }
  if (batch_.batch_number < batches_) Fail("repeats a batch after cycle " + std::to_string(last_cycle_));
  batches_ = batch_.batch_number + 1;
}

void LogReader::OnState(std::string_view bytes) {
  contour_lcm::log_state m{};
  if (!DecodeChecked(bytes, m)) FailAt(last_cycle_ + 1, "has a damaged state at its beginning");
  state_ = {static_cast<std::uint64_t>(m.cycle), m.build, std::string(m.bytes.begin(), m.bytes.end())};
  // What came before is not missing.
  last_cycle_ = state_->cycle;
}

void LogReader::OnNote(std::string_view bytes) {
  contour_lcm::log_note note{};
  if (!DecodeChecked(bytes, note))
    FailAt(last_cycle_ + 1, "has a damaged note after cycle " + std::to_string(last_cycle_));
  notes_.push_back({note.cycles_before, note.key, note.text});
}

void LogReader::OnFooter(std::string_view bytes, std::int64_t unix_us) {
  contour_lcm::log_footer footer{};
  if (!DecodeChecked(bytes, footer) || footer.unix_us != unix_us)
    FailAt(last_cycle_, "has a damaged end, after cycle " + std::to_string(last_cycle_));
  if (static_cast<std::uint32_t>(footer.file_crc32c) != events_->checksum_before())
    FailAt(kNowhere, "is damaged outside its cycles, in what is meant for looking");
  complete_ = true;
  // A loss at the very end leaves no gap between cycles; the footer still knows of it.
  const auto written = static_cast<std::uint64_t>(footer.cycles);
  const auto lost = static_cast<std::uint64_t>(footer.lost_cycles);
  if (written > cycles_) {
    missing_cycles_ += written - cycles_;
  } else if (lost > missing_cycles_) {
    missing_cycles_ = lost;
  }
}

void LogReader::Fail(const std::string& what) const { throw LogError(file_ + ": " + what); }

void LogReader::FailAt(std::uint64_t cycle, const std::string& what) const {
  throw LogError(file_ + ": " + what, cycle);
}

}  // namespace contour
