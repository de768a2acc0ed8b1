#include "daemon/telemetry/log_writer.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <contour_lcm/log_footer.hpp>
#include <contour_lcm/log_header.hpp>
#include <contour_lcm/log_note.hpp>
#include <contour_lcm/log_state.hpp>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "core/exit_status.h"
#include "daemon/telemetry/log_format.h"
#include "drivers/lcm/cycle_messages.h"

namespace contour {
namespace {

constexpr std::size_t kWriteAt_bytes = 1u << 18;

/// LCM's event logs are big-endian.
template <class Integer>
void AppendBigEndian(std::string& out, Integer value) {
  for (int shift = static_cast<int>(sizeof(Integer)) * 8 - 8; shift >= 0; shift -= 8)
    out += static_cast<char>((static_cast<std::uint64_t>(value) >> shift) & 0xFFu);
}

contour_lcm::log_header ToMessage(const LogHeader& header) {
  contour_lcm::log_header m{};
  m.format_version = header.format_version;
  m.build = header.build;
  m.machine = header.machine;
  m.controller = header.controller;
  m.clock = header.clock;
  m.start_unix_us = header.start_unix_us;
  m.cycle_us = header.cycle_us;
  m.num_axes = static_cast<std::int32_t>(header.axis_names.size());
  m.axis_names = header.axis_names;
  m.config_name = header.config_name;
  m.config_text = header.config_text;
  m.num_overrides = static_cast<std::int32_t>(header.overrides.size());
  m.overrides = header.overrides;
  m.num_files = static_cast<std::int32_t>(header.files.size());
  for (const LogFile& file : header.files) {
    m.file_names.push_back(file.name);
    m.file_texts.push_back(file.text);
  }
  return m;
}

/// Emptied only when no other process is writing it: a second daemon that is started by mistake must not
/// take the record of the first.
int OpenForOneWriter(const std::filesystem::path& file) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  // Devices and pipes are nobody's alone and have no length to cut.
  struct stat found {};
  const bool known = fd >= 0 && ::fstat(fd, &found) == 0;
  if (known && !S_ISREG(found.st_mode)) return fd;
  const bool held = known && ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (known && !held && ::ftruncate(fd, 0) == 0) return fd;
  const std::string why =
      held ? "another process is writing it; end that one or name another file" : std::strerror(errno);
  if (fd >= 0) ::close(fd);
  throw EnvironmentError("cannot write log " + file.string() + ": " + why);
}

}  // namespace

LogWriter::LogWriter(const std::filesystem::path& file, const LogHeader& header)
    : start_unix_us_(header.start_unix_us), last_unix_us_(header.start_unix_us) {
  stats_.file = file.string();
  fd_ = OpenForOneWriter(file);
  Append(kHeaderChannel, EncodeChecked(ToMessage(header)), start_unix_us_);
  if (!WritePending()) {
    ::close(fd_);
    throw std::runtime_error("cannot write log " + file.string() + ": " + stats_.last_error);
  }
}

LogWriter::~LogWriter() { Close(); }

void LogWriter::OnEvent(const TelemetryEvent& event) noexcept {
  const std::lock_guard lock(mutex_);
  if (fd_ < 0) return;
  try {
    pending_cycles_ += static_cast<std::uint64_t>(event.cycles);
    if (event.cycles > 0) ++batches_;
    Append(event.channel, event.bytes, UnixTime_us(event.grid_time_ns));
  } catch (const std::exception& e) {
    return LosePending(e.what());
  }
  if (event.cycles > 0 || pending_.size() >= kWriteAt_bytes) WritePending();
}

void LogWriter::Note(const std::string& key, const std::string& text) noexcept {
  const std::lock_guard lock(mutex_);
  if (fd_ < 0) return;
  try {
    contour_lcm::log_note note{};
    note.cycles_before = static_cast<std::int64_t>(stats_.cycles + pending_cycles_);
    note.key = key;
    note.text = text;
    Append(kNoteChannel, EncodeChecked(note), last_unix_us_);
  } catch (const std::exception& e) {
    LosePending(e.what());
  }
}

void LogWriter::State(const LogState& state) noexcept {
  const std::lock_guard lock(mutex_);
  if (fd_ < 0) return;
  try {
    contour_lcm::log_state m{};
    m.cycle = static_cast<std::int64_t>(state.cycle);
    m.build = state.build;
    m.size = static_cast<std::int32_t>(state.bytes.size());
    m.bytes.assign(state.bytes.begin(), state.bytes.end());
    Append(kStateChannel, EncodeChecked(m), last_unix_us_);
  } catch (const std::exception& e) {
    LosePending(e.what());
  }
}

void LogWriter::Close() noexcept {
  const std::lock_guard lock(mutex_);
  if (fd_ < 0) return;
  WritePending();
  try {
    contour_lcm::log_footer footer{};
    footer.batches = batches_;
    footer.cycles = static_cast<std::int64_t>(stats_.cycles);
    footer.lost_cycles = static_cast<std::int64_t>(stats_.lost_cycles);
    footer.unix_us = last_unix_us_;
    footer.file_crc32c = static_cast<std::int32_t>(checksum_);
    Append(kFooterChannel, EncodeChecked(footer), last_unix_us_);
    WritePending();
  } catch (const std::exception& e) {
    LosePending(e.what());
  }
  ::close(fd_);
  fd_ = -1;
}

void LogWriter::Lose(std::uint64_t cycles, std::uint64_t notes, const char* why) noexcept {
  const std::lock_guard lock(mutex_);
  const std::lock_guard stats_lock(stats_mutex_);
  SetError(why);
  stats_.lost_cycles += cycles;
  stats_.lost_notes += notes;
}

LogStats LogWriter::stats() const {
  const std::lock_guard lock(stats_mutex_);
  return stats_;
}

void LogWriter::Append(std::string_view channel, std::string_view bytes, std::int64_t unix_us) {
  const std::size_t size = 28 + channel.size() + bytes.size();
  pending_.reserve(pending_.size() + size);  // the only thing here that can fail
  AppendBigEndian(pending_, kLcmEventSync);
  AppendBigEndian(pending_, events_++);
  AppendBigEndian(pending_, unix_us);
  AppendBigEndian(pending_, static_cast<std::int32_t>(channel.size()));
  AppendBigEndian(pending_, static_cast<std::int32_t>(bytes.size()));
  pending_ += channel;
  pending_ += bytes;
}

std::int64_t LogWriter::UnixTime_us(std::int64_t grid_time_ns) noexcept {
  if (!any_event_) {
    any_event_ = true;
    first_grid_time_ns_ = grid_time_ns;
  }
  last_unix_us_ = start_unix_us_ + (grid_time_ns - first_grid_time_ns_) / 1000;
  return last_unix_us_;
}

bool LogWriter::WritePending() noexcept {
  if (abandoned_) return false;
  std::size_t done = 0;
  while (done < pending_.size()) {
    const ssize_t n = ::write(fd_, pending_.data() + done, pending_.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      LosePending(std::strerror(n < 0 ? errno : ENOSPC));
      return false;
    }
    done += static_cast<std::size_t>(n);
  }
  good_size_ += static_cast<std::int64_t>(done);
  good_events_ = events_;
  checksum_ = Crc32c(pending_, checksum_);
  const std::lock_guard stats_lock(stats_mutex_);
  stats_.bytes = static_cast<std::uint64_t>(good_size_);
  stats_.cycles += pending_cycles_;
  pending_.clear();
  pending_cycles_ = 0;
  return true;
}

void LogWriter::SetError(const char* why) noexcept {
  try {
    stats_.last_error = why;
  } catch (const std::exception&) {
    stats_.last_error.clear();
  }
}

void LogWriter::LosePending(const char* why) noexcept {
  {
    const std::lock_guard stats_lock(stats_mutex_);
    SetError(why);
    stats_.lost_cycles += pending_cycles_;
  }
  pending_.clear();
  pending_cycles_ = 0;
  events_ = good_events_;
  // Half an event in the file would hide the next one from readers. On a device or pipe there is nothing to
  // cut.
  if (::ftruncate(fd_, good_size_) == 0) ::lseek(fd_, good_size_, SEEK_SET);
}

}  // namespace contour
