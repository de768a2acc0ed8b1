#pragma once

#include <vector>

#include "design/catalogue_doubt.h"
#include "design/loop_member.h"

namespace contour {

/// What the loop must bear with which an axis is commissioned: motor, table, stiffness and friction anywhere
/// within the doubt, together, sliding, held and on friction's falling slope; and one more cycle of delay.
/// What is far off has the limit of a late loop: it need not be good, but certain. The first member is the
/// axis as stated, sliding.
std::vector<LoopMember> StartSet(const LoopAxis& axis, const CatalogueDoubt& doubt);

}  // namespace contour
