#include "analysis/prediction_error/noise_levels.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/likelihoods.h"
#include "analysis/prediction_error/simd/lane_loops.h"
#include "analysis/prediction_error/simd/lanes.h"

namespace contour::diagnosis {
namespace {

/// What a torque of two more numbers has to gain in -2 log likelihood (Akaike).
constexpr double kTwoNumbers = 4.0;
/// [rows] What remembers longer than the colour filter reaches passes for noise where a cause is missing: a
/// force or a level of friction that the model lacks is as constant.
constexpr auto kLongestMemory = static_cast<double>(kNoise.whitener_order);
/// [rows] A torque that forgets sooner is as good as white.
constexpr double kShortestMemory = 2.0;

/// A number of the levels, and by how much it is tried larger and smaller.
struct Move {
  double NoiseLevels::*number;
  double step;
};

bool SameLevels(const NoiseLevels& a, const NoiseLevels& b) {
  constexpr double kRounding = 1e-9;
  const auto same = [](double x, double y) { return std::fabs(x - y) < kRounding; };
  return a.slow_there == b.slow_there && same(a.log10_torque, b.log10_torque) &&
         (!a.slow_there ||
          (same(a.log10_slow, b.log10_slow) && same(a.log10_memory_rows, b.log10_memory_rows)));
}

/// One point after the other. As several cost no more than one (lanes), what may be asked for next is seen to
/// with it.
class Search {
 public:
  Search(const LinearModel& model, const LevelsSearch& by) : model_(model), by_(by) {
    // Some segments all over the log are enough for few numbers.
    const std::size_t n = model.rows;
    length_ = std::min(n / kNoise.segments, std::max(n / kNoise.segments_of_log, kNoise.segment_rows));
  }

  NoiseLevels From(const NoiseLevels* before) {
    std::vector<Move> white;
    for (const double step : {0.75, 0.375, 0.19, 0.09}) white.push_back({&NoiseLevels::log10_torque, step});
    std::vector<NoiseLevels> first;
    if (before != nullptr)
      first.push_back(by_.slow_torque ? *before : NoiseLevels{.log10_torque = before->log10_torque});
    else
      for (double x = -4.5; x <= 4.6; x += 1.5) first.push_back({.log10_torque = x});
    LookAtAll(first, before != nullptr ? white : std::vector<Move>());
    Along(white);
    if (!by_.slow_torque) return best_;
    AddSlow();
    DropSlow();
    return best_;
  }

 private:
  struct Known {
    NoiseLevels levels;
    double unlikely = 0.0;
  };

  static bool Allowed(const NoiseLevels& l) {
    const double shortest = std::log10(kShortestMemory), longest = std::log10(kLongestMemory);
    return !l.slow_there || (l.log10_memory_rows >= shortest && l.log10_memory_rows <= longest);
  }

  [[nodiscard]] const Known* Find(const NoiseLevels& l) const {
    const auto at =
        std::find_if(known_.begin(), known_.end(), [&](const Known& k) { return SameLevels(k.levels, l); });
    return at == known_.end() ? nullptr : &*at;
  }

  /// The point, and what comes after it wherever it leads, as far as there is room.
  void Look(const NoiseLevels& l, std::span<const Move> next) {
    if (!Allowed(l)) return;
    if (Find(l) == nullptr) {
      std::vector<NoiseLevels> points = {l};
      AddNext({best_, l}, next, points);
      Evaluate(points);
    }
    const double unlikely = Find(l)->unlikely;
    if (!(unlikely < lowest_)) return;
    lowest_ = unlikely;
    best_ = l;
  }

  void LookAtAll(std::vector<NoiseLevels> points, std::span<const Move> next) {
    const std::vector<NoiseLevels> asked = points;
    if (points.size() == 1) AddNext(asked, next, points);
    std::erase_if(points, [&](const NoiseLevels& l) { return Find(l) != nullptr; });
    Evaluate(points);
    for (const NoiseLevels& l : asked) Look(l, {});
  }

  /// `from`: where the search may stand.
  void AddNext(std::vector<NoiseLevels> from, std::span<const Move> next,
               std::vector<NoiseLevels>& points) const {
    const auto room = static_cast<std::size_t>(BestLoops().abreast);
    for (const Move& move : next) {
      const std::size_t count = from.size();
      for (std::size_t i = 0; i < count; ++i)
        for (const double by : {-move.step, move.step}) {
          NoiseLevels l = from[i];
          l.*move.number += by;
          const bool there = std::any_of(points.begin(), points.end(),
                                         [&](const NoiseLevels& p) { return SameLevels(p, l); });
          if (!Allowed(l) || there || Find(l) != nullptr) continue;
          if (points.size() >= room) return;
          points.push_back(l);
          from.push_back(l);
        }
    }
  }

  void Evaluate(std::span<const NoiseLevels> points) {
    const std::size_t apart = model_.rows - length_;
    for (std::size_t first = 0; first < points.size(); first += kLanes) {
      const auto some = points.subspan(first, std::min<std::size_t>(kLanes, points.size() - first));
      std::vector<NoiseVariances> noises;
      for (const NoiseLevels& l : some) noises.push_back(VariancesOf(l, by_.reading, by_.unit));
      std::vector<LikelihoodSums> sums(some.size());
      for (std::size_t i = 0; i < kNoise.segments; ++i) {
        const std::size_t from = apart * i / (kNoise.segments - 1);
        AddLikelihoods({model_, by_.counted, by_.period_s, from, from + length_}, noises, sums);
      }
      for (std::size_t i = 0; i < some.size(); ++i)
        known_.push_back({some[i], sums[i].Unlikely() + (some[i].slow_there ? kTwoNumbers : 0.0)});
    }
  }

  void Along(std::span<const Move> moves) {
    for (; !moves.empty(); moves = moves.subspan(1)) {
      const Move& move = moves[0];
      for (const double by : {-move.step, move.step}) {
        NoiseLevels l = best_;
        l.*move.number += by;
        Look(l, by < 0.0 ? moves : moves.subspan(1));
      }
    }
  }

  /// A grid of the torque that is not there yet, then from the best point of it.
  void AddSlow() {
    if (!best_.slow_there) {
      const double torque = best_.log10_torque - 0.1;
      std::vector<NoiseLevels> grid;
      for (double memory = std::log10(kLongestMemory); memory > std::log10(kShortestMemory); memory -= 0.4)
        for (const double slow : {0.5, 1.2, 1.9, 2.6}) grid.push_back({torque, true, slow, memory});
      LookAtAll(grid, {});
    }
    if (!best_.slow_there) return;
    std::vector<Move> moves;
    for (const double step : {0.4, 0.2, 0.1})
      for (double NoiseLevels::*number :
           {&NoiseLevels::log10_slow, &NoiseLevels::log10_memory_rows, &NoiseLevels::log10_torque})
        moves.push_back({number, step});
    Along(moves);
  }

  void DropSlow() {
    if (best_.slow_there) Look({.log10_torque = best_.log10_torque}, {});
  }

  const LinearModel& model_;
  const LevelsSearch& by_;
  std::size_t length_ = 0;
  std::vector<Known> known_;
  NoiseLevels best_;
  double lowest_ = std::numeric_limits<double>::infinity();
};

}  // namespace

NoiseVariances VariancesOf(const NoiseLevels& levels, double reading, double unit) {
  NoiseVariances out;
  out.reading = reading;
  out.torque = reading * unit * unit * std::pow(10.0, levels.log10_torque);
  if (!levels.slow_there) return out;
  out.keep = std::exp(-std::pow(10.0, -levels.log10_memory_rows));
  // Of a first-order noise of unit variance the density at 0 Hz is (1 + keep) / (1 - keep) that of white one.
  out.slow = out.torque * std::pow(10.0, levels.log10_slow) * (1.0 - out.keep) / (1.0 + out.keep);
  return out;
}

NoiseLevels LikeliestLevels(const LinearModel& model, const LevelsSearch& search, const NoiseLevels* before) {
  return Search(model, search).From(before);
}

std::size_t FewestRowsOfLevels() { return kNoise.segments * kNoise.settling_rows; }

}  // namespace contour::diagnosis
