#pragma once

#include <cstdint>

#include "tools/plant_emulator/axis_parameters.h"
#include "tools/plant_emulator/emulated_machine.h"
#include "tools/plant_emulator/object_dictionary.h"

namespace contour::plant {

inline constexpr std::int8_t kModeCsp = 8;
inline constexpr std::int8_t kModeCst = 10;

/// The objects of an emulated CiA 402 drive, with names for those that it looks at itself.
struct DriveObjects {
  DriveObjects(const AxisParameters& parameters, const EmulatedAxisPlacement& placement,
               double counts_per_rad);
  DriveObjects(const DriveObjects&) = delete;
  DriveObjects& operator=(const DriveObjects&) = delete;

  ObjectDictionary dictionary;

  ObjectEntry& controlword = dictionary.At(0x6040);
  ObjectEntry& statusword = dictionary.At(0x6041);
  ObjectEntry& error_code = dictionary.At(0x603F);
  ObjectEntry& quick_stop_option = dictionary.At(0x605A);
  ObjectEntry& shutdown_option = dictionary.At(0x605B);
  ObjectEntry& disable_option = dictionary.At(0x605C);
  ObjectEntry& fault_option = dictionary.At(0x605E);
  ObjectEntry& abort_option = dictionary.At(0x6007);
  ObjectEntry& mode = dictionary.At(0x6060);
  ObjectEntry& mode_display = dictionary.At(0x6061);
  ObjectEntry& position = dictionary.At(0x6064);
  ObjectEntry& velocity = dictionary.At(0x606C);
  ObjectEntry& torque = dictionary.At(0x6077);
  ObjectEntry& torque_demand = dictionary.At(0x6074);
  ObjectEntry& target_torque = dictionary.At(0x6071);
  ObjectEntry& torque_offset = dictionary.At(0x60B2);
  ObjectEntry& velocity_offset = dictionary.At(0x60B1);
  ObjectEntry& target_position = dictionary.At(0x607A);
  ObjectEntry& max_torque = dictionary.At(0x6072);
  ObjectEntry& max_torque_plus = dictionary.At(0x60E0);
  ObjectEntry& max_torque_minus = dictionary.At(0x60E1);
  ObjectEntry& window = dictionary.At(0x6065);
  ObjectEntry& window_timeout = dictionary.At(0x6066);
  ObjectEntry& following_error = dictionary.At(0x60F4);
  ObjectEntry& deceleration = dictionary.At(0x6084);
  ObjectEntry& quick_stop_deceleration = dictionary.At(0x6085);
  ObjectEntry& interpolation_value = dictionary.At(0x60C2, 1);
  ObjectEntry& interpolation_exponent = dictionary.At(0x60C2, 2);
  ObjectEntry* scale = dictionary.Find(0x60E4, 1);  ///< null without a linear scale
};

}  // namespace contour::plant
