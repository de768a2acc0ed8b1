#include "daemon/program/gcode/interpreter.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "daemon/program/gcode/tool_table.h"

namespace contour {
namespace {

constexpr double kInch_m = 0.0254;
constexpr double kMillimetre_m = 1e-3;
constexpr double kMinute_s = 60.0;
// The slowest feed that inverse time may come to, in units per minute.
constexpr double kSlowestInverse = 0.1;
// Of one hole: more is a typing error, and would be unrolled for minutes.
constexpr double kMostPecks = 1e6;

double Norm(const AxisValues& a, const AxisValues& b, std::size_t from, std::size_t to) {
  double squared = 0.0;
  for (std::size_t k = from; k < to; ++k) squared += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(squared);
}

/// Length of a straight move as feeds count it: of X Y Z, or of U V W where X Y Z rest.
double FeedLength_m(const AxisValues& from, const AxisValues& to) {
  const double xyz = Norm(from, to, 0, 3);
  return xyz > 0.0 ? xyz : Norm(from, to, 3, kGcodeAxisCount);
}

unsigned Named(const Block& block) {
  unsigned named = 0;
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k)
    if (block.Has(kGcodeAxes[k]) || (k < 2 && block.IsPolar())) named |= 1U << k;
  return named;
}

}  // namespace

void GcodeInterpreter::Execute(Block& block, bool in_sub) {
  line_ = block.line;
  in_sub_ = in_sub;
  CheckBlock(block, {motion_, absolute_, plane_, settings_.zero_m.has_value()});
  CheckSeries(block);
  FeedMode(block);
  Feed(block);
  Events(block);
  if (block.G(kNonModal) == 40) {
    CanonicalMove dwell = NewMove(CanonicalMove::Kind::kDwell, position_m_);
    dwell.dwell_s = block.Get('p')->value;
    sink_(dwell);
  }
  Modes(block);
  NonModal(block);
  Motion(block);
  const int stop = block.m[kStopping].code;
  if (stop == 0 || stop == 1) Event(block, 'M', stop, 0.0);
  ended_ = ended_ || stop == 2 || stop == 30;
}

void GcodeInterpreter::FeedMode(const Block& block) {
  const int mode = block.G(kFeedMode);
  if (mode == kNoCode) return;
  inverse_time_ = mode == 930;
  if (mode == 940) feed_m_s_ = 0.0;  // a feed has to be stated anew
}

void GcodeInterpreter::Feed(const Block& block) {
  if (block.Has('f') && !inverse_time_) feed_m_s_ = block.Get('f')->value * unit_m_ / kMinute_s;
}

void GcodeInterpreter::Events(const Block& block) {
  if (block.Has('s')) Event(block, 'S', 0, block.Get('s')->value);
  if (block.Has('t')) Event(block, 'T', 0, block.Get('t')->value);
  for (const MGroup group : {kToolChange, kSpindle, kCoolant})
    if (block.m[group].code != kNoCode) Event(block, 'M', block.m[group].code, 0.0);
  if (block.Has('t')) selected_tool_ = static_cast<int>(std::lround(block.Get('t')->value));
  if (block.m[kToolChange].code == 6) tool_ = selected_tool_;
}

void GcodeInterpreter::Event(const Block& block, char letter, int code, double value) {
  CanonicalMove move = NewMove(CanonicalMove::Kind::kEvent, position_m_);
  move.event = {0, block.line, letter, code, value};
  sink_(move);
}

void GcodeInterpreter::Modes(const Block& block) {
  if (block.G(kPlane) != kNoCode) plane_ = block.G(kPlane);
  if (block.G(kUnits) != kNoCode) unit_m_ = block.G(kUnits) == 200 ? kInch_m : kMillimetre_m;
  ToolLength(block);
  if (block.G(kCoordinateSystem) != kNoCode) offsets_.Select(block.G(kCoordinateSystem));
  PathControl(block);
  if (block.G(kRetract) != kNoCode) to_level_ = block.G(kRetract) == 980;
  if (block.G(kDistance) != kNoCode) absolute_ = block.G(kDistance) == 900;
  if (block.G(kCentreDistance) != kNoCode) absolute_centres_ = block.G(kCentreDistance) == 901;
}

/// Where the program's positions count from goes up by the length of the tool; nothing moves by itself.
void GcodeInterpreter::ToolLength(const Block& block) {
  if (block.G(kToolLength) == 490) offsets_.SetTool({});
  if (block.G(kToolLength) != 430) return;
  const auto& h = block.Get('h');
  const int asked_for = h ? static_cast<int>(std::lround(h->value)) : 0;
  // H0 is the tool in the spindle, too. Where no lengths are known it has always meant none.
  std::optional<int> tool = asked_for > 0 ? std::optional(asked_for) : tool_;
  const bool known = settings_.tools || !settings_.tool_table.empty();
  if (h && asked_for == 0 && !known) tool = 0;
  if (!tool)
    block.FailAtG(kToolLength,
                  "G43: expected H with a tool's number, or T and M6 before it: which tool is in the "
                  "spindle is not known");
  const int column = h ? h->column : block.g[kToolLength].column;
  const std::string asked = "G43 of tool " + std::to_string(*tool);
  if (!known && *tool != 0)
    block.FailAt(column, asked +
                             ": there is no table of tools. Name one by machine.tool_table (LinuxCNC's), or "
                             "put the tool's length into the zero of Z (G10 L20, G92 or 'contour zero') and "
                             "write H0");
  if (!tools_) tools_ = settings_.tools ? settings_.tools : LoadToolTable(settings_.tool_table);
  const AxisValues* offset_m = tools_ ? tools_->Find(*tool) : nullptr;
  if (tools_ && offset_m == nullptr) block.FailAt(column, asked + ": it is not in " + tools_->name);
  offsets_.SetTool(offset_m != nullptr ? *offset_m : AxisValues{});
}

void GcodeInterpreter::PathControl(const Block& block) {
  switch (block.G(kPathControl)) {
    case 610:
      corner_ = GcodeMove::Corner::kExactPath;
      return;
    case 611:
      corner_ = GcodeMove::Corner::kExactStop;
      return;
    case 640:
      break;
    default:
      return;
  }
  for (const char letter : {'p', 'q'})
    if (block.Has(letter) && block.Get(letter)->value < 0.0)
      block.FailAtWord(letter, "G64: expected a tolerance that is not negative");
  naive_cam_m_ = block.Has('q') ? block.Get('q')->value * unit_m_ : 0.0;
  tolerance_m_ = block.Has('p') ? block.Get('p')->value * unit_m_ : 0.0;
  corner_ = tolerance_m_ > 0.0 ? GcodeMove::Corner::kBlended : GcodeMove::Corner::kContinuous;
}

void GcodeInterpreter::NonModal(const Block& block) {
  switch (block.G(kNonModal)) {
    case 100:
      SetSystem(block);
      break;
    case 280:
    case 300:
      GoHome(block);
      break;
    case 520:
    case 920:
      for (std::size_t k = 0; k < kGcodeAxisCount; ++k) {
        if (!block.Has(kGcodeAxes[k])) continue;
        const double value_m = block.Get(kGcodeAxes[k])->value * unit_m_;
        const bool g52 = block.G(kNonModal) == 520;
        offsets_.SetG92(k,
                        g52 ? value_m : position_m_[k] - offsets_.system_m(k) - offsets_.tool_m(k) - value_m);
      }
      offsets_.KeepG92();
      break;
    case 921:
      offsets_.ForgetG92();
      break;
    case 922:
      offsets_.SuspendG92();
      break;
    case 923:
      offsets_.RestoreG92();
      break;
    default:
      break;
  }
}

void GcodeInterpreter::SetSystem(const Block& block) {
  const int number = static_cast<int>(std::lround(block.Get('p')->value));
  const bool from_position = block.Get('l')->value == 20.0;
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k) {
    if (!block.Has(kGcodeAxes[k])) continue;
    const double value_m = block.Get(kGcodeAxes[k])->value * unit_m_;
    offsets_.SetSystem(
        number, k, from_position ? position_m_[k] - offsets_.G92(k) - offsets_.tool_m(k) - value_m : value_m);
  }
}

/// To the machine's zero, for all axes or those that are named, through the position that is named.
void GcodeInterpreter::GoHome(const Block& block) {
  const bool some = block.HasAny(kGcodeAxes);
  const AxisValues through = Target(block);
  sink_(NewMove(CanonicalMove::Kind::kTraverse, through));
  position_m_ = through;
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k)
    if (!some || block.Has(kGcodeAxes[k])) position_m_[k] = -(*settings_.zero_m)[k];
  sink_(NewMove(CanonicalMove::Kind::kTraverse, position_m_));
}

void GcodeInterpreter::Motion(const Block& block) {
  if (block.motion == kNoCode) return;
  motion_ = block.motion;
  if (motion_ == 0 || motion_ == 10) Straight(block);
  if (motion_ == 20 || motion_ == 30) Arc(block);
  if (IsDrillingCycle(motion_)) {
    DrillHoles(block);
  } else {
    cycle_ = {};
  }
}

AxisValues GcodeInterpreter::Target(const Block& block) const {
  AxisValues target = position_m_;
  const bool in_machine = block.G(kNonModal) == 530;
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k) {
    if (!block.Has(kGcodeAxes[k])) continue;
    const double value_m = block.Get(kGcodeAxes[k])->value * unit_m_;
    if (in_machine) {
      target[k] = value_m - (*settings_.zero_m)[k];
    } else {
      target[k] = value_m + (absolute_ ? offsets_.Of(k) : position_m_[k]);
    }
  }
  if (block.IsPolar()) PolarTarget(block, target);
  return target;
}

/// X and Y by distance and angle about the origin in force; what is not stated stays. Incremental ones are
/// added to those of the present position.
void GcodeInterpreter::PolarTarget(const Block& block, AxisValues& target) const {
  const double x = position_m_[0] - offsets_.Of(0), y = position_m_[1] - offsets_.Of(1);
  const bool needs_direction = !absolute_ || !block.polar_angle_deg;
  if (needs_direction && x == 0.0 && y == 0.0) {
    const int column = (block.polar_radius ? block.polar_radius : block.polar_angle_deg)->column;
    block.FailAt(column, "the angle of the origin is not known: expected @ and ^ with G90");
  }
  double radius = std::hypot(x, y), angle = std::atan2(y, x);
  constexpr double kDegree = std::numbers::pi / 180.0;
  if (block.polar_radius) radius = block.polar_radius->value * unit_m_ + (absolute_ ? 0.0 : radius);
  if (block.polar_angle_deg) angle = block.polar_angle_deg->value * kDegree + (absolute_ ? 0.0 : angle);
  target[0] = offsets_.Of(0) + radius * std::cos(angle);
  target[1] = offsets_.Of(1) + radius * std::sin(angle);
}

CanonicalMove GcodeInterpreter::NewMove(CanonicalMove::Kind kind, const AxisValues& target_m) const {
  CanonicalMove move;
  move.kind = kind;
  move.line = line_;
  move.in_sub = in_sub_;
  move.target_m = target_m;
  move.corner = corner_;
  move.naive_cam_m = naive_cam_m_;
  if (corner_ == GcodeMove::Corner::kBlended) move.tolerance_m = tolerance_m_;
  return move;
}

double GcodeInterpreter::FeedOf_m_s(const Block& block, double length_m) const {
  if (!inverse_time_) {
    if (feed_m_s_ == 0.0) {
      const int column = std::max(block.g[kMotion].column, 1);
      block.FailAt(column, "a feed (F) is missing, or is zero; G94 forgets the feed before it");
    }
    return feed_m_s_;
  }
  if (!block.Has('f'))
    block.FailAt(std::max(block.g[kMotion].column, 1),
                 "a feed (F) is missing: G93 needs it in every block that moves at feed");
  return std::max(kSlowestInverse * unit_m_, length_m * block.Get('f')->value) / kMinute_s;
}

void GcodeInterpreter::Straight(const Block& block) {
  const AxisValues target = Target(block);
  const bool rapid = motion_ == 0;
  CanonicalMove move = NewMove(rapid ? CanonicalMove::Kind::kTraverse : CanonicalMove::Kind::kFeed, target);
  if (!rapid) move.feed_m_s = FeedOf_m_s(block, FeedLength_m(position_m_, target));
  move.named = Named(block);
  sink_(move);
  position_m_ = target;
}

std::array<std::uint8_t, 3> GcodeInterpreter::PlaneAxes() const {
  if (plane_ == 180) return {2, 0, 1};
  if (plane_ == 190) return {1, 2, 0};
  return {0, 1, 2};
}

void GcodeInterpreter::Arc(const Block& block) {
  const std::array<std::uint8_t, 3> axes = PlaneAxes();
  const AxisValues target = Target(block);
  const ArcEnds ends{
      {position_m_[axes[0]], position_m_[axes[1]]}, {target[axes[0]], target[axes[1]]}, motion_ == 30};
  CanonicalMove move = NewMove(CanonicalMove::Kind::kArc, target);
  move.plane = {axes[0], axes[1]};
  move.centre_m = ArcCentre(block, ends);
  const int turns = block.Has('p') ? static_cast<int>(std::lround(block.Get('p')->value)) : 1;
  move.turns = ends.ccw ? turns : -turns;
  const double round_m = std::hypot(ends.from_m[0] - move.centre_m[0], ends.from_m[1] - move.centre_m[1]) *
                         SweepOf_rad(ends, move.centre_m, move.turns);
  move.named = Named(block);
  move.feed_m_s = FeedOf_m_s(block, std::hypot(round_m, target[axes[2]] - position_m_[axes[2]]));
  sink_(move);
  position_m_ = target;
}

PlanePoint GcodeInterpreter::ArcCentre(const Block& block, const ArcEnds& ends) const {
  constexpr std::string_view kCentres = "ijk";
  const std::array<std::uint8_t, 3> axes = PlaneAxes();
  const char first = kCentres[axes[0]], second = kCentres[axes[1]], normal = kCentres[axes[2]];
  const ArcTolerance tolerance = ToleranceOfArcs(unit_m_ == kInch_m);
  const int column = std::max(block.g[kMotion].column, 1);
  const auto capital = [](char letter) { return std::string(1, static_cast<char>(letter - 'a' + 'A')); };
  if (block.Has('r') == block.HasAny(kCentres)) {
    block.FailAt(column, "an arc takes either " + capital(std::min(first, second)) + " and " +
                             capital(std::max(first, second)) + ", or R");
  }
  std::optional<std::string> wrong;
  if (block.Has('r')) {
    const PlanePoint centre = CentreByRadius(ends, block.Get('r')->value * unit_m_, tolerance, wrong);
    if (wrong) block.FailAtWord('r', *wrong);
    return centre;
  }
  if (block.Has(normal)) block.FailAtWord(normal, capital(normal) + " is not in the plane of the arc");
  if (absolute_centres_ && !(block.Has(first) && block.Has(second)))
    block.FailAt(column, "G90.1: expected both words of the arc's centre");
  PlanePoint centre = ends.from_m;
  for (std::size_t k = 0; k < 2; ++k) {
    const auto& word = block.Get(kCentres[axes[k]]);
    const double value_m = word ? word->value * unit_m_ : 0.0;
    centre[k] = value_m + (absolute_centres_ ? offsets_.Of(axes[k]) : ends.from_m[k]);
  }
  wrong = WrongCentre(ends, centre, tolerance);
  if (wrong) block.FailAt(column, *wrong);
  return centre;
}

/// R and Z of a series go on from hole to hole. Controls differ in what becomes of them when what they count
/// from changes, and some drill elsewhere: here a new series has to be begun.
void GcodeInterpreter::CheckSeries(const Block& block) const {
  const int own = block.G(kMotion);
  if (cycle_.motion == 0 || (own != kNoCode && !IsDrillingCycle(own))) return;
  const auto differs = [&](GGroup group, int now) {
    return block.G(group) != kNoCode && block.G(group) != now;
  };
  const int nonmodal = block.G(kNonModal);
  const auto fail = [&](GGroup group) {
    block.FailAtG(group,
                  NameOfG(block.G(group)) +
                      " among drilling cycles: end them by G80 before it, and state R and Z anew behind it");
  };
  if (differs(kDistance, absolute_ ? 900 : 910)) fail(kDistance);
  if (differs(kUnits, unit_m_ == kInch_m ? 200 : 210)) fail(kUnits);
  if (differs(kPlane, plane_)) fail(kPlane);
  if (differs(kCoordinateSystem, offsets_.selected())) fail(kCoordinateSystem);
  if (nonmodal != kNoCode && nonmodal != 40) fail(kNonModal);
  const int length = block.G(kToolLength);
  if (length == 430 || (length == 490 && offsets_.HasTool())) fail(kToolLength);
}

/// The series with this block's words in it. What is not stated is as for the hole before.
DrillingCycle GcodeInterpreter::CycleOf(const Block& block) const {
  const std::uint8_t axis = PlaneAxes()[2];
  const char letter = kGcodeAxes[axis];
  const std::string name = NameOfG(motion_);
  const int column = std::max(block.g[kMotion].column, 1);
  if (inverse_time_) block.FailAt(column, name + " needs a feed per minute (G94)");
  DrillingCycle next = cycle_;
  if (cycle_.motion == 0) next.level_m = position_m_[axis];
  if (cycle_.motion != motion_) {
    const auto need = [&](char word, const char* what) {
      if (!block.Has(word))
        block.FailAt(column, name + ": expected " + static_cast<char>(word - 'a' + 'A') + ", " + what);
    };
    need('r', "where it begins to feed");
    need(letter, "how deep the hole is");
    if (DwellsInCycle(motion_)) need('p', "how long it dwells at the bottom, in seconds");
    if (PecksInCycle(motion_)) need('q', "how deep each peck is");
  }
  next.motion = motion_;
  if (block.Has('r')) next.clear_m = block.Get('r')->value * unit_m_;
  if (block.Has(letter)) next.bottom_m = block.Get(letter)->value * unit_m_;
  if (block.Has('p') && DwellsInCycle(motion_)) next.dwell_s = block.Get('p')->value;
  if (block.Has('q') && PecksInCycle(motion_)) next.peck_m = block.Get('q')->value * unit_m_;
  return next;
}

Hole GcodeInterpreter::HoleOf(const Block& block) const {
  const std::uint8_t axis = PlaneAxes()[2];
  Hole hole;
  // Incremental: R from where the axis stood before the series, the depth from R.
  hole.clear_m = cycle_.clear_m + (absolute_ ? offsets_.Of(axis) : cycle_.level_m);
  hole.bottom_m = cycle_.bottom_m + (absolute_ ? offsets_.Of(axis) : hole.clear_m);
  hole.retract_m = to_level_ ? std::max(cycle_.level_m, hole.clear_m) : hole.clear_m;
  if (hole.bottom_m > hole.clear_m)
    block.FailAt(std::max(block.g[kMotion].column, 1),
                 NameOfG(motion_) + ": R is below the bottom of the hole");
  if (PecksInCycle(motion_) && hole.clear_m - hole.bottom_m > kMostPecks * cycle_.peck_m)
    block.FailAt(std::max(block.g[kMotion].column, 1),
                 NameOfG(motion_) + ": Q asks for more pecks than a hole may have");
  return hole;
}

void GcodeInterpreter::DrillHoles(const Block& block) {
  cycle_ = CycleOf(block);
  const std::uint8_t axis = PlaneAxes()[2];
  const Hole hole = HoleOf(block);
  const int holes = block.Has('l') ? static_cast<int>(std::lround(block.Get('l')->value)) : 1;
  strokes_ += holes * StrokesOf(cycle_, hole);
  if (strokes_ > kMostStrokes)
    block.FailAt(std::max(block.g[kMotion].column, 1),
                 NameOfG(motion_) +
                     ": with this line the drilling cycles of the program have more than 5 million strokes; "
                     "expected fewer holes (L) or deeper pecks (Q)");
  const double feed_m_s = FeedOf_m_s(block, 0.0);
  const auto move = [&](CanonicalMove::Kind kind) {
    CanonicalMove m = NewMove(kind, position_m_);
    m.corner = GcodeMove::Corner::kExactPath;
    m.tolerance_m = m.naive_cam_m = 0.0;
    m.named = Named(block);
    if (kind == CanonicalMove::Kind::kFeed) m.feed_m_s = feed_m_s;
    if (kind == CanonicalMove::Kind::kDwell) m.dwell_s = cycle_.dwell_s;
    sink_(m);
  };
  const auto along = [&](double to_m, CanonicalMove::Kind kind) {
    position_m_[axis] = to_m;
    move(kind);
  };
  // Never across from below the clearance plane. A series that began below it has this move at each hole.
  if (std::min(position_m_[axis], cycle_.level_m) < hole.clear_m)
    along(hole.clear_m, CanonicalMove::Kind::kTraverse);
  for (int n = 0; n < holes; ++n) {
    const double above_m = to_level_ ? std::max(position_m_[axis], cycle_.level_m) : position_m_[axis];
    position_m_ = Target(block);
    along(above_m, CanonicalMove::Kind::kTraverse);
    if (above_m != hole.clear_m) along(hole.clear_m, CanonicalMove::Kind::kTraverse);
    Drill(cycle_, hole, [&](const DrillingStroke& stroke) {
      using Kind = DrillingStroke::Kind;
      if (stroke.kind == Kind::kDwell) return move(CanonicalMove::Kind::kDwell);
      along(stroke.to_m,
            stroke.kind == Kind::kFeed ? CanonicalMove::Kind::kFeed : CanonicalMove::Kind::kTraverse);
    });
  }
}

void GcodeInterpreter::PutPosition(std::array<double, 9>& position) const {
  constexpr std::array<std::size_t, kGcodeAxisCount> kPlaces = {0, 1, 2, 6, 7, 8};
  for (std::size_t k = 0; k < kGcodeAxisCount; ++k)
    position[kPlaces[k]] = (position_m_[k] - offsets_.Of(k)) / unit_m_;
}

void GcodeInterpreter::PutModes(std::map<std::string, double, std::less<>>& modes) const {
  modes["_metric"] = unit_m_ == kMillimetre_m;
  modes["_imperial"] = unit_m_ == kInch_m;
  modes["_absolute"] = absolute_;
  modes["_incremental"] = !absolute_;
  modes["_ijk_absolute_mode"] = absolute_centres_;
  modes["_inverse_time"] = inverse_time_;
  modes["_units_per_minute"] = !inverse_time_;
  modes["_units_per_rev"] = 0.0;
  modes["_plane"] = plane_;
  modes["_motion_mode"] = motion_;
  modes["_coord_system"] = offsets_.selected();
  modes["_feed"] = feed_m_s_ * kMinute_s / unit_m_;
  modes["_line"] = line_;
  modes["_task"] = 0.0;
}

}  // namespace contour
