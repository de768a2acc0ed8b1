#include "config/key_hints.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <utility>

namespace contour {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 36> kUnits{{
    {"m", "m"},         {"mm", "mm"},         {"um", "um"},       {"nm", "nm"},     {"rad", "rad"},
    {"deg", "deg"},     {"s", "s"},           {"ms", "ms"},       {"us", "us"},     {"ns", "ns"},
    {"min", "min"},     {"s2", "s^2"},        {"s3", "s^3"},      {"N", "N"},       {"kN", "kN"},
    {"mN", "mN"},       {"Nm", "Nm"},         {"mNm", "mNm"},     {"kg", "kg"},     {"g", "g"},
    {"kgm2", "kg m^2"}, {"kgcm2", "kg cm^2"}, {"gcm2", "g cm^2"}, {"Ns", "N s"},    {"Nms", "Nm s"},
    {"Hz", "Hz"},       {"kHz", "kHz"},       {"degC", "degC"},   {"K", "K"},       {"bit", "bit"},
    {"kbit", "kbit"},   {"cycles", "cycles"}, {"rev", "rev"},     {"turn", "turn"}, {"rpm", "1/min"},
    {"Nms2", "Nm s^2"},
}};

const std::string_view* FindUnit(std::string_view token) {
  for (const auto& [name, text] : kUnits)
    if (name == token) return &text;
  return nullptr;
}

// The "1" of rate_1_K: one per kelvin.
bool IsInverse(const std::vector<std::string_view>& tokens, std::size_t at) {
  return tokens[at] == "1" && at + 1 < tokens.size();
}

std::vector<std::string_view> Tokens(std::string_view key) {
  std::vector<std::string_view> tokens;
  while (true) {
    const std::size_t at = key.find('_');
    tokens.push_back(key.substr(0, at));
    if (at == std::string_view::npos) return tokens;
    key.remove_prefix(at + 1);
  }
}

// What people vary without meaning another thing: capitals and underscores.
std::string Plain(std::string_view text) {
  std::string lower(text);
  std::erase(lower, '_');
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

std::size_t EditDistance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

}  // namespace

KeyParts SplitUnit(std::string_view key) {
  const std::vector<std::string_view> tokens = Tokens(key);
  std::size_t first = tokens.size();
  // "per" written out belongs to the unit, with what is counted before it: counts_per_rev, degC_per_count.
  // What is not counted but is a quantity of its own stays a stem: order_per_rev. Where more follows, it is
  // the name that has it: torque_per_acceleration_Nms2_m, amplitude_once_per_turn_um.
  const auto per = std::find(tokens.begin(), tokens.end(), "per");
  if (tokens.end() - per == 2 && per != tokens.begin()) {
    first = static_cast<std::size_t>(per - tokens.begin());
    const std::string_view before = tokens[first - 1];
    if (before == "counts" || FindUnit(before) != nullptr) --first;
  } else {
    while (first > 1 && tokens[first - 2] != "per" &&
           (FindUnit(tokens[first - 1]) != nullptr || IsInverse(tokens, first - 1)))
      --first;
  }
  KeyParts parts;
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    std::string& part = i < first ? parts.stem : parts.unit;
    if (!part.empty()) part += '_';
    part += tokens[i];
  }
  return parts;
}

std::string UnitText(std::string_view unit) {
  if (unit.empty()) return "";
  std::string text;
  for (const std::string_view token : Tokens(unit)) {
    if (token == "per") {
      if (text.empty()) text = "1";
      continue;
    }
    const std::string_view* known = FindUnit(token);
    if (!text.empty()) text += '/';
    text += known != nullptr ? *known : token;
  }
  return text;
}

KeyHint NearestKey(std::string_view unknown, const std::vector<std::string>& known) {
  const KeyParts mine = SplitUnit(unknown);
  for (const std::string& key : known) {
    const KeyParts theirs = SplitUnit(key);
    if (Plain(theirs.stem) == Plain(mine.stem) && theirs.unit != mine.unit) return {key, true};
  }
  KeyHint best;
  std::size_t best_distance = std::max<std::size_t>(2, mine.stem.size() / 3) + 1;
  for (const std::string& key : known) {
    const std::size_t distance = std::min(EditDistance(Plain(unknown), Plain(key)),
                                          EditDistance(Plain(mine.stem), Plain(SplitUnit(key).stem)));
    if (distance < best_distance) {
      best_distance = distance;
      best.key = key;
    }
  }
  return best;
}

}  // namespace contour
