#pragma once

#include <atomic>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "tools/plant_emulator/truth.h"

namespace contour {

/// Writes truth rows as a table (CSV): sync_number, time_s, free_running (0 or 1), then for every axis
/// <axis>_<field of AxisTruth>; drive_state by name. Not for the real-time thread: it formats and, now and
/// then, writes.
class TruthWriter final : public TruthSink {
 public:
  /// Throws std::runtime_error when the file cannot be written.
  TruthWriter(const std::string& path, std::vector<std::string> axis_names);
  ~TruthWriter() override;

  void OnTruth(const TruthRow& row) noexcept override;
  /// Hands over what has gathered, so that others can read it. After a write that failed nothing is written.
  void Flush() noexcept;
  /// False once a write failed (disk full); message for people in error().
  [[nodiscard]] bool ok() const noexcept { return error_ == 0; }
  [[nodiscard]] int error() const noexcept { return error_; }

 private:
  struct Close {
    void operator()(std::FILE* f) const noexcept { std::fclose(f); }
  };
  void Put(double value) noexcept;
  void Put(const char* text, std::size_t length) noexcept;

  std::unique_ptr<std::FILE, Close> file_;
  std::vector<char> buffer_;
  std::size_t used_ = 0;
  std::size_t axes_;
  std::atomic<int> error_{0};  ///< told by another thread
};

}  // namespace contour
