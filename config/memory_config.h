#pragma once

#include <string>

#include "core/visit.h"

namespace contour {

/// `memory:` of a machine file: what the daemon learns of the machine and keeps for its next start.
struct MemoryConfig {
  bool friction_map = true;
  std::string directory;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Optional("friction_map", friction_map,
               "learn how friction varies along the stroke, and use it after the next start; axes with "
               "drive.absolute_encoder only");
    v.Optional("directory", directory,
               "where it is kept; empty: the service's state directory, else the user's");
  }
};

}  // namespace contour
