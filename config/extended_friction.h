#pragma once

#include <initializer_list>

#include "config/model_config.h"

// What extensions do to a friction model's numbers, wherever these are kept and on whichever side.
namespace contour {

struct FrictionNumbers {
  double *Fs_plus, *Fs_minus, *Fc_plus, *Fc_minus, *vs, *sigma0, *sigma1, *sigma2;
  double vs_per_rad_s;  ///< what 1 rad/s of the motor is in the unit of vs
};

void Apply(const AsymmetricCoulombExtension& e, const FrictionNumbers& f);
void Apply(const StribeckExtension& e, const FrictionNumbers& f);
/// All that resists, seen in units of the torque that is asked for: friction, and the inertias, stiffness and
/// damping beside it.
void Apply(const TorqueConstantExtension& e, const FrictionNumbers& f, std::initializer_list<double*> beside);

}  // namespace contour
