#include <algorithm>
#include <numbers>
#include <vector>

#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"
#include "analysis/diagnosis/causes/experiments.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "backlash";

/// Of a rigid model: between its motor and a table on a stiff screw.
void AddPlay(double gap, AxisModel& m) {
  if (gap <= 0.0) return;
  const double all = m.motor_inertia;
  m.two_inertia = true;
  m.load_inertia = 0.4 * all;
  m.motor_inertia = 0.6 * all;
  const double w = 2.0 * std::numbers::pi * 400.0;
  m.stiffness = m.load_inertia * w * w;
  m.damping = 0.1 * w * m.load_inertia;
  m.friction_on_load = false;
  m.gap = gap;
}

/// The widest play that a fit begins at, and the next narrower one over it; it begins at a quarter of each,
/// too.
constexpr double kWidest_m = 40e-6, kNext = 0.25;
/// Of a count: rounding averages out over the rows of a stroke.
constexpr double kCountShare = 0.1;

/// Down to what the encoder still shows at the table: of a derivative that was taken at a much wider play,
/// a narrow one is nothing.
std::vector<double> Plays_m(const Problem& p) {
  constexpr double kNanometre = 1e-9;
  const double finest = std::max(kNanometre, kCountShare * p.stated.position_step * p.stated.table_per_q);
  std::vector<double> out = {kWidest_m};
  while (kNext * out.back() > finest) out.push_back(kNext * out.back());
  return out;
}

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  const double R = p.stated.table_per_q;
  const bool screw = p.nominal.two_inertia;
  const std::vector<double> plays = Plays_m(p);
  for (const double play : plays)
    out.push_back(
        Custom({std::string(kName), std::to_string(play * 1e6) + " um", static_cast<double>(plays.size())},
               {.steps = {play / R}, .start = {play / R}, .low = {0.0}, .high = {1e-3 / R}},
               [screw](const auto& a, AxisModel& m) {
                 if (screw)
                   m.gap = std::max(0.0, a[0]);
                 else
                   AddPlay(a[0], m);
               }));
}

constexpr ModelError kErrors[] = {{"gap_um", 0.08}};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{.two_inertia = true},
    .draw = [](const SpecimenMachine&, double, const UniformNumbers&) { return Drawn{.size = 2.0}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"gap_um", d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"gap_um", d.size}};
        },
    .largest_size = 200.0,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kScaleWhereFitted,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition backlash;
constexpr CauseDefinition backlash = {
    .name = kName,
    .words = "free play between motor and table",
    .advice =
        "Preload or replace the nut or coupling. Its size is a guide, and its interval says little: impacts "
        "are chaotic, "
        "and for an axis stated as rigid the share of the inertia behind the gap is assumed.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"gap_um", fitted.amplitudes()[0] * fitted.problem.stated.table_per_q * 1e6}};
        },
    .main_parameter = "gap_um",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem& p) { return 200e-6 / p.stated.table_per_q; },
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = GrowingReversalsOrChirp,
    .shows_more_of = std::nullopt,
    .specimen = &kSpecimen,
    .common_factor = false,
    .in_scatter_only = false,
    .coupling = false,
    .takes_up_mismatch = false,
    .refuted_by_mismatch = false,
    .acts_at_reversals = true,
    .judged_at_scale = false,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
