#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/waves.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "outside:torque constant of angle";

constexpr WaveSource kWave = {.wave = Wave::kGainOfAngle, .has_order = AnyOrder, .free_order = false};

}  // namespace

extern const CauseDefinition outside_torque_constant_of_angle;
constexpr CauseDefinition outside_torque_constant_of_angle = {
    .name = kName,
    .words = "",
    .advice = "",
    .grid = nullptr,
    .wave = &kWave,
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
