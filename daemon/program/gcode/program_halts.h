#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "daemon/program/shapes.h"

namespace contour {

/// Who does something about a program's events.
struct EventUse {
  bool optional_stop = false;                         ///< M1 waits for the operator
  std::function<bool(const GcodeEvent&)> switches{};  ///< an output is switched; empty: there are no outputs
  /// Why an output that there is cannot do it, or nothing; empty as the one before.
  std::function<std::string(const GcodeEvent&)> problem{};
  bool tool_change_holds = true;  ///< M6 waits for the operator
};

/// A place at which a program waits, at rest: for an operator, or until outputs are switched.
struct ProgramHalt {
  std::size_t before_move = 0;
  std::vector<GcodeEvent> events;  ///< in their order; none is empty
};

/// Marks the events that something is done about; the moves before them end in a stop. Throws ProgramError,
/// under the program's `name`, where an output cannot do what is asked for.
void UseEvents(GcodeMoves& program, const std::string& name, const EventUse& use);

/// The places at which the marked events are carried out, in order. MotionPlan::Halts counts them.
std::vector<ProgramHalt> HaltsOf(const GcodeMoves& program);

/// Without its number: M3, S, T. By this the status names what has an output, and messages what has none.
std::string NameOf(const GcodeEvent& event);

/// As a program writes it: M0, S1000, T5 M6.
std::string WordOf(const GcodeEvent& event);

}  // namespace contour
