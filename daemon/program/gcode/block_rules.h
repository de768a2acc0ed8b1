#pragma once

#include "daemon/program/gcode/block.h"

namespace contour {

/// What of the modal state decides whether a block is sound.
struct RuleContext {
  int modal_motion = kNoCode;
  bool absolute = true;
  int plane = 170;
  bool referenced = false;  ///< the machine knows where it is
};

/// Finds the block's motion and refuses words that nothing in the block uses, by the rules of RS274/NGC.
void CheckBlock(Block& block, const RuleContext& context);

}  // namespace contour
