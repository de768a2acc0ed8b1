#pragma once

#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "config/machine_config.h"
#include "core/cycle_record.h"
#include "daemon/memory/stroke_friction.h"
#include "daemon/memory/stroke_friction_file.h"

namespace contour {

/// Where `memory.directory` leads; empty: nowhere.
std::filesystem::path MemoryDirectory(const MemoryConfig& config);

/// The friction maps of a machine from one start of the daemon to the next. At the start those that were kept
/// become part of the model, as overrides of the machine file: the cycle, logs and replay know them as such
/// and need know no more. While the machine runs, what comes out of the telemetry queue teaches the next
/// maps, and a thread of its own writes them.
///
/// Only for axes that know where they are (drive.absolute_encoder), whose model states no friction along the
/// stroke of its own, and with the controller `full`, which estimates the level and uses the map.
class FrictionMemory {
 public:
  FrictionMemory(const MachineConfig& machine, std::filesystem::path directory);
  ~FrictionMemory();
  FrictionMemory(const FrictionMemory&) = delete;
  FrictionMemory& operator=(const FrictionMemory&) = delete;

  /// What the kept maps put on top of the machine file.
  [[nodiscard]] std::vector<std::string> Overrides() const;
  /// Maps that are used, and those that are refused, with the reason; for the log.
  [[nodiscard]] const std::vector<std::string>& used() const { return used_; }
  [[nodiscard]] const std::vector<std::string>& refused() const { return refused_; }

  /// From the thread that empties the telemetry queue.
  void Consume(const CycleRecord& record);

  /// Begins to write what has been learnt, from time to time.
  void Start();
  /// Writes what is new, and ends the thread.
  void Finish();

 private:
  struct Axis {
    std::size_t index = 0;
    MappedAxis mapped;
    StrokeFriction friction;
    double viscous_Ns_m = 0.0;       // of the model
    std::size_t written_passes = 0;  // of the writing thread alone
    bool in_use = false;
  };
  void Work();
  void Write();

  std::filesystem::path directory_;
  std::vector<std::string> used_, refused_;
  std::mutex mutex_;  // guards axes_ once the thread runs, and finish_
  std::vector<Axis> axes_;
  std::string complained_;
  bool finish_ = false;
  std::condition_variable wake_;
  std::thread thread_;
};

}  // namespace contour
