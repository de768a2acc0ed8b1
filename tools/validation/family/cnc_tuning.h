#pragma once

#include <array>
#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "tools/validation/family/family_run.h"

namespace contour {

/// A number that the rival `cnc` is tuned by.
struct CncKey {
  const char* key;
  double min;
  double max;
  double start;
  bool logarithmic;
};
/// Those of `control.cnc`; the last is the drive's dual loop, where there is a scale.
const std::array<CncKey, 10>& CncKeys();

/// What tuning made of `cnc` on one machine.
struct CncTuned {
  std::string machine;
  FamilyPlant plant = FamilyPlant::kIdeal;
  std::array<double, 10> values{};  ///< the last 0: the position loop is closed on the motor
  double before_um = 0.0;
  double after_um = 0.0;
  int evaluations = 0;
};

/// As assignments on the machine file.
std::vector<std::string> CncAssignments(const CncTuned& tuned);

struct CncTask {
  std::string machine;
  FamilyPlant plant = FamilyPlant::kIdeal;
  bool dual_loop = false;  ///< with the position loop closed on the scale
  char program = 'C';      ///< what it is tuned on, and that alone
  int evaluations_per_key = 20;
};
/// By the search by which all rivals are tuned, for the largest error at the table: what the family scores. A
/// run that stopped counts as a millimetre.
CncTuned TuneCnc(const std::string& folder, const CncTask& task);

/// One line per machine and plant; reads what it wrote. Throws ConfigError with file and line.
void WriteCncTuned(std::ostream& out, const std::vector<CncTuned>& tuned);
std::vector<CncTuned> ReadCncTuned(const std::string& path);

/// Null when that machine was not tuned.
const CncTuned* FindCncTuned(const std::vector<CncTuned>& tuned, const FamilySetting& setting);

}  // namespace contour
