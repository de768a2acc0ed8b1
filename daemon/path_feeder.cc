#include "daemon/path_feeder.h"

#include <utility>

namespace contour {

void PathFeeder::Begin(std::unique_ptr<PathGenerator> generator) {
  generator_ = std::move(generator);
  holding_ = false;
  mailbox_.SetPathSupply(true);
  Feed();
}

bool PathFeeder::Feed() {
  if (!generator_) return false;
  for (;;) {
    if (!holding_) {
      if (!generator_->Next(held_)) {
        Abandon();
        return false;
      }
      holding_ = true;
    }
    if (!mailbox_.PushPathPoint(held_)) return true;
    holding_ = false;
  }
}

void PathFeeder::Abandon() {
  generator_.reset();
  holding_ = false;
  mailbox_.SetPathSupply(false);
}

}  // namespace contour
