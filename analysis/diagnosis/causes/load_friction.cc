#include <array>
#include <cmath>
#include <string>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"
#include "config/number_text.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "load_friction";

// Time constants, in rows of the log, by which the load at nut and balls may lag behind the command. There is
// a coupling between motor and table even where the axis is stated as rigid; without a lag, what the loop
// does to its own errors from row to row would count as load. None, then by factors of two. Measured on logs
// of 1 kHz only; at another rate they are other times.
constexpr std::array kArrival_rows = {0.0, 1.0, 2.0, 4.0};

Signal Arriving(const Signal& force, double rows) {
  if (!(rows > 0.0)) return force;
  const double keep = std::exp(-1.0 / rows);
  Signal out(force.size());
  double carried = 0.0;
  for (std::size_t k = 0; k < force.size(); ++k) {
    carried = keep * carried + (1.0 - keep) * force[k];
    out[k] = carried;
  }
  return out;
}

/// Over the whole band, which the smoothed acceleration does not have; constant over each row.
void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  const Signals& s = *p.signals;
  const std::size_t n = p.rows();
  for (const double rows : kArrival_rows) {
    const Signal carried = Arriving(s.net_force, rows);
    const std::string label = rows > 0.0 ? "within " + RoundedText(rows) + " rows" : "";
    out.push_back(LinearEffect(
        {std::string(kName), label, static_cast<double>(kArrival_rows.size())}, Input::kLevel,
        {Make(2 * n, [&](std::size_t k) { return std::fabs(carried[k < n ? k : k - n]) / s.coulomb; })},
        5e-3));
  }
}

/// No load makes friction less.
bool Shrinks(const Problem&, const Effect&, const std::vector<double>& a) { return a[0] < 0.0; }

// The lag is one of four guesses. Sizes in five logs of another generator were off by -13 to 7 %, in a sixth,
// of an effect of 1 %, by 36 % (docs/laboratory/strangers.md).
constexpr ModelError kErrors[] = {{"friction_per_torque_rel", 0.1}};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw = [](const SpecimenMachine&, double, const UniformNumbers&) { return Drawn{.size = 0.05}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"friction_per_torque_rel", d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"friction_per_torque_rel", d.size}};
        },
    .largest_size = 0.5,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kTorque,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition load_friction;
constexpr CauseDefinition load_friction = {
    .name = kName,
    .words = "friction grows with the force that the screw carries",
    .advice = "Expect more friction under load and acceleration; check nut and bearing load.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = Shrinks,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"friction_per_torque_rel", fitted.amplitudes()[0]}};
        },
    .main_parameter = "friction_per_torque_rel",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.7; },
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = FiveSpeedsAndPulses,
    .shows_more_of = std::nullopt,
    .specimen = &kSpecimen,
    .common_factor = false,
    .in_scatter_only = false,
    .coupling = false,
    .takes_up_mismatch = false,
    .refuted_by_mismatch = false,
    .acts_at_reversals = false,
    .judged_at_scale = false,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
