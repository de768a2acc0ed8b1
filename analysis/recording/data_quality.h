#pragma once

#include <cstddef>

namespace contour::diagnosis {

struct DataQuality {
  std::size_t rows = 0, missing = 0, stale = 0, outliers = 0;
};

}  // namespace contour::diagnosis
