#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "core/cycle_record.h"
#include "daemon/program/placed_program.h"

namespace contour {

/// Where programs count from. It stays where it is until it is set anew, or the axes' positions mean
/// something else than they did: then programs are refused until it is set again. Any thread.
class ProgramZero {
 public:
  /// Where the axes stand now.
  void Set(const CycleRecord& now);
  /// Positions are about to mean something else; `why` tells operators.
  void Lose(std::string why);

  struct Found {
    std::optional<Placement> place;  ///< nothing: refused
    bool set_now = false;  ///< there is none: to be set where the machine stands if the program runs
    std::string refused;
  };
  /// Of a program that starts now. `here`: it counts from where the machine stands, whatever zero is.
  Found ForProgram(const CycleRecord& now, bool here);

  /// Nothing: there is none.
  [[nodiscard]] std::optional<PerAxis<double>> zero_m() const;

 private:
  [[nodiscard]] std::string Lost(const CycleRecord& now) const;

  mutable std::mutex mutex_;  // guards what follows
  std::optional<PerAxis<double>> zero_m_;
  PerAxis<ReferenceState> references_;  ///< of the axes when it was set
  std::string lost_;                    ///< why there is none any more
};

}  // namespace contour
