#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

namespace contour {

/// Bytes that are appended and read again at any place. Up to a limit they are in memory; of what is more,
/// pages that were not used for longest go to a file without a name, which is gone when the spool is. Memory
/// then grows by 4 bytes for each page of 16 kB.
///
/// Reading is for any number of threads, appending for one that has the spool to itself.
class Spool {
 public:
  static constexpr std::size_t kPageBytes = 16384;
  static constexpr std::size_t kPagesHeld = 64;

  Spool() = default;
  Spool(const Spool& other);
  Spool& operator=(const Spool& other);
  Spool(Spool&& other) noexcept;
  Spool& operator=(Spool&& other) noexcept;
  ~Spool();

  /// Throws SpoolError when there is no room on disk.
  void Append(const void* data, std::size_t bytes);
  /// Throws SpoolError when the file cannot be read. Shape: at + bytes <= size().
  void Read(std::size_t at, void* data, std::size_t bytes) const;
  [[nodiscard]] std::size_t size() const { return size_; }

  [[nodiscard]] std::size_t bytes_in_memory() const;
  [[nodiscard]] bool on_disk() const { return file_ >= 0; }

 private:
  static constexpr std::int32_t kNowhere = -1;
  struct Slot {
    std::size_t page = 0;
    std::uint64_t used = 0;  ///< a count, not a time
    bool written = false;    ///< the file has it as it is
    std::unique_ptr<std::array<std::byte, kPageBytes>> bytes;
  };
  void Take(Spool& other) noexcept;
  Slot& SlotOf(std::size_t page) const;
  Slot& FreeSlot() const;
  void Write(Slot& slot) const;

  std::size_t size_ = 0;
  mutable std::mutex mutex_;                   ///< guards what follows while it is read
  mutable std::vector<std::int32_t> slot_of_;  ///< page; kNowhere: only in the file
  mutable std::vector<Slot> slots_;
  mutable std::uint64_t uses_ = 0;
  mutable int file_ = -1;
};

class SpoolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Where such files are made: TMPDIR, or /var/tmp, which is on a disk where /tmp is memory.
std::string SpoolDirectory();

}  // namespace contour
