#include "daemon/drive_warnings.h"

#include <algorithm>
#include <cstddef>

#include "drivers/cia402/drive_state.h"

namespace contour {

std::vector<std::string> DriveWarnings(const CycleRecord& record, std::span<const std::string> axis_names) {
  std::vector<std::string> warnings;
  for (std::size_t i = 0; i < std::min(record.axes.size(), axis_names.size()); ++i)
    if ((record.axes[i].feedback.statusword & statusword::kWarning) != 0)
      warnings.push_back("axis " + axis_names[i] +
                         ": its drive warns (bit 7 of the statusword) of what may become a fault; its own "
                         "program or display says what it is");
  return warnings;
}

}  // namespace contour
