#pragma once

#include <string>

#include "daemon/program/program.h"

namespace contour {

/// Where in a program something is written; columns count from 1.
struct SourcePlace {
  const std::string* name = nullptr;
  int line = 0;
  int column = 0;
};

[[noreturn]] inline void Refuse(const SourcePlace& place, const std::string& what) {
  throw ProgramError(*place.name + ":" + std::to_string(place.line) + ":" + std::to_string(place.column) +
                     ": " + what);
}

}  // namespace contour
