#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <vector>

#include "analysis/axis_model/axis_model.h"

namespace contour::diagnosis {

/// The last signals that effects made for a number of theirs: the runs of a fit differ in other numbers, and
/// would make the same again. Few, since each is as long as the log.
class SignalCache {
 public:
  using Signals = std::vector<SharedSignal>;

  /// Of one effect.
  std::uint64_t NewOwner();
  Signals For(std::uint64_t owner, double number, const std::function<Signals()>& make);

 private:
  struct Entry {
    std::uint64_t owner = 0;
    double number = 0.0;
    Signals signals;
  };

  std::mutex mutex_;
  std::uint64_t owners_ = 0;
  std::list<Entry> entries_;  ///< the last used first
};

}  // namespace contour::diagnosis
