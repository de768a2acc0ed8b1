#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "analysis/axis_model/stated_axis.h"
#include "analysis/diagnosis/causes/specimen.h"
#include "analysis/recording/axis_log.h"
#include "tools/plant_emulator/effects_config.h"

// Effects hidden in the emulated machine, for diagnosis to find: what is drawn, and what is known of it.
namespace contour::hidden {

enum class Strength { kClear, kModerate, kBarely };

/// Share of the residual's variance (DIAGNOSIS: clear 55 %, moderate 13 %, barely visible 2 %).
double ShareOf(Strength strength);
const char* Name(Strength strength);

/// How the machine differs from what its model can express, in addition to the hidden effect.
enum class Misfit {
  kNone,
  kMaxwellSlip,  ///< another friction law
  kTimingError,  ///< readings 30 us late
  kNoiseLevel,   ///< noise three times as high in the second half
  kDelayAndLag,  ///< 20 % more lag, and 20 % of a cycle more delay
};
const char* Name(Misfit misfit);

/// Of the program: everything, or what ten clear effects and as many clean machines can afford in a test.
enum class Length { kLong, kShort };
const char* Name(Length length);

/// What the emulated axis is. Friction at the table, symmetric, LuGre.
struct TrueAxis {
  double lead_mm = 5.0;
  double motor_inertia_kgm2 = 5e-5;
  double table_mass_kg = 10.0;
  double stiffness_N_um = 40.0;
  double damping_Ns_m = 1100.0;
  double Fc_N = 40.0;
  double Fs_N = 50.0;
  double vs_mm_s = 2.0;
  int stribeck_exponent = 1;
  double sigma0_N_m = 5e6;
  double sigma1_Ns_m = 3000.0;
  double sigma1_decay_mm_s = 2.0;
  double sigma2_Ns_m = 500.0;
  double lag_ms = 0.2;
  double encoder_counts_per_rev = 1048576.0;
  double scale_counts_per_mm = 0.0;  ///< 0: no scale
  double torque_noise_Nm = 0.003;
  double rated_torque_Nm = 0.637;
  double half_stroke_mm = 120.0;
  double vs_rad_s() const;
  double radius_m_rad() const;
};

/// Everything that a seed decides but the size of the effect.
struct Setting {
  std::uint64_t seed = 0;
  TrueAxis truth;
  TrueAxis stated;     ///< within its uncertainty of the truth
  bool rigid = false;  ///< the stated model knows no screw
  bool temperature = false;
  bool second_axis = false;
  Length length = Length::kLong;
  Misfit misfit = Misfit::kNone;
  std::string program;  ///< YAML
};

/// A hidden effect with its size: the main parameter of its kind.
struct Hidden {
  std::string kind;  ///< a cause of diagnosis, or of OutsideKinds()
  double size = 0.0;
  double order = 0.0;
  double phase_rad = 0.0;
  double second = 0.0;  ///< another parameter of the kind, as the case may be
  /// What an answer must hold within its intervals, by the catalogue's names; known once the log is recorded.
  std::map<std::string, double> truth;
};

using diagnosis::LogSpan;

/// A recorded log as the user's files would give it.
struct Recorded {
  diagnosis::AxisLog log;
  diagnosis::StatedAxis stated;
};

}  // namespace contour::hidden
