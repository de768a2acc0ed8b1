#include "config/name_checks.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>
#include <utility>

namespace contour {
namespace {

constexpr std::size_t kLongest = 32;
// Enough of a name to know it by.
constexpr std::size_t kShown = 40;

bool IsLetterOrDigit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

/// `dots`: dots are allowed, too, but not first. In a key they would divide it.
bool IsName(std::string_view name, bool dots) {
  const auto allowed = [dots](char c) {
    return IsLetterOrDigit(c) || c == '_' || c == '-' || (dots && c == '.');
  };
  return !name.empty() && name.size() <= kLongest && (IsLetterOrDigit(name.front()) || name.front() == '_') &&
         std::all_of(name.begin(), name.end(), allowed);
}

/// In quotes, with every byte that is no printable ASCII as \xNN.
std::string Quoted(std::string_view name) {
  std::string text = "'";
  for (const char c : name.substr(0, kShown)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) {
      text += c;
      continue;
    }
    std::array<char, 5> escaped{};
    std::snprintf(escaped.data(), escaped.size(), "\\x%02X", byte);
    text += escaped.data();
  }
  text += name.size() > kShown ? "'..." : "'";
  return text;
}

void CheckName(const char* key, std::string_view name, bool dots, std::vector<ConfigProblem>& problems) {
  if (IsName(name, dots)) return;
  problems.push_back({key, "found the name " + Quoted(name) + " (" + std::to_string(name.size()) +
                               " bytes), expected 1 to " + std::to_string(kLongest) +
                               " of A to Z, a to z, 0 to 9, _" + (dots ? ", - and ." : " and -") +
                               ", the first one a letter, a digit or _"});
}

}  // namespace

std::vector<ConfigProblem> CheckNames(const MachineConfig& machine) {
  std::vector<ConfigProblem> problems;
  CheckName("machine.name", machine.machine.name, true, problems);
  for (const auto& [name, bus] : machine.buses) CheckName("buses", name, false, problems);
  for (const auto& [name, axis] : machine.axes) CheckName("axes", name, false, problems);
  return problems;
}

}  // namespace contour
