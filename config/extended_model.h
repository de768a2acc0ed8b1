#pragma once

#include "config/model_config.h"

namespace contour {

/// A model whose extensions that are nothing but other numbers for the basic model are in those numbers:
/// asymmetric_coulomb, stribeck, compliance and torque_constant. The others are left for those who can use
/// them.
struct ExtendedModel {
  MechanicsConfig mechanics;
  FrictionConfig friction;
  double added_delay_s = 0.0;  ///< input_delay
  double added_lag_s = 0.0;    ///< current_lag
};

ExtendedModel Extended(const ModelConfig& model);

}  // namespace contour
