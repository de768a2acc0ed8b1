#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tools/machine/load_emulated_machine.h"

namespace contour {

/// What the emulated machine has besides what its file says.
enum class FamilyPlant { kIdeal, kRough };
/// What the controllers believe: the file's catalogue data, or a model that is nearly right.
enum class FamilyModel { kNear, kCatalogue };

constexpr std::array<std::string_view, 2> kFamilyPlants{"ideal", "rough"};
constexpr std::array<std::string_view, 2> kFamilyModels{"near", "catalogue"};

/// One change of the emulated machine, the model left alone.
struct FamilyVariation {
  std::string_view name;
  std::vector<std::string> set;
};

/// What a run's machine is made of.
struct FamilySetting {
  std::string machine;  ///< of config/family
  FamilyPlant plant = FamilyPlant::kIdeal;
  FamilyModel model = FamilyModel::kNear;
  std::string variation{};         ///< a name of FamilyVariations(); empty: none
  bool maxwell_slip = false;       ///< instead of the file's friction law
  std::vector<std::string> set{};  ///< put on top
};

/// "k_minus_30" and so on: each alone.
const std::vector<FamilyVariation>& FamilyVariations();

/// Machines of the folder, by name.
std::vector<std::string> FamilyMachines(const std::string& folder);

/// Assignments on the machine file; throws ConfigError naming what does not exist.
std::vector<std::string> FamilyAssignments(const std::string& folder, const FamilySetting& setting);

/// Friction over stiffness of the emulated machine, m: the mean over axes and directions of break-away and
/// Coulomb levels, over the screw's stiffness. The family's unit of errors.
double WindUp_m(const EmulatorConfig& emulator);

}  // namespace contour
