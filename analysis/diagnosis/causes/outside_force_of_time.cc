#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/effect_parts.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "outside:force of time";

constexpr int kHats = 16;

void Grid(const Problem& p, std::vector<SharedEffect>& out) {
  out.push_back(LinearEffect({std::string(kName), "", 1}, Input::kLoadForce, HatsOverTime(p.rows(), kHats),
                             0.01 * p.signals->ForceScale()));
}

}  // namespace

extern const CauseDefinition outside_force_of_time;
constexpr CauseDefinition outside_force_of_time = {
    .name = kName,
    .words = "",
    .advice = "",
    .grid = Grid,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters =
        [](const FittedEffect& fitted) {
          return NamedValues{{"amplitude", fitted.amplitudes()[0]}};
        },
    .main_parameter = "amplitude",
    .model_errors = kNoModelErrors,
    .shape = nullptr,
    .largest = nullptr,
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = nullptr,
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
