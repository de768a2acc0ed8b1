#include "analysis/diagnosis/causes/kind_words.h"

#include <algorithm>

#include "analysis/diagnosis/causes/catalogue.h"
#include "config/key_hints.h"
#include "config/number_text.h"

namespace contour::diagnosis {

std::string KindWords(std::string_view kind) {
  const CauseDefinition* cause = FindCause(kind);
  const std::string_view words = cause == nullptr ? "" : *cause->words;
  return std::string(kind) + (words.empty() ? "" : ": " + std::string(words));
}

std::string KindAdvice(std::string_view kind) {
  const CauseDefinition* cause = FindCause(kind);
  return std::string(cause == nullptr ? "" : *cause->advice);
}

std::string ValueWords(std::string_view parameter, double value) {
  const std::string unit = SplitUnit(parameter).unit;
  if (parameter.ends_with("_rel")) return RoundedText(100.0 * value) + " %";
  return RoundedText(value) + (unit.empty() ? "" : " " + UnitText(unit));
}

std::string ParameterWords(std::string_view parameter) {
  std::string stem = parameter.ends_with("_rel") ? std::string(parameter.substr(0, parameter.size() - 4))
                                                 : SplitUnit(parameter).stem;
  std::replace(stem.begin(), stem.end(), '_', ' ');
  return stem;
}

}  // namespace contour::diagnosis
