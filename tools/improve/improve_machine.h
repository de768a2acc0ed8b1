#pragma once

#include <stdexcept>
#include <string>

#include "config/machine_config.h"
#include "tools/improve/drawing.h"
#include "tools/improve/working_space.h"

namespace contour::improve {

/// The operator said no, or an interrupt came.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The daemon's checks say no to a model. Nothing has changed.
class ModelRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The machine is not Idle: a fault has come, which says nothing of the model. Nothing has changed here
/// either.
class NotIdle : public ModelRefused {
 public:
  using ModelRefused::ModelRefused;
};

/// The machine and its operator, as improving a model needs them. Functions throw std::runtime_error when
/// something is not as it should be; the axes stand still then.
class ImproveMachine {
 public:
  virtual ~ImproveMachine() = default;

  /// As it runs, overrides and a loaded model in it.
  virtual MachineConfig Machine() = 0;
  virtual PerAxis<double> Position_m() = 0;
  /// Whether the operator agrees to this. Throws Refused when he does not.
  virtual void Ask(const std::string& what) = 0;
  virtual void Enable() = 0;
  virtual void Disable() = 0;
  /// Waits, as long as that takes, until the machine is Idle, and tells the operator so, and what for.
  /// Whether it had to wait. Throws Refused at an interrupt that comes meanwhile.
  virtual bool AwaitIdle(const std::string& what_for) = 0;
  /// Runs a program from where the machine stands, watched.
  virtual Drawing Run(const ProgramText& program) = 0;
  /// Another model of the improved axis (keys of `model:`), or with nothing the machine file's. Leads to
  /// Idle. Throws ModelRefused, and NotIdle.
  virtual void LoadModel(const std::string& yaml) = 0;
  virtual void Say(const std::string& line) = 0;
};

}  // namespace contour::improve
