#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>

#include "drivers/modbus/output_image.h"

namespace contour {

class ModbusConnection;

/// Brings a server's outputs to what is wanted, and keeps them there. Outputs are wanted for as long as who
/// wants them says so: after `silence` without a word they are off, and stay off until they are wanted anew.
/// Write(), Forget() and Release() by the thread of the connection, the rest by any other.
class OutputWriter {
 public:
  using Clock = std::chrono::steady_clock;
  explicit OutputWriter(Clock::duration silence) : silence_(silence) {}

  /// From now on. Its number, for written().
  std::uint64_t Want(const OutputImage& image);
  /// What is wanted is wanted still.
  void Confirm();
  /// Number of the newest image that stands at the server.
  [[nodiscard]] std::uint64_t written() const;
  /// Outputs that were on went off because nobody confirmed them; true once.
  [[nodiscard]] bool TakeSilence();

  /// Writes what differs, and one of the others again, so that a server that is gone, or that forgot, is
  /// noticed. False: a write failed; the rest is tried the next time.
  bool Write(ModbusConnection& connection);
  /// A new connection: nobody knows how the outputs stand.
  void Forget() { known_ = OutputImage(); }
  /// All off, once more; at the end.
  void Release(ModbusConnection& connection);

 private:
  /// What is to be now.
  [[nodiscard]] OutputImage Now(std::uint64_t& number);
  void ForgetOne(const OutputImage& image);
  bool Bring(const OutputImage& image, ModbusConnection& connection);

  const Clock::duration silence_;
  std::size_t again_ = 0;
  OutputImage known_;         ///< as last written; what is not in it is not known
  mutable std::mutex mutex_;  // guards what follows
  OutputImage wanted_;
  Clock::time_point confirmed_{};
  std::uint64_t number_ = 0;
  std::uint64_t written_ = 0;
  bool silent_ = false;
};

}  // namespace contour
