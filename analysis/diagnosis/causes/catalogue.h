#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "analysis/diagnosis/causes/cause_definition.h"

namespace contour::diagnosis {

/// Every cause of the catalogue, in the order of the result files: cause_list.inc.
std::span<const CauseDefinition* const> AllCauses();

/// The same, and those from outside the catalogue after them.
std::span<const CauseDefinition* const> AllCandidates();

/// Null: none of the candidates has that name.
const CauseDefinition* FindCause(std::string_view name);
/// Throws std::out_of_range, with the name, when there is none.
const CauseDefinition& CauseNamed(std::string_view name);

/// The one that shows in the scatter of the residual only.
const CauseDefinition& CauseInScatter();

/// Whether two kinds do the same to an axis that slides; none does the same as itself.
/// Throws std::out_of_range as CauseNamed does.
bool SameInSliding(std::string_view kind, std::string_view other);

/// Every candidate's effects that need no search over orders or frequencies, on their grids.
std::vector<SharedEffect> CatalogueEffects(const Problem& problem);

}  // namespace contour::diagnosis
