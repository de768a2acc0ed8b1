#include "daemon/program/spool.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

namespace contour {
namespace {

int NamelessFile() {
  const std::string directory = SpoolDirectory();
  int file = open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file < 0) {
    // Not every file system has files without a name.
    std::string name = directory + "/contour-program-XXXXXX";
    file = mkostemp(name.data(), O_CLOEXEC);
    if (file >= 0) unlink(name.c_str());
  }
  if (file < 0)
    throw SpoolError("a long program needs a file in " + directory + " (TMPDIR): " + std::strerror(errno));
  return file;
}

off_t OffsetOf(std::size_t page) { return static_cast<off_t>(page * Spool::kPageBytes); }

}  // namespace

std::string SpoolDirectory() {
  const char* const named = std::getenv("TMPDIR");
  return named != nullptr && *named != '\0' ? named : "/var/tmp";
}

Spool::Spool(const Spool& other) { *this = other; }

Spool& Spool::operator=(const Spool& other) {
  if (this == &other) return *this;
  *this = Spool();
  std::array<std::byte, kPageBytes> bytes{};
  for (std::size_t at = 0; at < other.size_; at += bytes.size()) {
    const std::size_t n = std::min(bytes.size(), other.size_ - at);
    other.Read(at, bytes.data(), n);
    Append(bytes.data(), n);
  }
  return *this;
}

Spool::Spool(Spool&& other) noexcept { Take(other); }

Spool& Spool::operator=(Spool&& other) noexcept {
  if (this != &other) {
    if (file_ >= 0) close(file_);
    Take(other);
  }
  return *this;
}

void Spool::Take(Spool& other) noexcept {
  size_ = std::exchange(other.size_, 0);
  slot_of_ = std::exchange(other.slot_of_, {});
  slots_ = std::exchange(other.slots_, {});
  uses_ = other.uses_;
  file_ = std::exchange(other.file_, -1);
}

Spool::~Spool() {
  if (file_ >= 0) close(file_);
}

void Spool::Write(Slot& slot) const {
  if (file_ < 0) file_ = NamelessFile();
  std::size_t done = 0;
  while (done < kPageBytes) {
    const ssize_t n = pwrite(file_, slot.bytes->data() + done, kPageBytes - done,
                             OffsetOf(slot.page) + static_cast<off_t>(done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0)
      throw SpoolError("no room for a long program in " + SpoolDirectory() +
                       " (TMPDIR): " + std::strerror(n < 0 ? errno : ENOSPC));
    done += static_cast<std::size_t>(n);
  }
  slot.written = true;
}

Spool::Slot& Spool::FreeSlot() const {
  if (slots_.size() < kPagesHeld) {
    slots_.emplace_back();
    slots_.back().bytes = std::make_unique<std::array<std::byte, kPageBytes>>();
    return slots_.back();
  }
  Slot& oldest = *std::min_element(slots_.begin(), slots_.end(),
                                   [](const Slot& a, const Slot& b) { return a.used < b.used; });
  if (!oldest.written) Write(oldest);
  slot_of_[oldest.page] = kNowhere;
  return oldest;
}

Spool::Slot& Spool::SlotOf(std::size_t page) const {
  if (slot_of_[page] == kNowhere) {
    Slot& slot = FreeSlot();
    // Whatever happens to the file, no page is taken for another.
    slot.page = page;
    slot.used = 0;
    slot.written = true;
    for (std::size_t done = 0; done < kPageBytes;) {
      const ssize_t n = pread(file_, slot.bytes->data() + done, kPageBytes - done,
                              OffsetOf(page) + static_cast<off_t>(done));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0)
        throw SpoolError("what is kept of a long program cannot be read again: " +
                         std::string(std::strerror(n < 0 ? errno : EIO)));
      done += static_cast<std::size_t>(n);
    }
    slot_of_[page] = static_cast<std::int32_t>(&slot - slots_.data());
  }
  Slot& slot = slots_[static_cast<std::size_t>(slot_of_[page])];
  slot.used = ++uses_;
  return slot;
}

void Spool::Append(const void* data, std::size_t bytes) {
  const std::lock_guard lock(mutex_);
  const auto* from = static_cast<const std::byte*>(data);
  while (bytes > 0) {
    const std::size_t page = size_ / kPageBytes, at = size_ % kPageBytes;
    if (page == slot_of_.size()) {
      Slot& fresh = FreeSlot();
      fresh.page = page;
      slot_of_.push_back(static_cast<std::int32_t>(&fresh - slots_.data()));
    }
    Slot& slot = SlotOf(page);
    slot.written = false;
    const std::size_t n = std::min(bytes, kPageBytes - at);
    std::memcpy(slot.bytes->data() + at, from, n);
    from += n;
    bytes -= n;
    size_ += n;
  }
}

void Spool::Read(std::size_t at, void* data, std::size_t bytes) const {
  const std::lock_guard lock(mutex_);
  auto* to = static_cast<std::byte*>(data);
  while (bytes > 0) {
    const Slot& slot = SlotOf(at / kPageBytes);
    const std::size_t n = std::min(bytes, kPageBytes - at % kPageBytes);
    std::memcpy(to, slot.bytes->data() + at % kPageBytes, n);
    to += n;
    at += n;
    bytes -= n;
  }
}

std::size_t Spool::bytes_in_memory() const {
  const std::lock_guard lock(mutex_);
  return slots_.size() * (kPageBytes + sizeof(Slot)) + slot_of_.capacity() * sizeof(std::int32_t);
}

}  // namespace contour
