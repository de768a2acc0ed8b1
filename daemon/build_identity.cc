#include "daemon/build_identity.h"

#include <source_digest.h>
#include "core/version.h"

namespace contour {

std::string BuildIdentity() {
  return "contourd " + std::string(kVersion) + ", " + __VERSION__ +
#ifdef __OPTIMIZE__
         ", optimised"
#else
         ", not optimised"
#endif
         ", sources " CONTOUR_SOURCE_DIGEST;
}

}  // namespace contour
