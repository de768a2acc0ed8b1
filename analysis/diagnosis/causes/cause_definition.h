#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "analysis/diagnosis/causes/required.h"
#include "analysis/diagnosis/causes/specimen.h"
#include "analysis/diagnosis/result/finding.h"
#include "analysis/prediction_error/problem.h"
#include "config/model_config.h"
#include "estimator/extension_config.h"

// All that diagnosis knows of one cause, in one place. Every cause is a file of its own in this folder that
// defines one of these; nothing else in analysis/ or tools/ knows a cause by name.
namespace contour::diagnosis {

/// An effect of a point, at its amplitudes.
struct FittedEffect {
  const Problem& problem;
  const Point& point;
  std::size_t index;

  [[nodiscard]] const Effect& effect() const { return *point.effects[index]; }
  [[nodiscard]] const std::vector<double>& amplitudes() const { return point.amplitudes[index]; }
  [[nodiscard]] const Signals& signals() const { return *problem.signals; }
};

using NamedValues = std::map<std::string, double>;

/// What the residual depends on where something unknown is left.
enum class Quantity { kPosition, kSpeed, kTravelSinceReversal, kAngle, kTemperature, kTime };

/// How far a parameter lies off beyond its scatter on recorded machines of known size, one standard
/// deviation, relative (docs/laboratory/diagnosis_results.md).
struct ModelError {
  std::string_view parameter;
  double sigma_rel;
};

/// What an experiment is for people, and as YAML for `contour run`; empty when none decides.
struct Experiment {
  std::string text;
  std::string program;
};

struct StrokeShape;  // stroke_shapes.h
struct WaveSource;   // waves.h

/// How a model is extended by a cause.
struct ExtensionRule {
  /// Joins the cause to what the model has already. Rates refer to the log's first temperature.
  Required<void (*)(const Cause&, double first_temperature_degC, ExtensionsConfig&)> add;
  Required<void (*)(ExtensionsConfig&)> remove;
  /// Another number of the model and nothing added to it: the numbers of a stated axis have it in them.
  Required<bool> number_of_the_model;
  /// The extended machine in simulation: what `--set` would change in an axis of the emulated machine.
  /// `all`: the extensions to be simulated, `stated`: the model as stated. Null: not simulated.
  Required<Assignments (*)(const ModelConfig& stated, const ExtensionsConfig& all)> simulation;
};

struct CauseDefinition {
  /// In the result files.
  Required<std::string_view> name;
  /// What it is, and what to do about it, as an engineer would say it.
  Required<std::string_view> words;
  Required<std::string_view> advice;

  /// Candidate hypotheses: its effects on their grid. Null: none.
  Required<void (*)(const Problem&, std::vector<SharedEffect>&)> grid;
  /// Found by a scan over orders or frequencies. Null: not.
  Required<const WaveSource*> wave;
  /// Of one of its hypotheses, what no fit leads from one to the other; added to the name. Null: all are
  /// alike.
  Required<std::string_view (*)(const Effect&)> family;
  /// Whether a fit has gone where the cause is no longer what its name says. Null: it cannot.
  Required<bool (*)(const Problem&, const Effect&, const std::vector<double>& amplitudes)> implausible;

  /// Its parameters by name, in physical units, and the one that `smallest_detectable` is stated in.
  Required<NamedValues (*)(const FittedEffect&)> parameters;
  Required<std::string_view> main_parameter;
  Required<std::span<const ModelError>> model_errors;
  /// A shape over the stroke that is told with them. Null: none.
  Required<const StrokeShape*> shape;
  /// Beyond this, the first amplitude is no small flaw any more but another machine.
  Required<double (*)(const Problem&)> largest;

  /// Numbers of the base model that it is, in the order of its amplitudes: then the evidence is in the
  /// priors.
  Required<std::span<const std::string_view>> freed_terms;
  /// Null: no model is extended by it, something is to be mended (backlash, a payload that changes).
  Required<const ExtensionRule*> extension;
  /// What would tell it from its hypotheses within the stroke and torque of the log, `among_couplings` where
  /// a coupling is one of them. Null: none.
  Required<Experiment (*)(const Problem&, bool among_couplings)> experiment;
  /// The quantity whose unexplained rest that experiment shows more of.
  Required<std::optional<Quantity>> shows_more_of;
  /// How a machine is given it, for validation. Null: not.
  Required<const Specimen*> specimen;

  /// All forces change by one factor against the torque: the residual does not know it, the priors alone do.
  Required<bool> common_factor;
  /// Shows in the scatter of the residual and has no mean effect that could be fitted.
  Required<bool> in_scatter_only;
  /// An elastic coupling: added to a rigid model, another number of one with a screw. The stiffest that can
  /// be detected is stated; a fault makes it softer.
  Required<bool> coupling;
  /// Takes up what a friction-model mismatch leaves.
  Required<bool> takes_up_mismatch;
  /// Is no cause on a friction-model mismatch.
  Required<bool> refuted_by_mismatch;
  /// Acts where motion turns round, so that rows in presliding count for it even on a friction-model
  /// mismatch.
  Required<bool> acts_at_reversals;
  /// Shows on the linear scale alone.
  Required<bool> judged_at_scale;
  /// When a torque begins to act or a position was read.
  Required<bool> about_timing;
  /// What it does to an axis that slides or is stuck. Kinds that do the same are told apart by how the
  /// bristle bends, and by nothing else. Empty: nothing that another kind does.
  Required<std::string_view> same_in_sliding;
};

inline constexpr std::span<const ModelError> kNoModelErrors;
inline constexpr std::span<const std::string_view> kFreesNothing;

/// Kinds outside the catalogue, tried so that what they explain does not get a wrong name.
inline constexpr std::string_view kOutside = "outside:";

}  // namespace contour::diagnosis
