#pragma once

#include "daemon/program/shapes.h"

namespace contour {

/// What switches outputs for a program: spindle, coolant, tools. One thread.
class ProgramOutputs {
 public:
  virtual ~ProgramOutputs() = default;
  /// Is there an output for it?
  [[nodiscard]] virtual bool Listens(const GcodeEvent& event) const = 0;
  /// Begin to switch it; Done() when it is switched, and had its time.
  virtual void Do(const GcodeEvent& event) = 0;
  [[nodiscard]] virtual bool Done() = 0;
  /// The operator has let a program go on that waited at this event.
  virtual void Over(const GcodeEvent& event) = 0;
  /// The program does not run any more: everything off.
  virtual void Off() = 0;
  /// Again and again: the machine's cycles go on.
  virtual void Confirm() = 0;
  /// Outputs that a program had on went off without it; true once.
  [[nodiscard]] virtual bool TakeLoss() = 0;
};

}  // namespace contour
