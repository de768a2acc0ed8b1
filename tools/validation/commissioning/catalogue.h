#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "design/start_loop.h"
#include "tools/machine/load_emulated_machine.h"

namespace contour {

/// What a catalogue says of an axis that nobody has measured: masses within 30 %, stiffness, friction and
/// bristle each within a factor of 2, even over that range as the seed draws them; one friction for both
/// directions, break-away 1.25 of it; damping two thirds. The stated uncertainties are those of the ranges.
ModelConfig CatalogueModel(const EmulatedAxisConfig& is, ModelConfig model, std::uint64_t seed);

/// An axis's loop and file as they are when commissioning begins: catalogue data and StartLoop for every
/// axis, none where no loop holds it, `full` with linear friction.
/// What `known` has, by machine and seed, is not searched again: the axes of these machines are alike.
using KnownLoops = std::map<std::string, StartLoop>;
void StateCatalogue(EmulatedMachineFile& file, std::uint64_t seed, KnownLoops& known);

}  // namespace contour
