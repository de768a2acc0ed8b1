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

std::vector<std::string> WithoutModelOf(const std::string& axis, std::vector<std::string> overrides) {
  const std::string key = "axes." + axis + ".model=";
  std::erase_if(overrides, [&](const std::string& o) { return o.starts_with(key); });
  return overrides;
}

}  // namespace contour
