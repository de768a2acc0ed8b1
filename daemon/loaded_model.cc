#include "daemon/loaded_model.h"

#include "config/config_error.h"

namespace contour {

std::string ModelOverride(const std::string& model) {
  const std::size_t equals = model.find('=');
  if (equals == std::string::npos || equals == 0)
    throw ConfigError(
        {"--model " + model + ": expected an axis and its model, as in --model x={lead_mm: 5}"});
  return "axes." + model.substr(0, equals) + ".model=" + model.substr(equals + 1);
}

std::vector<std::string> LoadedModelTexts(const std::vector<std::string>& models) {
  std::vector<std::string> out;
  for (const std::string& model : models)
    out.push_back("axis " + model.substr(0, model.find('=')) +
                  " runs with a model that contourd was handed while it ran, not with the machine file's; "
                  "contourd started anew runs with that");
  return out;
}

std::vector<std::string> WithoutModelOf(const std::string& axis, std::vector<std::string> overrides) {
  const std::string key = "axes." + axis + ".model=";
  std::erase_if(overrides, [&](const std::string& o) { return o.starts_with(key); });
  return overrides;
}

}  // namespace contour
