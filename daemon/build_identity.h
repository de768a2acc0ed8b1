#pragma once

#include <string>

namespace contour {

/// Version, compiler, kind of build, and a digest of the sources that decide what the cycle computes: what
/// must agree for a recorded run to come out bit for bit, and for a saved state of the cycle to be read.
std::string BuildIdentity();

}  // namespace contour
