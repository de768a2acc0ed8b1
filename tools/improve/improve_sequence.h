#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/diagnosis/result/finding.h"
#include "tools/improve/improve_machine.h"
#include "tools/improve/kept_model.h"

namespace contour::improve {

struct ImproveRequest {
  std::string axis;
  WorkingSpace space;
  Placed path, check;                    ///< the model is fitted on the first and judged on the second
  std::vector<ProgramText> experiments;  ///< that are run where the path leaves something open
  std::vector<ProgramText> shaking;      ///< those of them that are run always: no path shows the screw
  PerAxis<PlanLimits> limits;
  std::size_t passes = 3;       ///< that count, after one in which estimators settle
  double machine_time_s = 0.0;  ///< at most, all motion counted
};

/// A program drawn again and again with one model.
struct Series {
  std::vector<Drawing> path, check;  ///< the first of each is the one in which estimators settle
};

/// A record and what was found in it.
struct Diagnosed {
  std::string on;    ///< what was recorded
  std::string open;  ///< what it leaves open; empty: nothing
  double seconds = 0.0;
  diagnosis::Diagnosis found;
};

/// A model that came of a diagnosis.
struct Candidate {
  std::string from;  ///< what had been recorded
  bool decided = false;
  ModelConfig model;
};

/// A candidate as it drew.
struct Trial {
  std::string from;
  ModelConfig model;
  Series drawn;
  Comparison path, check;
  Judgement judgement;
};

struct ImproveResult {
  MachineConfig machine;  ///< as it was
  Series before;
  std::vector<Diagnosed> diagnosed;
  std::vector<std::string> experiments, left_out;
  std::vector<Trial> tried;
  std::optional<ModelConfig> yardstick;  ///< of what stands between motor and table, for all drawings
  std::optional<std::size_t> best;  ///< of those tried, whether it is kept or not; nothing: none came out
  double machine_time_s = 0.0;
  Judgement judgement;

  [[nodiscard]] const Trial* chosen() const { return best ? &tried[*best] : nullptr; }
};

/// What is found in records of the axis; the engine of `contour diagnose`.
using DiagnoseAxis =
    std::function<diagnosis::Diagnosis(const diagnosis::AxisLog&, const diagnosis::StatedAxis&)>;

/// Draws, diagnoses, has the experiments run that decide, loads the models that come of it, draws again and
/// keeps the best. Throws ConfigError where there is no time for that, before anything moves. Whatever ends
/// it early, an operator's no, an interrupt or a fault, the torque is off and the old model loaded when it
/// throws; after a fault it waits until the machine has been reset for that. What it throws says so where the
/// old model is not back.
class ImproveSequence {
 public:
  ImproveSequence(ImproveMachine& machine, ImproveRequest request, DiagnoseAxis diagnose);

  ImproveResult Run();

 private:
  void RunSteps();
  void RefuseTooLittleTime() const;
  /// Nothing: cycles were lost, and there is no time to run it once more.
  std::optional<Series> DrawAll(const std::string& when);
  std::optional<Drawing> Draw(const Placed& program, double reserved_s);
  [[nodiscard]] std::vector<Placed> WithWay(const Placed& program);
  [[nodiscard]] double Left_s(double reserved_s) const {
    return request_.machine_time_s - result_.machine_time_s - reserved_s;
  }
  void Find();
  void Experiment(const std::vector<ProgramText>& programs, const std::string& why, const std::string& on);
  void Diagnose(const std::string& on);
  [[nodiscard]] std::vector<Candidate> Candidates() const;
  void TakeYardstick();
  void TryAll(const std::vector<Candidate>& candidates);
  void Load(const ModelConfig& model, const std::string& then);
  [[nodiscard]] Trial Judged(const Candidate& candidate, Series drawn, std::size_t candidates) const;
  void KeepBest();
  void Restore();
  void RestoreOnceIdle();

  ImproveMachine& machine_;
  ImproveRequest request_;
  DiagnoseAxis diagnose_;
  ImproveResult result_;
  std::vector<diagnosis::AxisLog> logs_;
  std::vector<ProgramText> run_;  ///< experiments, so that none is run again
  double series_s_ = 0.0;         ///< that drawing all of it took, ways and repeats included
  bool enabled_ = false, loaded_ = false;
  std::string newest_;  ///< model that was loaded last
};

/// Largest error of each pass that counts, by the place that knows most: the scale, else what is believed of
/// the table.
std::vector<double> Peaks_um(const std::vector<Drawing>& drawings, const ImproveRequest& request,
                             const ProgramText& program, const MachineConfig& yardstick);

}  // namespace contour::improve
