#include "daemon/program/speed_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

Reach ReachAlong(const Stretch& stretch, const PerAxis<double>& tangent) {
  Reach reach;
  for (std::size_t i = 0; i < tangent.size(); ++i) {
    const double share = std::abs(tangent[i]);
    if (share < 1e-9) continue;
    reach.acceleration_m_s2 =
        std::min(reach.acceleration_m_s2, stretch.limits()[i].acceleration_m_s2 / share);
    reach.jerk_m_s3 = std::min(reach.jerk_m_s3, stretch.limits()[i].jerk_m_s3 / share);
  }
  return reach;
}

double FeedOr(double feed_m_s) { return feed_m_s > 0.0 ? feed_m_s : kInfinite; }

/// Largest speed of the parameter at one place by itself, and by feed and velocity alone.
struct Caps {
  double speed = kInfinite;
  double feed = kInfinite;
};

Caps CapsAt(const Stretch& stretch, const ParameterDerivatives& x, double feed_m_s) {
  Caps caps;
  double squared = 0.0;
  for (std::size_t i = 0; i < x.first.size(); ++i) {
    const PlanLimits& l = stretch.limits()[i];
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
  [[nodiscard]] double CruiseSpeed() const { return std::max(1e-12, std::min(begin.feed, 1e6)); }
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

double SinceAtEnd(const Part& p) {
  const double begin = p.CruiseBegin(), end = p.CruiseEnd();
  const bool whole = begin <= p.from && end >= p.to;
  return whole                         ? p.since_s + (p.to - p.from) / p.CruiseSpeed()
         : end >= p.to && begin < p.to ? (p.to - begin) / p.CruiseSpeed()
                                       : 0.0;
}

/// From one parameter to another, which may be the stretch's end.
std::vector<double> Places(const Stretch& stretch, const RestMap& map, double from_u, double to_u) {
  const double from = map.At(from_u).way_m, to = map.At(to_u).way_m;
  std::vector<double> ways = stretch.Jumps_m(from, to);
  ways.push_back(map.At(map.begin_width()).way_m);
  ways.push_back(map.At(map.end_u() - map.end_width()).way_m);
  std::sort(ways.begin(), ways.end());
  std::vector<double> places{from_u};
  double last = from;
  for (const double way : ways) {
    if (way < last + kSame_m || way > to - kSame_m) continue;
    places.push_back(map.Inverse(way));
    last = way;
  }
  places.push_back(to_u);
  return places;
}

Part MakePart(const Stretch& stretch, const RestMap& map, double feed_scale, double from, double to) {
  Part part;
  part.from = from;
  part.to = to;
  const double middle = 0.5 * (from + to);
  const double way = map.At(middle).way_m;
  const double feed = feed_scale * FeedOr(stretch.Feed_m_s(way));
  part.begin = CapsAt(stretch, AtParameter(stretch, map, from, middle), feed);
  part.end = CapsAt(stretch, AtParameter(stretch, map, to, middle), feed);
  part.reach = ReachAlong(stretch, stretch.At(way).first);
  const double top = std::min(std::max(part.begin.feed, part.end.feed), 1e3);
  // A change of speed at the jerk limit takes at least half as long again as this.
  const double gentle = std::min(part.reach.acceleration_m_s2, 0.5 * std::sqrt(part.reach.jerk_m_s3 * top));
  part.change = std::isfinite(gentle) ? 2.0 * gentle : kInfinite;
  if (middle < map.begin_width()) part.longest = map.begin_width() / kRestSteps;
  if (middle > map.end_u() - map.end_width())
    part.longest = std::min(part.longest, map.end_width() / kRestSteps);
  return part;
}

/// Forwards, from the speed at the begin.
void GuessForwards(std::vector<Part>& parts, double speed) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    Part& p = parts[i];
    const double reached = i == 0 ? speed
                                  : std::sqrt(std::pow(parts[i - 1].speed_begin, 2) +
                                              parts[i - 1].change * (p.from - parts[i - 1].from));
    p.speed_begin = std::min({p.begin.speed, i == 0 ? kInfinite : parts[i - 1].end.speed, reached});
  }
}

/// And backwards, from the speed at the end.
void GuessBackwards(std::vector<Part>& parts, double speed) {
  double after = speed;
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
void CountCruise(std::vector<Part>& parts, double since) {
  for (Part& p : parts) {
    p.since_s = since;
    since = SinceAtEnd(p);
  }
  double until = 0.0;
  for (std::size_t i = parts.size(); i-- > 0;) {
    Part& p = parts[i];
    p.until_s = until;
    const double begin = p.CruiseBegin(), end = p.CruiseEnd();
    const bool whole = begin <= p.from && end >= p.to;
    until = whole                             ? until + (p.to - p.from) / p.CruiseSpeed()
            : begin <= p.from && end > p.from ? (end - p.from) / p.CruiseSpeed()
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

/// So many of the first parts will move as they are guessed to, whatever comes behind the last: also if that
/// is a stop.
std::size_t Decided(std::vector<Part> parts, double speed) {
  GuessForwards(parts, speed);
  std::vector<Part> stopping = parts;
  GuessBackwards(parts, kInfinite);
  GuessBackwards(stopping, 0.0);
  std::size_t decided = 0;
  while (decided < parts.size() && stopping[decided].speed_end == parts[decided].speed_end) ++decided;
  return decided;
}

/// Nodes of the parts that are decided, up to the one that reaches `until_u`; returns from where it goes on.
SpeedGrid::Begin Nodes(std::vector<Part> parts, std::size_t decided, const SpeedGrid::Begin& begin,
                       double until_u, std::vector<double>& nodes) {
  GuessForwards(parts, begin.speed);
  const std::vector<Part> forwards = parts;
  GuessBackwards(parts, kInfinite);
  CountCruise(parts, begin.since_s);
  std::size_t done = 0;
  for (; done < decided && parts[done].from < until_u; ++done) Divide(parts[done], nodes);
  const Part& last = parts[done - 1];
  const double speed = done < parts.size() ? forwards[done].speed_begin : last.speed_end;
  return {last.to, speed, SinceAtEnd(last)};
}

}  // namespace

double StepTime_s(const Stretch& stretch, double way_m, double speed_m_s) {
  return StepTime_s(ReachAlong(stretch, stretch.At(way_m).first), speed_m_s);
}

RestMap RestMapFor(const Stretch& stretch, double from_m) {
  const double to_m = stretch.length_m();
  const auto width = [&](const PerAxis<double>& tangent, double feed_m_s) {
    const Reach reach = ReachAlong(stretch, tangent);
    double speed = FeedOr(feed_m_s);
    for (std::size_t i = 0; i < tangent.size(); ++i)
      speed = std::min(speed, stretch.limits()[i].velocity_m_s / std::abs(tangent[i]));
    if (!std::isfinite(speed) || !std::isfinite(reach.jerk_m_s3)) return to_m - from_m;
    const double rise_s =
        std::min(reach.acceleration_m_s2 / reach.jerk_m_s3, std::sqrt(speed / reach.jerk_m_s3));
    return reach.jerk_m_s3 * rise_s * rise_s * rise_s / 3.0;
  };
  return {from_m, to_m, width(stretch.At(from_m).first, stretch.Feed_m_s(from_m)),
          width(stretch.EndTangent(), stretch.EndFeed_m_s())};
}

void SpeedGrid::Extend(Stretch& stretch, const RestMap& map, double until_u, std::vector<double>& nodes) {
  std::size_t sections = 1;
  const auto know_more = [&] {
    for (std::size_t i = 0; i < sections; ++i) stretch.Extend();
    sections *= 2;
  };
  while (!complete_) {
    const bool all = stretch.all_known();
    const double to_u = all ? map.end_u() : map.Inverse(stretch.known_to_m());
    if (!all && to_u <= begin_.at_u) {
      know_more();
      continue;
    }
    const std::vector<double> places = Places(stretch, map, begin_.at_u, to_u);
    std::vector<Part> parts;
    for (std::size_t i = 0; i + 1 < places.size(); ++i)
      parts.push_back(MakePart(stretch, map, feed_scale_, places[i], places[i + 1]));
    const std::size_t decided = all ? parts.size() : Decided(parts, begin_.speed);
    // Half of what is known at least, so that no place is looked at more than a few times.
    const double enough_u = std::min(until_u, 0.5 * (begin_.at_u + to_u));
    if (decided == 0 || (!all && parts[decided - 1].to < enough_u)) {
      know_more();
      continue;
    }
    begin_ = Nodes(std::move(parts), decided, begin_, until_u, nodes);
    complete_ = begin_.at_u == map.end_u();
    return;
  }
}

}  // namespace contour
