#include "analysis/recording/log_columns.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <set>
#include <string_view>

#include "config/config_error.h"
#include "config/key_hints.h"

namespace contour::diagnosis {
namespace {

constexpr std::array<std::string_view, 17> kQuantities = {
    "time_s",           "torque_Nm",          "motor_angle_rad",      "force_N",
    "position_m",       "position_rad",       "velocity_rad_s",       "velocity_m_s",
    "current_A",        "measured_torque_Nm", "measured_force_N",     "table_position_m",
    "temperature_degC", "axis2_position_m",   "reference_position_m", "reference_angle_rad",
    "temperature_c"};

std::string Lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

/// "Motor angle [rad]" and "torque (N m)" as our own columns have them: motor_angle_rad, torque_Nm.
std::string WithUnitBehind(std::string_view header) {
  const std::size_t open = header.find_last_of("[(");
  if (open == std::string_view::npos || open == 0 || !(header.ends_with(header[open] == '[' ? ']' : ')')))
    return std::string(header);
  std::string name(header.substr(0, open)), unit;
  while (!name.empty() && name.back() == ' ') name.pop_back();
  std::replace(name.begin(), name.end(), ' ', '_');
  for (const char c : header.substr(open + 1, header.size() - open - 2))
    if (c == '/')
      unit += '_';
    else if (c != ' ')
      unit += c;
  if (unit.empty() || name.ends_with("_" + unit)) return name;
  return name + "_" + unit;
}

std::string Joined(const std::vector<std::string>& names) {
  std::string out;
  for (std::size_t i = 0; i < names.size() && i < 40; ++i) out += (i == 0 ? "" : ", ") + names[i];
  return out + (names.size() > 40 ? ", ..." : "");
}

template <class T>
std::optional<T> NumberIn(const std::string& text) {
  T number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return {};
  return number;
}

class Finder {
 public:
  Finder(const std::string& file, const std::vector<std::string>& header, const std::string& axis,
         const ColumnNames& names)
      : file_(file), header_(header), names_(names), axis_(axis) {
    for (const std::string& name : header) lower_.push_back(Lower(WithUnitBehind(name)));
    if (axis_.empty()) ChooseAxis();
  }

  [[nodiscard]] bool Named(const std::string& quantity) const { return names_.contains(quantity); }
  /// Named on the command line, and the other one not.
  [[nodiscard]] bool NamedInstead(const std::string& quantity, const std::string& of) const {
    return Named(quantity) && !Named(of);
  }
  [[nodiscard]] std::optional<LogColumn> Find(const std::string& quantity) const {
    if (const auto named = names_.find(quantity); named != names_.end()) {
      if (const auto at = ByHeader(named->second)) return at;
      throw ConfigError({file_ + ": --columns: " + quantity + "=" + named->second +
                         ": no such column; there are " + Joined(header_)});
    }
    if (const auto at = Column(axis_.empty() ? quantity : axis_ + "_" + quantity)) return at;
    return Column(quantity);
  }
  /// The same under either of two spellings; the one that was named on the command line first.
  [[nodiscard]] std::optional<LogColumn> Find(const std::string& a, const std::string& b) const {
    const auto at = NamedInstead(b, a) ? std::nullopt : Find(a);
    return at ? at : Find(b);
  }
  [[nodiscard]] LogColumn Demand(const std::string& quantity) const {
    if (const auto at = Find(quantity)) return *at;
    throw ConfigError({file_ + ": no column " + quantity + "; there are " + Joined(header_) +
                       ". Name it by --columns " + quantity + "=HEADER"});
  }
  [[nodiscard]] const std::string& axis() const { return axis_; }
  [[nodiscard]] std::vector<std::string> OtherAxes() const {
    std::vector<std::string> others;
    for (const std::string& name : Axes())
      if (name != Lower(axis_)) others.push_back(name);
    return others;
  }

 private:
  [[nodiscard]] std::optional<LogColumn> Column(const std::string& name) const {
    const auto at = std::find(lower_.begin(), lower_.end(), Lower(name));
    if (at == lower_.end()) return {};
    return LogColumn{static_cast<std::size_t>(at - lower_.begin())};
  }
  /// A header, or the number of a column from 1; HEADER*FACTOR where no header is called so.
  [[nodiscard]] std::optional<LogColumn> ByHeader(const std::string& text) const {
    const auto at = std::find(header_.begin(), header_.end(), text);
    if (at != header_.end()) return LogColumn{static_cast<std::size_t>(at - header_.begin())};
    const auto number = NumberIn<std::size_t>(text);
    if (number && *number >= 1 && *number <= header_.size()) return LogColumn{*number - 1};
    const std::size_t star = text.rfind('*');
    if (star == std::string::npos) return {};
    auto column = ByHeader(text.substr(0, star));
    const auto factor = NumberIn<double>(text.substr(star + 1));
    if (!column || !factor || *factor == 0.0) return {};
    column->factor *= *factor;
    return column;
  }
  /// Axes of one of our own tables: what stands before _motor_angle_rad.
  std::set<std::string> Axes() const {
    constexpr std::string_view kEnd = "_motor_angle_rad";
    std::set<std::string> axes;
    for (const std::string& name : lower_)
      if (name.ends_with(kEnd) && !name.starts_with("target") && name.find("_target") == std::string::npos)
        axes.insert(name.substr(0, name.size() - kEnd.size()));
    return axes;
  }
  void ChooseAxis() {
    const std::set<std::string> axes = Axes();
    if (axes.empty() || Column("motor_angle_rad") || names_.contains("motor_angle_rad") ||
        names_.contains("position_rad") || names_.contains("position_m"))
      return;
    if (axes.size() > 1)
      throw ConfigError(
          {file_ + ": holds the axes " + Joined({axes.begin(), axes.end()}) + "; say by --axis which one"});
    axis_ = *axes.begin();
  }

  const std::string& file_;
  const std::vector<std::string>& header_;
  const ColumnNames& names_;
  std::string axis_;
  std::vector<std::string> lower_;
};

}  // namespace

ColumnNames ParseColumnNames(const std::string& text) {
  ColumnNames names;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(',', at), text.size());
    const std::string item = text.substr(at, end - at);
    at = end + 1;
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == item.size())
      throw ConfigError({"--columns: found '" + item + "', expected name=header"});
    const auto known = std::find_if(kQuantities.begin(), kQuantities.end(), [&](std::string_view q) {
      return Lower(q) == Lower(item.substr(0, equals));
    });
    if (known == kQuantities.end()) {
      const KeyHint hint = NearestKey(item.substr(0, equals), {kQuantities.begin(), kQuantities.end()});
      std::string message = "--columns: " + item.substr(0, equals) + ": unknown quantity";
      message += hint.key.empty()
                     ? "; expected one of " + Joined({kQuantities.begin(), kQuantities.end() - 1})
                     : "; did you mean " + hint.key + "?";
      throw ConfigError({message});
    }
    const std::string name = *known == "temperature_c" ? "temperature_degC" : std::string(*known);
    if (!names.emplace(name, item.substr(equals + 1)).second)
      throw ConfigError({"--columns: " + name + " is named twice"});
  }
  return names;
}

namespace {

struct Command {
  const char* name;
  bool linear, measured, in_ampere;
};
/// In the order in which they count where a table has several: what was commanded acts as it is stated, a
/// reading is rounded and filtered; a current needs a constant besides.
constexpr Command kCommands[] = {{"torque_Nm", false, false, false},
                                 {"force_N", true, false, false},
                                 {"measured_torque_Nm", false, true, false},
                                 {"measured_force_N", true, true, false},
                                 {"current_A", false, true, true}};

/// A name that is given on the command line comes before one that the table has.
const Command* FindCommand(const Finder& finder) {
  if (finder.Named("force_N")) return &kCommands[1];
  for (const Command& c : kCommands)
    if (finder.Named(c.name)) return &c;
  for (const Command& c : kCommands)
    if (finder.Find(c.name)) return &c;
  return nullptr;
}

void FindMotion(const Finder& finder, LogColumns& columns) {
  const bool by_metres =
      finder.NamedInstead("position_m", "motor_angle_rad") && !finder.Named("position_rad");
  const auto angle = by_metres ? std::nullopt : finder.Find("motor_angle_rad", "position_rad");
  const auto metres = finder.Find("position_m");
  if (columns.in_ampere)
    columns.linear = !angle && (metres || (finder.Find("velocity_m_s") && !finder.Find("velocity_rad_s")));
  columns.position = columns.linear ? metres : angle;
  // A torque with the position of the table that its screw moves.
  columns.position_in_m = !columns.linear && !angle && metres.has_value();
  if (columns.position_in_m) columns.position = metres;
  columns.velocity = finder.Find(columns.linear || columns.position_in_m ? "velocity_m_s" : "velocity_rad_s");
  if (!columns.position && !columns.velocity)
    columns.position = finder.Demand(columns.linear ? "position_m" : "motor_angle_rad");
}

}  // namespace

LogColumns FindColumns(const std::string& file, const std::vector<std::string>& header,
                       const std::string& axis, const ColumnNames& names, bool rate_stated) {
  const Finder finder(file, header, axis, names);
  LogColumns columns;
  columns.time = rate_stated ? finder.Find("time_s") : finder.Demand("time_s");
  const Command* command = FindCommand(finder);
  if (command == nullptr)
    throw ConfigError({file + ": neither torque_Nm nor force_N; there are " + Joined(header) +
                       ". Name it by --columns torque_Nm=HEADER"});
  columns.linear = command->linear;
  columns.measured = command->measured;
  columns.in_ampere = command->in_ampere;
  columns.command = finder.Demand(command->name);
  FindMotion(finder, columns);
  columns.table_position = finder.Find("table_position_m");
  columns.temperature = finder.Find("temperature_degC", "temperature_c");
  columns.axis2_position = finder.Find("axis2_position_m");
  if (!columns.axis2_position && !finder.axis().empty())
    for (const std::string& other : finder.OtherAxes())
      if (!columns.axis2_position) columns.axis2_position = finder.Find(other + "_position_m");
  if (!columns.linear && !finder.NamedInstead("reference_position_m", "reference_angle_rad"))
    columns.reference = finder.Find("reference_angle_rad");
  if (!columns.reference) {
    columns.reference = finder.Find("reference_position_m");
    columns.reference_in_m = columns.reference.has_value();
  }
  if (!finder.axis().empty()) {
    columns.drive_state = finder.Find("drive_state");
    columns.fresh = finder.Find("feedback_fresh");
  }
  return columns;
}

}  // namespace contour::diagnosis
