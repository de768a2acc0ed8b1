#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "core/cycle_input.h"
#include "drivers/modbus/io_config.h"
#include "drivers/modbus/io_snapshot.h"
#include "drivers/modbus/io_stats.h"
#include "drivers/modbus/lubrication.h"
#include "drivers/modbus/output_writer.h"

namespace contour {

class ModbusConnection;

/// Auxiliary I/O over Modbus TCP in a thread of its own: polls the inputs, works the outputs, and connects
/// again, ever more slowly up to every two seconds, when the server is gone.
class IoClient {
 public:
  explicit IoClient(const ModbusConfig& config);
  ~IoClient();
  IoClient(const IoClient&) = delete;
  IoClient& operator=(const IoClient&) = delete;

  void Start();
  /// Switches the outputs off if the server can be reached, and ends the thread.
  void Stop();

  /// What the I/O permits at now_ns (CLOCK_MONOTONIC). For the real-time loop: wait-free. Without a sample
  /// younger than timeout_ms nothing is fresh and both circuits are open.
  [[nodiscard]] IoInput Read(std::int64_t now_ns) const noexcept;
  /// The same in lock-step, where time stands still as long as the host holds us up: what was polled last
  /// holds until polls fail, however long ago that was.
  [[nodiscard]] IoInput ReadInLockstep() const noexcept;

  /// Totals since the start, for the lubrication. From any thread.
  void ReportMotion(double travel_m, double moving_s) noexcept;

  /// What programs switch; null: nothing.
  [[nodiscard]] OutputWriter* outputs() { return outputs_ ? &*outputs_ : nullptr; }

  [[nodiscard]] IoStats stats() const;

 private:
  void Work();
  [[nodiscard]] bool Connect();
  [[nodiscard]] bool Poll();
  [[nodiscard]] bool DriveOutputs();
  [[nodiscard]] bool Lubricate();
  void Fail(const std::string& what);
  [[nodiscard]] bool WaitForStop(int milliseconds);
  [[nodiscard]] IoInput From(const IoSample& sample, bool fresh) const noexcept;

  const ModbusConfig config_;
  IoSnapshot snapshot_;
  std::atomic<unsigned> failed_polls_{0};  ///< since the last good one
  std::atomic<double> travel_m_{0.0};
  std::atomic<double> moving_s_{0.0};

  // The thread's own.
  std::unique_ptr<ModbusConnection> connection_;
  std::optional<Lubrication> lubrication_;
  std::optional<OutputWriter> outputs_;
  std::optional<bool> coil_;  // as last written; unknown after a new connection

  mutable std::mutex mutex_;  // guards stats_ and stop_
  std::condition_variable wake_;
  bool stop_ = false;
  IoStats stats_;
  std::thread thread_;
};

}  // namespace contour
