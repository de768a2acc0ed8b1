#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "analysis/diagnosis/causes/assignments.h"
#include "analysis/diagnosis/causes/required.h"

// Machines that are given a cause, for validation: how one is drawn, what the emulated machine is told, and
// what an answer must then hold.
namespace contour::diagnosis {

/// What a machine must have for the cause to be visible at all.
struct SpecimenNeeds {
  bool scale = false;
  bool temperature = false;
  bool second_axis = false;
  bool no_stribeck = false;  ///< the model states none
  bool rigid = false;
  bool two_inertia = false;
};

/// What is drawn of a cause: its size, in units of its own, and what else it has.
struct Drawn {
  double size = 0.0;
  double order = 0.0;
  double phase_rad = 0.0;
  double second = 0.0;  ///< another parameter, as the case may be
};

/// The machine that it is drawn for.
struct SpecimenMachine {
  double friction_Nm = 0.0;  ///< true Coulomb level
  double vs_rad_s = 0.0;     ///< true Stribeck velocity
  double speed_limit_rad_s = 0.0;
  double emulated_stroke_mm = 0.0;  ///< over which shapes of the stroke have their periods
  double travel_mm = 0.0;           ///< of the program
  std::string other_axis;
};

/// One number after the other, uniform in [0, 1).
using UniformNumbers = std::function<double()>;

/// By the machine's own time.
struct RecordedTime {
  double begin_s = 0.0, duration_s = 0.0;
};

/// What the parameters of some causes refer to.
struct LogSpan {
  double begin_s = 0.0, end_s = 0.0;  ///< of the log, by the machine's own time
  double planned_end_s = 0.0;         ///< of the program: a linear drift is complete then
  double largest_speed_rad_s = 0.0;   ///< of the motor, within the log
  double speed_limit_rad_s = 0.0;     ///< at which a nonlinear viscous torque has its stated size
};

/// Which residual its strength is a share of.
enum class StrengthIn { kTorque, kScale, kScaleWhereFitted, kSecondDifference };

struct Specimen {
  Required<SpecimenNeeds> needs;
  /// A size to begin with, and the rest. `sign`: drawn already, as the phase is.
  Required<Drawn (*)(const SpecimenMachine&, double sign, const UniformNumbers&)> draw;
  Required<Assignments (*)(const Drawn&, const SpecimenMachine&, const RecordedTime&)> effect;
  /// By the names of the cause's parameters.
  Required<std::map<std::string, double> (*)(const Drawn&, const LogSpan&)> truth;
  /// Largest size that still is a machine.
  Required<double> largest_size;
  /// The size at `factor` times a value of the main parameter, without its sign.
  Required<double (*)(double factor, double main_parameter)> size_at;
  Required<StrengthIn> strength_in;
  /// Where no residual knows the strength: clear, moderate, barely.
  Required<std::optional<std::array<double, 3>>> sizes;
  /// Whether nobody could tell it from a machine that is as stated. Null: one can.
  Required<bool (*)(const Drawn&, bool barely)> undecidable;
};

inline constexpr double kNoLargestSize = 1e9;

/// For causes whose size is their main parameter.
double SizeAsStated(double factor, double main_parameter);

/// From low to high, evenly; the same in the logarithm.
double Between(double low, double high, const UniformNumbers& uniform);
double BetweenInLogarithm(double low, double high, const UniformNumbers& uniform);

/// Periods over the emulated stroke that are one or two over the travel of the program: the shape then has no
/// mean there, which would be part of the friction level (or of the scale's zero) and not of the shape.
double WholePeriods(const SpecimenMachine& machine, const UniformNumbers& uniform);

}  // namespace contour::diagnosis
