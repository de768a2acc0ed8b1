#pragma once

#include <string>

#include "analysis/identification/identification.h"

namespace contour::identify {

/// Why nothing of a result may be used, in plain words and with what to do; empty: it may. Numbers that are
/// none, intervals of no width, a fit that did not settle, a record with holes, errors of prediction far
/// above the encoder's noise, an axis called rigid whose shaking shows an antiresonance.
std::string WhyUnusable(const Identification& id);

/// Why a record says nothing of the screw; empty: it does. The share of the table then is as stated, and
/// without a linear scale so is stiffness, which no interval says. `shaken`: it was shaken for its screw.
std::string WhyNoScrew(const Identification& id, bool shaken);

/// Why not even to begin again from a result, with its intervals as what is left open; empty: it is nearer
/// than a catalogue. It may be too unsure to be used, or lack something that the axis has.
std::string WhyNoBeginning(const Identification& id);

}  // namespace contour::identify
