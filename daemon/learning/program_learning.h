#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "config/machine_config.h"
#include "core/cycle_record.h"
#include "daemon/learning/learnt_program.h"
#include "daemon/learning/measured_pass.h"
#include "daemon/program/path_generator.h"

namespace contour {

/// What has been learnt of a program, for people.
struct LearningReport {
  std::size_t passes = 0;  ///< that taught something
  double last_peak_um = 0.0;
  double best_peak_um = 0.0;
  std::string refused;  ///< why the program that ran last taught nothing; empty: it did, or was stopped
};

/// Learns the programs that run again and again, when the machine file says so. Nothing of it is in the
/// cycle: the points of the next pass are shifted before they are handed to it, so the log holds them as it
/// does all points, and a replay needs nothing else.
///
/// What was learnt is used for the same program from the same place only. It is forgotten with a fault, when
/// gains change, and when the daemon ends.
class ProgramLearning {
 public:
  explicit ProgramLearning(const MachineConfig& machine);

  [[nodiscard]] bool learns() const { return config_.enabled; }
  /// A program is about to be handed out: shifted by what its last pass taught. `text` tells programs apart;
  /// it is asked for where something may be learnt. The arithmetic of a pass is done here. One thread at a
  /// time, and not the cycle's; gives what there is to say of the passes so far.
  std::optional<LearningReport> Prepare(const std::function<std::string()>& text,
                                        const PerAxis<double>& start_m, std::uint32_t program_id,
                                        PathGenerator& generator);
  /// Every cycle, in order; any thread but the cycle's.
  void Consume(const CycleRecord& record);
  /// Any thread.
  void Forget();

 private:
  struct Entry {
    std::string text;
    PerAxis<double> start_m;
    std::uint64_t points = 0;
    std::shared_ptr<const MotionPlan> plan;
    LearntProgram learnt;
  };
  /// A pass under way or over.
  struct Pass {
    std::uint32_t program_id = 0;
    MeasuredPass measured;
    bool over = false;
  };
  [[nodiscard]] std::string LearnFrom(const MeasuredPass& pass);
  Entry& Find(const std::string& text, const PerAxis<double>& start_m, const PathGenerator& generator);

  LearningConfig config_;
  double period_s_;
  std::vector<Mechanics> mechanics_;
  std::vector<double> acceleration_m_s2_;
  // Of Prepare alone:
  std::list<Entry> entries_;  // the one that ran last first
  std::uint64_t known_forgets_ = 0;
  std::mutex mutex_;  // guards what follows
  std::uint64_t forgets_ = 0;
  std::optional<Pass> pass_;
};

}  // namespace contour
