#include "tools/contour/result_line.h"

#include <cstdio>

namespace contour {

std::string ResultLine(const ProgramResult& r) {
  char text[128];
  std::snprintf(text, sizeof text, ": %.1f s", r.seconds);
  std::string line = r.program + text;
  if (r.encoder_peak_um && r.encoder_rms_um) {
    std::snprintf(text, sizeof text, ", contour error peak %.2f um rms %.2f um at the encoder",
                  *r.encoder_peak_um, *r.encoder_rms_um);
    line += text;
    if (r.table_peak_um) {
      std::snprintf(text, sizeof text, " (table %.2f)", *r.table_peak_um);
      line += text;
    }
  }
  line += ", " + std::to_string(r.faults) + (r.faults == 1 ? " fault" : " faults");
  if (!r.log.empty()) line += ", log " + r.log;
  return line;
}

}  // namespace contour
