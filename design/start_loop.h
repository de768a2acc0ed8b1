#pragma once

#include <string>

#include "config/machine_config.h"
#include "design/loop_search.h"
#include "design/start_set.h"

namespace contour {

/// The loop that an axis is commissioned with, found from its catalogue data.
struct StartLoop {
  FoundLoop found;
  std::string wrong;  ///< why it must not move the axis; empty: it may
};

/// The best loop on all of StartSet: within the limits of its members, or where none is, stable on all of
/// them with a peak of at most 10. It is slow where the doubt is wide. Throws std::invalid_argument when the
/// axis itself cannot be.
StartLoop FindStartLoop(const LoopAxis& axis, double period_s, int threads, const CatalogueDoubt& doubt = {});

/// What is wrong with a loop that is there already for commissioning; empty: nothing.
std::string WhyNotToStartWith(const LoopAxis& axis, const LoopTuning& tuning, double period_s,
                              const CatalogueDoubt& doubt = {});

/// Why the loops that a machine runs must not commission it: they have to be stable for all that the models
/// leave open (StartSet). One message with what to do; empty: they may, or nothing uses them.
std::string WhyLoopsMayNotStart(const MachineConfig& machine);

}  // namespace contour
