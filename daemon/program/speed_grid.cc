#include "daemon/program/speed_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contour {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
// Nodes per rise of acceleration from none to its limit.
constexpr double kStepOfRise = 0.2;
// Where the feed is kept, steps grow by this share of the time to the next change of speed.
constexpr double kGrowth = 0.25;
// Nodes on either part of a way that starts or ends at rest.
constexpr double kRestSteps = 8.0;
// Closer than this, two places are one.
constexpr double kSame_m = 2e-9;
constexpr int kMostSteps = 4000;

/// What bounds a change of speed along the path at one place.
struct Reach {
  double acceleration_m_s2 = kInfinite;
  double jerk_m_s3 = kInfinite;
};

Reach ReachAt(const Stretch& stretch, double way_m) {
  const PathDerivatives q = stretch.smooth.At(way_m);
  Reach reach;
  for (std::size_t i = 0; i < q.first.size(); ++i) {
    const double share = std::abs(q.first[i]);
    if (share < 1e-9) continue;
    reach.acceleration_m_s2 = std::min(reach.acceleration_m_s2, stretch.limits[i].acceleration_m_s2 / share);
    reach.jerk_m_s3 = std::min(reach.jerk_m_s3, stretch.limits[i].jerk_m_s3 / share);
  }
  return reach;
}

double Feed_m_s(const Stretch& stretch, double way_m) {
  const double feed = stretch.programmed.move(stretch.programmed.MoveAt(way_m)).feed_m_s;
  return feed > 0.0 ? feed : kInfinite;
}

/// Largest speed of the parameter at one place by itself, and by feed and velocity alone.
struct Caps {
  double speed = kInfinite;
  double feed = kInfinite;
};

Caps CapsAt(const Stretch& stretch, const ParameterDerivatives& x, double feed_m_s) {
  Caps caps;
  double squared = 0.0;
  for (std::size_t i = 0; i < x.first.size(); ++i) {
    const PlanLimits& l = stretch.limits[i];
    squared += x.first[i] * x.first[i];
    caps.feed = std::min(caps.feed, l.velocity_m_s / std::abs(x.first[i]));
    caps.speed = std::min({caps.speed, std::sqrt(l.acceleration_m_s2 / std::abs(x.second[i])),
                           std::cbrt(l.jerk_m_s3 / std::abs(x.third[i]))});
  }
  caps.feed = std::min(caps.feed, feed_m_s / std::sqrt(squared));
  caps.speed = std::min(caps.speed, caps.feed);
  return caps;
}

/// Between two places where something jumps; speeds are a first guess, only for finding steps.
struct Part {
  double from = 0.0, to = 0.0;
  Caps begin, end;
  Reach reach;
  double change = 0.0;  ///< d(speed^2)/du at most
  double speed_begin = 0.0, speed_end = 0.0;
  double since_s = 0.0, until_s = 0.0;  ///< from the last, to the next change of speed outside
  double longest = kInfinite;           ///< step

  [[nodiscard]] double Speed(double u) const {
    const double share = (u - from) / (to - from);
    const double cap = begin.speed + share * (end.speed - begin.speed);
    return std::min({cap, std::sqrt(speed_begin * speed_begin + change * (u - from)),
                     std::sqrt(speed_end * speed_end + change * (to - u))});
  }
  /// Where the feed is reached and left; from > to: nowhere.
  [[nodiscard]] double CruiseBegin() const {
    if (begin.speed < begin.feed || end.speed < end.feed) return to + 1.0;
    const double gain = std::max(0.0, begin.feed * begin.feed - speed_begin * speed_begin);
    return gain == 0.0 ? from : from + gain / change;
  }
  [[nodiscard]] double CruiseEnd() const {
    if (begin.speed < begin.feed || end.speed < end.feed) return from - 1.0;
    const double gain = std::max(0.0, end.feed * end.feed - speed_end * speed_end);
    return gain == 0.0 ? to : to - gain / change;
  }
};

std::vector<double> Places(const Stretch& stretch, const RestMap& map) {
  const double from = map.At(0.0).way_m, to = map.At(map.end_u()).way_m;
  std::vector<double> ways{from + 0.5 * map.begin_width(), to - 0.5 * map.end_width()};
  for (std::size_t i = 1; i < stretch.smooth.pieces(); ++i) ways.push_back(stretch.smooth.break_m(i));
  const ProgrammedPath& path = stretch.programmed;
  for (std::size_t i = 1; i < path.size(); ++i)
    if (path.move(i).feed_m_s != path.move(i - 1).feed_m_s) ways.push_back(path.begin_m(i));
  std::sort(ways.begin(), ways.end());
  std::vector<double> places{0.0};
  double last = from;
  for (const double way : ways) {
    if (way < last + kSame_m || way > to - kSame_m) continue;
    places.push_back(map.Inverse(way));
    last = way;
  }
  places.push_back(map.end_u());
  return places;
}

Part MakePart(const Stretch& stretch, const RestMap& map, double feed_scale, double from, double to) {
  Part part;
  part.from = from;
  part.to = to;
  const double middle = 0.5 * (from + to);
  const double way = map.At(middle).way_m;
  const double feed = feed_scale * Feed_m_s(stretch, way);
  part.begin = CapsAt(stretch, AtParameter(stretch, map, from, middle), feed);
  part.end = CapsAt(stretch, AtParameter(stretch, map, to, middle), feed);
  part.reach = ReachAt(stretch, way);
  const double top = std::min(std::max(part.begin.feed, part.end.feed), 1e3);
  // A change of speed at the jerk limit takes at least half as long again as this.
  const double gentle = std::min(part.reach.acceleration_m_s2, 0.5 * std::sqrt(part.reach.jerk_m_s3 * top));
  part.change = std::isfinite(gentle) ? 2.0 * gentle : kInfinite;
  if (middle < map.begin_width()) part.longest = map.begin_width() / kRestSteps;
  if (middle > map.end_u() - map.end_width())
    part.longest = std::min(part.longest, map.end_width() / kRestSteps);
  return part;
}

void GuessSpeeds(std::vector<Part>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Part& p = parts[i];
    const double reached = i == 0 ? kInfinite
                                  : std::sqrt(std::pow(parts[i - 1].speed_begin, 2) +
                                              parts[i - 1].change * (p.from - parts[i - 1].from));
    p.speed_begin = std::min({p.begin.speed, i == 0 ? kInfinite : parts[i - 1].end.speed, reached});
  }
  double after = kInfinite;
  for (std::size_t i = parts.size(); i-- > 0;) {
    Part& p = parts[i];
    const double by_start = std::sqrt(p.speed_begin * p.speed_begin + p.change * (p.to - p.from));
    p.speed_end = std::min({p.end.speed, after, by_start});
    p.speed_begin =
        std::min(p.speed_begin, std::sqrt(p.speed_end * p.speed_end + p.change * (p.to - p.from)));
    after = p.speed_begin;
  }
}

/// Times from the last and to the next place where speed has to change.
void CountCruise(std::vector<Part>& parts) {
  double since = 0.0;
  for (Part& p : parts) {
    p.since_s = since;
    const double begin = p.CruiseBegin(), end = p.CruiseEnd();
    const bool whole = begin <= p.from && end >= p.to;
    const double speed = std::max(1e-12, std::min(p.begin.feed, 1e6));
    since = whole                         ? since + (p.to - p.from) / speed
            : end >= p.to && begin < p.to ? (p.to - begin) / speed
                                          : 0.0;
  }
  double until = 0.0;
  for (std::size_t i = parts.size(); i-- > 0;) {
    Part& p = parts[i];
    p.until_s = until;
    const double begin = p.CruiseBegin(), end = p.CruiseEnd();
    const bool whole = begin <= p.from && end >= p.to;
    const double speed = std::max(1e-12, std::min(p.begin.feed, 1e6));
    until = whole                             ? until + (p.to - p.from) / speed
            : begin <= p.from && end > p.from ? (end - p.from) / speed
                                              : 0.0;
  }
}

double StepTime_s(const Reach& reach, double speed_m_s) {
  return kStepOfRise *
         std::min(reach.acceleration_m_s2 / reach.jerk_m_s3, std::sqrt(speed_m_s / reach.jerk_m_s3));
}

double Step(const Part& p, double u) {
  const double speed = std::max(p.Speed(u), 1e-9);
  double time = StepTime_s(p.reach, speed);
  const double begin = p.CruiseBegin(), end = p.CruiseEnd();
  if (u > begin && u < end) {
    const double since = (begin <= p.from ? p.since_s : 0.0) + (u - std::max(begin, p.from)) / speed;
    const double until = (end >= p.to ? p.until_s : 0.0) + (std::min(end, p.to) - u) / speed;
    time += kGrowth * std::min(since, until);
  }
  if (!std::isfinite(time)) return p.longest;
  return std::min(speed * time, p.longest);
}

void Divide(const Part& p, std::vector<double>& grid) {
  std::vector<double> marks{p.from};
  const double shortest = (p.to - p.from) / kMostSteps;
  while (marks.back() < p.to) {
    const double u = marks.back();
    // As fine as what lies ahead needs.
    const double step = Step(p, u);
    const double ahead = std::min(u + step, p.to);
    marks.push_back(u + std::max(shortest, std::min(step, 1.5 * Step(p, ahead))));
  }
  const double scale = (p.to - p.from) / (marks.back() - p.from);
  for (std::size_t i = 1; i + 1 < marks.size(); ++i) grid.push_back(p.from + scale * (marks[i] - p.from));
  grid.push_back(p.to);
}

}  // namespace

double StepTime_s(const Stretch& stretch, double way_m, double speed_m_s) {
  return StepTime_s(ReachAt(stretch, way_m), speed_m_s);
}

RestMap RestMapFor(const Stretch& stretch, double from_m) {
  const double to_m = stretch.smooth.length_m();
  const auto width = [&](double way, double inside) {
    const Reach reach = ReachAt(stretch, way);
    double speed = Feed_m_s(stretch, inside);
    const PathDerivatives q = stretch.smooth.At(way);
    for (std::size_t i = 0; i < q.first.size(); ++i)
      speed = std::min(speed, stretch.limits[i].velocity_m_s / std::abs(q.first[i]));
    if (!std::isfinite(speed) || !std::isfinite(reach.jerk_m_s3)) return to_m - from_m;
    const double rise_s =
        std::min(reach.acceleration_m_s2 / reach.jerk_m_s3, std::sqrt(speed / reach.jerk_m_s3));
    return reach.jerk_m_s3 * rise_s * rise_s * rise_s / 3.0;
  };
  return {from_m, to_m, width(from_m, from_m), width(to_m, to_m)};
}

std::vector<double> SpeedGrid(const Stretch& stretch, const RestMap& map, double feed_scale) {
  const std::vector<double> places = Places(stretch, map);
  std::vector<Part> parts;
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
    parts.push_back(MakePart(stretch, map, feed_scale, places[i], places[i + 1]));
  GuessSpeeds(parts);
  CountCruise(parts);
  std::vector<double> grid{0.0};
  for (const Part& p : parts) Divide(p, grid);
  return grid;
}

}  // namespace contour
