#include "daemon/program/gcode/parameters.h"

#include <algorithm>

namespace contour {

std::optional<double> Parameters::Value(int number) const {
  if (number >= 1 && number <= kLastLocal) return frames_.back().numbered[static_cast<std::size_t>(number)];
  if (number >= 1 && number <= kLast) return numbered_[static_cast<std::size_t>(number)];
  const int axis = number - kPosition;
  if (axis >= 0 && axis < static_cast<int>(position_.size()))
    return position_[static_cast<std::size_t>(axis)];
  return std::nullopt;
}

std::optional<double> Parameters::Value(std::string_view name) const {
  if (const auto modal = modal_.find(name); modal != modal_.end()) return modal->second;
  const auto& names = name.starts_with('_') ? global_ : frames_.back().named;
  const auto found = names.find(name);
  if (found != names.end()) return found->second;
  constexpr std::string_view kAxes = "xyzabcuvw";
  if (name.size() == 2 && name[0] == '_') {
    const std::size_t axis = kAxes.find(name[1]);
    if (axis != std::string_view::npos) return position_[axis];
  }
  return std::nullopt;
}

void Parameters::Set(const Assignment& assignment) {
  const auto number = static_cast<std::size_t>(assignment.number);
  if (assignment.number == 0) {
    (assignment.name.starts_with('_') ? global_ : frames_.back().named)[assignment.name] = assignment.value;
  } else if (assignment.number <= kLastLocal) {
    frames_.back().numbered[number] = assignment.value;
  } else {
    numbered_[number] = assignment.value;
  }
}

void Parameters::EnterSub(const std::vector<double>& arguments) {
  Frame frame;
  const std::size_t given = std::min<std::size_t>(arguments.size(), kLastLocal);
  std::copy_n(arguments.begin(), given, frame.numbered.begin() + 1);
  frames_.push_back(std::move(frame));
}

}  // namespace contour
