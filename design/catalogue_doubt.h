#pragma once

#include "config/model_config.h"

namespace contour {

/// How far an axis may be from its model before it is commissioned: as far as a catalogue leaves open, unless
/// the model states that it is known better.
struct CatalogueDoubt {
  double masses_rel = 0.3;        ///< motor and table, either way
  double stiffness_factor = 2.0;  ///< of the screw, up or down
  double friction_factor = 2.0;   ///< levels and bristle, up or down
};

/// Two standard deviations of what `uncertainty:` of the model states; the catalogue's doubt where it states
/// nothing, and no more than that.
CatalogueDoubt DoubtOf(const ModelConfig& model);

/// Of a model from a record that showed nothing of the screw: how much of the mass is the motor's, and its
/// stiffness where nothing else showed that, are then as open as they were in the model as stated.
void LeaveScrewOpen(ModelConfig& found, const ModelConfig& stated, bool stiffness_seen);

}  // namespace contour
