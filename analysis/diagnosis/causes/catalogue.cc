#include "analysis/diagnosis/causes/catalogue.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

namespace contour::diagnosis {

namespace causes {
#define CAUSE(name) extern const CauseDefinition name;
#define OUTSIDE(name) extern const CauseDefinition outside_##name;
#include "analysis/diagnosis/causes/cause_list.inc"
#undef CAUSE
#undef OUTSIDE
}  // namespace causes

namespace {

constexpr std::array kCandidates = {
#define CAUSE(name) &causes::name,
#define OUTSIDE(name) &causes::outside_##name,
#include "analysis/diagnosis/causes/cause_list.inc"
#undef CAUSE
#undef OUTSIDE
};

constexpr std::size_t kCauses = 0
#define CAUSE(name) +1
#define OUTSIDE(name)
#include "analysis/diagnosis/causes/cause_list.inc"
#undef CAUSE
#undef OUTSIDE
    ;

}  // namespace

std::span<const CauseDefinition* const> AllCandidates() { return kCandidates; }

std::span<const CauseDefinition* const> AllCauses() { return AllCandidates().first(kCauses); }

const CauseDefinition* FindCause(std::string_view name) {
  const auto* const at = std::find_if(kCandidates.begin(), kCandidates.end(),
                                      [&](const CauseDefinition* c) { return *c->name == name; });
  return at == kCandidates.end() ? nullptr : *at;
}

const CauseDefinition& CauseNamed(std::string_view name) {
  const CauseDefinition* found = FindCause(name);
  if (found == nullptr) throw std::out_of_range("there is no cause " + std::string(name));
  return *found;
}

const CauseDefinition& CauseInScatter() {
  return **std::find_if(kCandidates.begin(), kCandidates.end(),
                        [](const CauseDefinition* c) { return *c->in_scatter_only; });
}

bool SameInSliding(std::string_view kind, std::string_view other) {
  const std::string_view same = *CauseNamed(kind).same_in_sliding;
  return kind != other && !same.empty() && same == *CauseNamed(other).same_in_sliding;
}

std::vector<SharedEffect> CatalogueEffects(const Problem& problem) {
  std::vector<SharedEffect> out;
  for (const CauseDefinition* c : AllCandidates())
    if (c->grid != nullptr) (*c->grid)(problem, out);
  return out;
}

}  // namespace contour::diagnosis
