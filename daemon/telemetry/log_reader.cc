#include "daemon/telemetry/log_reader.h"

#include <lcm/eventlog.h>

#include <cerrno>
#include <contour_lcm/log_footer.hpp>
#include <contour_lcm/log_header.hpp>
#include <contour_lcm/log_note.hpp>
#include <cstdio>
#include <cstring>
#include <string_view>

#include "daemon/telemetry/log_format.h"
#include "drivers/lcm/cycle_messages.h"
#include "drivers/lcm/telemetry_encoder.h"

namespace contour {
namespace {

struct EventFree {
  void operator()(lcm_eventlog_event_t* event) const noexcept { lcm_eventlog_free_event(event); }
};
using Event = std::unique_ptr<lcm_eventlog_event_t, EventFree>;

std::string_view Channel(const lcm_eventlog_event_t& event) {
  return {event.channel, static_cast<std::size_t>(event.channellen)};
}

std::string_view Bytes(const lcm_eventlog_event_t& event) {
  return {static_cast<const char*>(event.data), static_cast<std::size_t>(event.datalen)};
}

}  // namespace

void LogReader::Closer::operator()(lcm_eventlog_t* log) const noexcept { lcm_eventlog_destroy(log); }

LogReader::LogReader(const std::filesystem::path& file) : file_(file.string()) {
  errno = 0;
  log_.reset(lcm_eventlog_create(file_.c_str(), "r"));
  if (log_ == nullptr) Fail(std::string("cannot be read: ") + std::strerror(errno));
  ReadHeader();
}

void LogReader::ReadHeader() {
  const Event event(lcm_eventlog_read_next_event(log_.get()));
  if (event == nullptr || Channel(*event) != kHeaderChannel) Fail("is not a log of contourd");
  contour_lcm::log_header m{};
  if (!DecodeChecked(Bytes(*event), m)) Fail("has a damaged header, or one of another format");
  if (m.format_version != kLogFormatVersion) {
    Fail("has format " + std::to_string(m.format_version) + "; this program reads format " +
         std::to_string(kLogFormatVersion));
  }
  header_ = {m.build,    m.machine,    m.controller,  m.clock,       m.start_unix_us,
             m.cycle_us, m.axis_names, m.config_name, m.config_text, m.overrides};
}

bool LogReader::Next(CycleEntry& entry) {
  while (next_in_batch_ >= batch_.entries.size()) {
    if (!ReadBatch()) return false;
  }
  if (!FromMessage(batch_.entries[next_in_batch_++], entry)) Fail("holds more axes or frames than fit");
  const std::uint64_t cycle = entry.input.cycle;
  if (cycles_ > 0) {
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
  while (batch_.entries.empty()) {
    const Event event(lcm_eventlog_read_next_event(log_.get()));
    if (event == nullptr) {
      // Not at the end: something in the middle is no event.
      if (std::feof(log_->f) == 0) Fail("is damaged after cycle " + std::to_string(last_cycle_));
      return false;
    }
    if (Channel(*event) == kCyclesChannel) OnBatch(Bytes(*event));
    if (Channel(*event) == kNoteChannel) OnNote(Bytes(*event));
    if (Channel(*event) == kFooterChannel) OnFooter(Bytes(*event));
  }
  return true;
}

void LogReader::OnBatch(std::string_view bytes) {
  if (!DecodeChecked(bytes, batch_)) Fail("is damaged after cycle " + std::to_string(last_cycle_));
  if (batch_.batch_number < batches_) Fail("repeats a batch after cycle " + std::to_string(last_cycle_));
  batches_ = batch_.batch_number + 1;
}

void LogReader::OnNote(std::string_view bytes) {
  contour_lcm::log_note note{};
  if (!DecodeChecked(bytes, note)) Fail("has a damaged note after cycle " + std::to_string(last_cycle_));
  notes_.push_back({note.cycles_before, note.key, note.text});
}

void LogReader::OnFooter(std::string_view bytes) {
  contour_lcm::log_footer footer{};
  if (!DecodeChecked(bytes, footer)) Fail("has a damaged end");
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

}  // namespace contour
