#include "daemon/program/paced_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace contour {
namespace {

// A program that ends on a grid point but for rounding does not get another point.
constexpr double kRounding = 1e-6;
/// Laws that are older than this are of no use to anybody.
constexpr std::uint64_t kRemembered = 4096;
constexpr int kHalvings = 40;
/// Of the pace that is wanted.
constexpr double kSlowest = 1e-3;

}  // namespace

PacedPath::PacedPath(std::unique_ptr<PathGenerator> generator, const Options& options)
    : generator_(std::move(generator)),
      ramp_(*generator_->plan(), generator_->limits(), generator_->period_s()),
      rate_(options.rate),
      single_block_(options.single_block),
      halts_(options.halts),
      law_(options.rate) {
  // A program begins at rest, so there is a way to the end of its first line.
  if (single_block_ && rate_ > 0.0)
    if (const std::optional<PaceLaw> law = ToEndOfLine(law_)) law_ = *law;
}

// Long programs are planned no further than needed to know.
bool PacedPath::IsLast(double time) const {
  return !generator_->plan()->GoesOnAfter((time + kRounding) * generator_->period_s());
}

std::uint32_t PacedPath::HaltsAt(double index) const {
  return index < 0.0 ? 0
                     : generator_->plan()->Halts((law_.At(index).time + kRounding) * generator_->period_s());
}

// The program is at rest where it halts, as in a dwell: its time may stand still there at once. It stands
// just behind that instant, so that it is not found again when it goes on.
void PacedPath::StandAtHalt() {
  double high = static_cast<double>(next_), low = high - 1.0;
  const std::uint32_t passed = HaltsAt(low);
  if (HaltsAt(high) == passed) return;
  for (int i = 0; i < kHalvings && low >= 0.0; ++i) {
    const double middle = 0.5 * (low + high);
    (HaltsAt(middle) == passed ? low : high) = middle;
  }
  halt_ = {HaltsAt(high), law_.At(high).time * generator_->period_s()};
  law_.Hold(high, 0.0, Held::kHalt);
}

bool PacedPath::Next(PathPoint& point) {
  if (ended_) return false;
  if (halts_) StandAtHalt();
  const PaceState state = law_.At(static_cast<double>(next_));
  point.program_id = generator_->program_id();
  point.index = next_;
  point.law = pending_ && next_ >= pending_from_ ? issued_ : taken_;
  point.last = state.held == Held::kNot && IsLast(state.time);
  Evaluate(state, point);
  ended_ = point.last;
  ++next_;
  return true;
}

void PacedPath::Evaluate(const PaceState& state, PathPoint& point) const {
  const double period_s = generator_->period_s();
  const MotionPlan& plan = *generator_->plan();
  // The last grid point lies on the end of the path or after it.
  const double time_s = point.last ? plan.duration_s() : state.time * period_s;
  point.program_time_s = state.time * period_s;
  point.line = plan.Line(time_s);
  plan.At(time_s, point.axes);
  if (generator_->offsets()) generator_->offsets()->AddBetween(state.time, point);
  if (state.rate == 1.0 && state.change == 0.0) return;
  for (ReferencePoint& p : point.axes) {
    p.acceleration_m_s2 =
        state.rate * state.rate * p.acceleration_m_s2 + state.change / period_s * p.velocity_m_s;
    p.velocity_m_s *= state.rate;
    // An extra torque belongs to the program's own pace, as in a stop.
    p.extra_torque_Nm *= std::min(1.0, state.rate);
  }
}

// Where the line ends that is under way at that time, or begins.
double PacedPath::EndOfLine(double time) const {
  const MotionPlan& plan = *generator_->plan();
  const double period_s = generator_->period_s();
  double at = std::floor(time + kRounding) + 1.0;
  std::uint32_t line = 0;
  // A dwell may belong to no line: then it belongs to the one before.
  const auto goes_on = [&](double place) {
    const std::uint32_t there = plan.Line(place * period_s);
    if (line == 0) line = there;
    return there == 0 || there == line;
  };
  while (!IsLast(at) && goes_on(at)) at += 1.0;
  if (IsLast(at)) return std::numeric_limits<double>::infinity();
  double low = at - 1.0;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + at);
    (goes_on(middle) ? low : at) = middle;
  }
  return at;
}

std::optional<PaceLaw> PacedPath::ToEndOfLine(const PaceLaw& law) const {
  const double begin = std::ceil(law.settled());
  const double stop = EndOfLine(law.At(begin).time);
  // The last line ends by itself.
  return std::isfinite(stop) ? ramp_.StopAt(law, begin, stop) : law;
}

std::optional<PaceLaw> PacedPath::LawFrom(std::uint64_t begin, double rate) const {
  const auto from = static_cast<double>(begin);
  if (!single_block_) return ramp_.From(law_, from, rate);
  const double end_of_line = EndOfLine(law_.At(from).time);
  const auto before_its_end = [&](const PaceLaw& law) {
    return law.At(std::ceil(law.settled())).time < end_of_line;
  };
  if (rate <= 0.0) {
    const std::optional<PaceLaw> law = ramp_.From(law_, from, rate);
    return law && before_its_end(*law) ? law : std::nullopt;
  }
  // On a short line the pace that is wanted may not be reached.
  for (double slower = rate; slower > kSlowest * rate; slower *= 0.5) {
    const std::optional<PaceLaw> law = ramp_.From(law_, from, slower);
    if (!law || !before_its_end(*law)) continue;
    if (std::optional<PaceLaw> stopping = ToEndOfLine(*law)) return stopping;
  }
  return std::nullopt;
}

void PacedPath::Adopt(const PaceLaw& law, std::uint64_t begin, std::uint64_t end, double rate) {
  before_ = law_;
  rate_before_ = rate_;
  law_ = law;
  rate_ = rate;
  const std::uint64_t oldest = std::min(begin, end);
  law_.ForgetBefore(static_cast<double>(oldest > kRemembered ? oldest - kRemembered : 0));
  ++issued_;
  pending_ = true;
  pending_from_ = begin;
  next_ = oldest;
  ended_ = false;
}

PacedPath::Change PacedPath::ChangePace(std::uint64_t earliest, std::uint64_t end, double rate, Held resume) {
  PaceState from = law_.At(static_cast<double>(earliest));
  const auto held = [&] { return from.held != Held::kNot; };
  if (!held() && IsLast(from.time)) return Change::kNothing;
  if (held() ? from.held != resume : rate == rate_) {
    rate_ = rate;
    return Change::kNothing;
  }
  std::optional<PaceLaw> law = LawFrom(earliest, rate);
  if (!law && from.change != 0.0) {
    // Not out of the middle of another change: after it.
    earliest = std::max(earliest, static_cast<std::uint64_t>(std::ceil(law_.settled())));
    from = law_.At(static_cast<double>(earliest));
    if (!held() && IsLast(from.time)) return Change::kNothing;
    if (held()) {
      // It rests there anyway, and goes on as it has been told last.
      rate_ = rate;
      return Change::kNothing;
    }
    law = LawFrom(earliest, rate);
  }
  if (!law) return Change::kLater;
  Adopt(*law, earliest, end, rate);
  return Change::kPlanned;
}

void PacedPath::Taken() {
  taken_ = issued_;
  pending_ = false;
}

void PacedPath::Refused(std::uint64_t end) {
  law_ = before_;
  rate_ = rate_before_;
  pending_ = false;
  next_ = end;
  ended_ = false;
}

}  // namespace contour
