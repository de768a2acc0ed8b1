#pragma once

#include "core/controller_name.h"
#include "drivers/cia402/drive_config.h"

namespace contour {

/// The mode that an axis's drive is run in. `full` works in either and takes the one that the machine file
/// states; of the others, `csp` and `cnc` leave the position loop to the drive.
constexpr DriveMode ModeFor(ControllerName controller, const DriveConfig& drive) noexcept {
  if (controller == ControllerName::kFull) return drive.mode;
  const bool cascade = controller == ControllerName::kCsp || controller == ControllerName::kCnc;
  return cascade ? DriveMode::kCsp : DriveMode::kCst;
}

}  // namespace contour
