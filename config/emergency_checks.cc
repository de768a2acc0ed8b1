#include "config/emergency_checks.h"

namespace contour {

std::vector<ConfigProblem> CheckEmergencyReactions(const DriveConfig& drive, const std::string& key) {
  std::vector<ConfigProblem> problems;
  for (const auto& [codes, reaction] : drive.emergency_reaction) {
    const std::string where = key + ".emergency_reaction." + codes;
    const std::optional<EmergencyClass> parsed = ParseEmergencyClass(codes);
    if (!parsed) {
      problems.push_back({where, "found '" + codes +
                                     "', expected an error code such as 0x4210, or a class of codes such as "
                                     "0x42xx or 0x4xxx"});
      continue;
    }
    const EmergencyReaction least = ReactionTo({parsed->code, 0});
    if (reaction < least)
      problems.push_back({where, "found " + std::string(Name(reaction)) + ", expected " +
                                     std::string(Name(least)) + " or stronger: '" +
                                     std::string(EmergencyText(parsed->code)) +
                                     "' may not be taken more lightly than that"});
  }
  return problems;
}

}  // namespace contour
