#pragma once

#include <cstdint>
#include <string_view>

#include "core/controller_name.h"

namespace contour {

/// What `full` knows friction by.
enum class FrictionKind : std::uint8_t {
  kSrukf,   ///< states of a square-root unscented Kalman filter, beside one rigid mass
  kLinear,  ///< learnt along the reference, outside a loop that knows two inertias
};

constexpr std::string_view Name(FrictionKind k) noexcept {
  return k == FrictionKind::kSrukf ? "srukf" : "linear";
}
constexpr std::string_view Choices(FrictionKind) noexcept { return "srukf or linear"; }
constexpr bool FromName(std::string_view name, FrictionKind& out) noexcept {
  if (name != "srukf" && name != "linear") return false;
  out = name == "srukf" ? FrictionKind::kSrukf : FrictionKind::kLinear;
  return true;
}

/// Whether motor and table are two inertias to estimators and, in torque mode, to the loops.
constexpr bool KnowsTwoInertias(ControllerName controller, FrictionKind friction) noexcept {
  return controller == ControllerName::kFull && friction == FrictionKind::kLinear;
}

}  // namespace contour
