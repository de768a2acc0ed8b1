#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/axis_model/axis_model.h"
#include "analysis/prediction_error/forward_filter.h"

namespace contour::diagnosis {

/// The forward model linearised about one run, row by row: what a small signal does to innovation and states
/// afterwards. Whatever enters as a signal (a force, a friction level, a reading) is worth a few
/// multiplications per row instead of a run.
struct LinearModel {
  std::size_t rows = 0, stride = 0;
  int states = 0;                   ///< 4 or 5 rigid, 6 or 7 with two inertias; the last if friction is soft
  int table_state = 0;              ///< the one that the table's position follows
  std::vector<float> step;          ///< per transition, as LaneColumns has it
  std::vector<std::uint8_t> valid;  ///< rows whose innovation corrects
  std::vector<std::size_t> begins;  ///< rows after gaps, from which nothing is left of what was before
  Signal innovation, table, velocity;  ///< of the run itself; velocity of the body that carries friction
  double viscous = 0.0;
  bool friction_on_load = false;
};

LinearModel Linearise(const FilterSetup& setup, const AxisModel& model);

/// Signals of one column, as AxisModel takes them; null where there is none.
struct LinearInput {
  SharedSignal motor_force, load_force, level, reading_error;
};

/// What the inputs do: innovation (and table position, when asked for), to first order.
std::vector<FilterRun> LinearColumns(const LinearModel& model, std::span<const LinearInput> inputs,
                                     bool table);

/// The difference of two models, where it lies in signals alone: then true. Viscous terms become forces.
bool SignalsOnly(const LinearModel& linear, const AxisModel& without, const AxisModel& with, double per,
                 LinearInput& input, SharedSignal& scale_error_m);

}  // namespace contour::diagnosis
