#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

// Changes of an axis of the emulated machine, as text: analysis and the emulator do not know each other.
namespace contour::diagnosis {

/// `key=value` as `--set` takes it, below `emulator.axes.<name>.`.
using Assignments = std::vector<std::string>;

/// An entry of a YAML map in one line; numbers read back as the same double.
struct MapEntry {
  MapEntry(std::string_view key, double number);
  MapEntry(std::string_view key, const std::vector<double>& numbers);
  MapEntry(std::string_view key, const std::vector<std::string>& maps);
  MapEntry(std::string_view key, std::string_view word);

  std::string text;
};

std::string MapText(std::initializer_list<MapEntry> entries);

/// "effects.cogging={amplitude_Nm: 0.1, ...}"
std::string SetEffect(std::string_view effect, std::initializer_list<MapEntry> entries);

/// "lag_ms=0.2"
std::string SetKey(std::string_view key, double number);

}  // namespace contour::diagnosis
