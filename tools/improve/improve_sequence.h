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

struct ImproveResult {
  MachineConfig machine;  ///< as it was
  Series before, after;
  std::vector<Diagnosed> diagnosed;
  std::vector<std::string> experiments, left_out;
  std::optional<ModelConfig> fitted;  ///< nothing: no other model came out
  double machine_time_s = 0.0;
  std::optional<Comparison> path, check;
  Judgement judgement;
};

/// What is found in records of the axis; the engine of `contour diagnose`.
using DiagnoseAxis =
    std::function<diagnosis::Diagnosis(const diagnosis::AxisLog&, const diagnosis::StatedAxis&)>;

/// Draws, diagnoses, has the experiments run that decide, loads the model that comes of it, draws again and
/// keeps the better one. Whatever ends it early, an operator's no, an interrupt or a fault, the torque is off
/// and the old model loaded when it throws.
class ImproveSequence {
 public:
  ImproveSequence(ImproveMachine& machine, ImproveRequest request, DiagnoseAxis diagnose);

  ImproveResult Run();

 private:
  void RunSteps();
  Series DrawAll(const std::string& when);
  Drawing Draw(const Placed& program);
  void Find();
  void Experiment(const std::vector<ProgramText>& programs, const std::string& why, const std::string& on);
  void Diagnose(const std::string& on);
  void FitModel();
  void Load(const ModelConfig& model);
  void Decide();
  void Restore();
  [[nodiscard]] double TimeOfSeries_s() const;

  ImproveMachine& machine_;
  ImproveRequest request_;
  DiagnoseAxis diagnose_;
  ImproveResult result_;
  std::vector<diagnosis::AxisLog> logs_;
  std::vector<ProgramText> run_;  ///< experiments, so that none is run again
  bool enabled_ = false, loaded_ = false;
};

/// Largest error of each pass that counts, by the place that knows most: the scale, else what is believed of
/// the table.
std::vector<double> Peaks_um(const std::vector<Drawing>& drawings, const ImproveRequest& request,
                             const ProgramText& program, const MachineConfig& yardstick);

}  // namespace contour::improve
