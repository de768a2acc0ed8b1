#include "analysis/diagnosis/causes/cause_definition.h"
#include "analysis/diagnosis/causes/experiments.h"

namespace contour::diagnosis::causes {
namespace {

constexpr std::string_view kName = "sample_jitter";

constexpr ModelError kErrors[] = {{"rms_us", 0.01}};

constexpr Specimen kSpecimen = {
    .needs = SpecimenNeeds{},
    .draw = [](const SpecimenMachine&, double, const UniformNumbers&) { return Drawn{.size = 2.0}; },
    .effect =
        [](const Drawn& d, const SpecimenMachine&, const RecordedTime&) {
          return Assignments{SetEffect(kName, {{"rms_us", d.size}})};
        },
    .truth =
        [](const Drawn& d, const LogSpan&) {
          return NamedValues{{"rms_us", d.size}};
        },
    .largest_size = 400.0,
    .size_at = SizeAsStated,
    .strength_in = StrengthIn::kSecondDifference,
    .sizes = std::nullopt,
    .undecidable = nullptr};

}  // namespace

extern const CauseDefinition sample_jitter;
constexpr CauseDefinition sample_jitter = {
    .name = kName,
    .words = "positions are not sampled exactly at their instants",
    .advice = "Latch the position at the SYNC; check the drive's synchronisation.",
    .grid = nullptr,
    .wave = nullptr,
    .family = nullptr,
    .implausible = nullptr,
    .parameters = nullptr,
    .main_parameter = "rms_us",
    .model_errors = kErrors,
    .shape = nullptr,
    .largest = nullptr,
    .freed_terms = kFreesNothing,
    .extension = nullptr,
    .experiment = SeveralConstantSpeeds,
    .shows_more_of = std::nullopt,
    .specimen = &kSpecimen,
    .common_factor = false,
    .in_scatter_only = true,
    .coupling = false,
    .takes_up_mismatch = false,
    .refuted_by_mismatch = false,
    .acts_at_reversals = false,
    .judged_at_scale = false,
    .about_timing = false,
    .same_in_sliding = ""};

}  // namespace contour::diagnosis::causes
