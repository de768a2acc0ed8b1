#include "daemon/program/gcode/codes.h"

namespace contour {
namespace {

struct Row {
  int first;
  int last;
  std::size_t group;
};
constexpr Row kGCodes[] = {
    {0, 0, kMotion},
    {10, 10, kMotion},
    {20, 20, kMotion},
    {30, 30, kMotion},
    {730, 730, kMotion},
    {810, 810, kMotion},
    {820, 820, kMotion},
    {830, 830, kMotion},
    {850, 850, kMotion},
    {890, 890, kMotion},
    {kNoMotion, kNoMotion, kMotion},
    {40, 40, kNonModal},
    {100, 100, kNonModal},
    {280, 280, kNonModal},
    {300, 300, kNonModal},
    {520, 520, kNonModal},
    {530, 530, kNonModal},
    {920, 923, kNonModal},
    {170, 170, kPlane},
    {180, 180, kPlane},
    {190, 190, kPlane},
    {900, 900, kDistance},
    {910, 910, kDistance},
    {901, 901, kCentreDistance},
    {911, 911, kCentreDistance},
    {930, 930, kFeedMode},
    {940, 940, kFeedMode},
    {200, 200, kUnits},
    {210, 210, kUnits},
    {400, 400, kCutterCompensation},
    {430, 430, kToolLength},
    {490, 490, kToolLength},
    {980, 980, kRetract},
    {990, 990, kRetract},
    {540, 540, kCoordinateSystem},
    {550, 550, kCoordinateSystem},
    {560, 560, kCoordinateSystem},
    {570, 570, kCoordinateSystem},
    {580, 580, kCoordinateSystem},
    {590, 593, kCoordinateSystem},
    {610, 611, kPathControl},
    {640, 640, kPathControl},
    {970, 970, kSpindleMode},
    {80, 80, kLatheMode},
};
constexpr Row kMCodes[] = {
    {0, 2, kStopping}, {30, 30, kStopping}, {6, 6, kToolChange},
    {3, 5, kSpindle},  {7, 9, kCoolant},    {48, 48, kOverride},
};

struct Refusal {
  int first;
  int last;
  const char* what;
};
constexpr char kG41[] = "cutter compensation; let the CAM program write the path of the tool's centre";
constexpr char kG84[] =
    "a canned cycle that turns or stops the spindle; write its moves, M and S words one by one (or take G81, "
    "G82, G83, G73, G85 or G89)";
constexpr char kG70[] =
    "turning cycles here; where G70 is meant as inches and G71 as millimetres, write G20 and G21";
constexpr Refusal kRefusedG[] = {
    {50, 53, "splines"},
    {70, 70, "diameters"},
    {171, 171, "planes of U, V and W"},
    {181, 181, "planes of U, V and W"},
    {191, 191, "planes of U, V and W"},
    {281, 281, "stored positions"},
    {301, 301, "stored positions"},
    {330, 331, "motion in step with the spindle"},
    {380, 389, "probing"},
    {410, 429, kG41},
    {431, 439, "tool lengths"},
    {700, 719, kG70},
    {720, 729, "turning cycles"},
    {740, 749, kG84},
    {760, 769, "thread cutting"},
    {840, 849, kG84},
    {860, 889, kG84},
    {950, 950, "feed per revolution"},
    {960, 960, "constant surface speed"},
};
constexpr char kM100[] =
    "M100 to M199 are programs of LinuxCNC's user, or a printer's heaters and fans; leave it out";
constexpr Refusal kRefusedM[] = {
    {19, 19, "orienting the spindle"},
    {49, 53, "switching overrides"},
    {60, 60, "pallets"},
    {61, 61, "tool numbers"},
    {62, 68, "inputs and outputs"},
    {70, 73, "saving modal state"},
    {98, 99, "subprograms by M98"},
    {100, 199, kM100},
};

template <std::size_t n, std::size_t m>
CodeGroup Find(int code, const Row (&rows)[n], const Refusal (&refusals)[m]) {
  for (const Row& row : rows)
    if (code >= row.first && code <= row.last) return {true, row.group, nullptr};
  for (const Refusal& refusal : refusals)
    if (code >= refusal.first && code <= refusal.last) return {false, 0, refusal.what};
  return {};
}

}  // namespace

CodeGroup GroupOfG(int tenfold) { return Find(tenfold, kGCodes, kRefusedG); }
CodeGroup GroupOfM(int number) { return Find(number, kMCodes, kRefusedM); }

std::string NameOfG(int tenfold) {
  const std::string name = "G" + std::to_string(tenfold / 10);
  return tenfold % 10 == 0 ? name : name + "." + std::to_string(tenfold % 10);
}

}  // namespace contour
