#include "daemon/memory/stroke_friction.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace contour {
namespace {

constexpr std::size_t kMostPieces = 32;
constexpr double kLeastTurns = 2.0;
/// Slower, the level is mixed with the Stribeck curve.
constexpr double kSlow_m_s = 4e-3;
/// Viscous friction that is not quite known must not look like a step.
constexpr double kSameSpeed = 0.05;
constexpr std::size_t kLeastSamples = 20;
/// A step counts from so many passes in both directions on, and a new pass as much as one of so many.
constexpr double kLeastPasses = 2.0;
constexpr double kMostPasses = 20.0;

std::size_t PiecesOf(const StrokeFriction::Stroke& s) {
  const double length_m = s.highest_m - s.lowest_m;
  if (!(length_m > 0.0) || !(s.lead_m > 0.0))
    throw std::invalid_argument("friction along the stroke: there is no stroke");
  const double most = std::floor(length_m / (kLeastTurns * s.lead_m));
  return std::clamp<std::size_t>(static_cast<std::size_t>(most), 1, kMostPieces);
}

}  // namespace

StrokeFriction::StrokeFriction(const Stroke& stroke)
    : StrokeFriction(stroke, std::vector<Step>(PiecesOf(stroke) - 1)) {}

StrokeFriction::StrokeFriction(const Stroke& stroke, std::vector<Step> learnt)
    : stroke_(stroke), steps_(std::move(learnt)) {
  if (steps_.size() != PiecesOf(stroke) - 1)
    throw std::invalid_argument("friction along the stroke: another number of pieces");
}

double StrokeFriction::Centre_m(std::size_t piece) const {
  const double piece_m = (stroke_.highest_m - stroke_.lowest_m) / static_cast<double>(pieces());
  return stroke_.lowest_m + (static_cast<double>(piece) + 0.5) * piece_m;
}

std::vector<double> StrokeFriction::Relative() const {
  std::vector<double> log_level{0.0};
  for (const Step& s : steps_) {
    const bool known = s.forward_passes >= kLeastPasses && s.backward_passes >= kLeastPasses;
    log_level.push_back(log_level.back() + (known ? 0.5 * (s.forward + s.backward) : 0.0));
  }
  double mean = 0.0;
  for (const double l : log_level) mean += std::exp(l) / static_cast<double>(log_level.size());
  for (double& l : log_level) l = std::exp(l) / mean - 1.0;
  return log_level;
}

void StrokeFriction::Add(const Sample& s) {
  const int direction = s.velocity_m_s > 0.0 ? 1 : s.velocity_m_s < 0.0 ? -1 : 0;
  const double along = (s.position_m - stroke_.lowest_m) / (stroke_.highest_m - stroke_.lowest_m);
  const bool counts =
      s.sliding && std::abs(s.velocity_m_s) > kSlow_m_s && s.level_N > 0.0 && along >= 0.0 && along < 1.0;
  if (!counts || direction != direction_) {
    now_ = before_ = {};
    whole_ = before_whole_ = false;
    direction_ = 0;
    if (!counts) return;
    direction_ = direction;
    now_.piece = static_cast<std::size_t>(along * static_cast<double>(pieces()));
  }
  const auto piece = static_cast<std::size_t>(along * static_cast<double>(pieces()));
  if (piece != now_.piece) Leave(piece);
  now_.log_level += std::log(s.level_N);
  now_.speed_m_s += std::abs(s.velocity_m_s);
  ++now_.samples;
}

void StrokeFriction::Leave(std::size_t next) {
  const bool neighbour = direction_ > 0 ? next == now_.piece + 1 : next + 1 == now_.piece;
  const bool ended = whole_ && neighbour && now_.samples >= kLeastSamples;
  if (ended) {
    now_.log_level /= static_cast<double>(now_.samples);
    now_.speed_m_s /= static_cast<double>(now_.samples);
    if (before_whole_) Learn(before_, now_, direction_);
  }
  before_ = now_;
  before_whole_ = ended;
  whole_ = neighbour;
  now_ = {};
  now_.piece = next;
}

void StrokeFriction::Learn(const Stretch& from, const Stretch& to, int direction) {
  if (std::abs(to.speed_m_s - from.speed_m_s) > kSameSpeed * from.speed_m_s) return;
  const std::size_t lower = std::min(from.piece, to.piece);
  const double step = std::clamp(direction * (to.log_level - from.log_level), -kLargestStep, kLargestStep);
  Step& s = steps_[lower];
  double& mean = direction > 0 ? s.forward : s.backward;
  double& passes = direction > 0 ? s.forward_passes : s.backward_passes;
  passes = std::min(passes + 1.0, kMostPasses);
  mean += (step - mean) / passes;
  ++passes_;
}

}  // namespace contour
