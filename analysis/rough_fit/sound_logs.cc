#include "analysis/rough_fit/sound_logs.h"

#include <cstddef>

#include "analysis/prediction_error/wrong_readings.h"
#include "analysis/rough_fit/wrong_units.h"

namespace contour::diagnosis {

SoundLogs MakeSound(std::span<AxisLog> logs, const StatedAxis& stated) {
  SoundLogs out;
  std::size_t wrong = 0;
  for (AxisLog& log : logs) {
    TakeOutWrongReadings(log, stated.position_step);
    wrong += log.wrong_readings;
    if (out.unusable.empty()) out.unusable = WrongUnits(log, stated);
  }
  if (wrong > 0)
    out.note = "Single wrong readings of the position were left out: " + std::to_string(wrong) + ".";
  return out;
}

}  // namespace contour::diagnosis
