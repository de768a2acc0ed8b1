#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/drift.h"
#include "analysis/diagnosis/causes/experiments.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "viscous_drift";

/// A lubricant that warms up, of an axis without a thermometer. Nothing changes of what is not there.
void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  if (p.nominal.friction.s2 > 0.0) Drifts(p, kName, Input::kViscous, out);
}

constexpr ModelError kErrors[] = {{"change_rel", 0.03}};

}  // namespace

extern const CauseDefinition viscous_drift;
constexpr CauseDefinition viscous_drift = {
    .name = kName,
    .words = "viscous friction changes over the time of the log, as a lubricant's does that warms up",
    .advice =
        "Record the temperature and let the model use it; warm the axis up before identifying and before "
        "precise work.",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters = ChangeOverLog,
    .main_parameter = "change_rel",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = [](const Problem&) { return 0.7; },
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = SameStrokesWarmAndCold,
    .shows_more_of = std::nullopt,
    .specimen = nullptr,
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
