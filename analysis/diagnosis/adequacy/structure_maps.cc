#include "analysis/diagnosis/adequacy/structure_maps.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <utility>

#include "analysis/diagnosis/screening/gross_sliding.h"
#include "analysis/diagnosis/tuning/adequacy_tuning.h"
#include "analysis/diagnosis/tuning/screening_tuning.h"

namespace contour::diagnosis {
namespace {

constexpr int kBins = kScreening.bins;
constexpr double kDegreesPerTurn = 360.0;
// Of a range, and of a speed that divides.
constexpr double kLeast = 1e-12;
constexpr double kTurn = 2.0 * std::numbers::pi;

struct Range {
  double low = 0.0, high = 1.0;
  [[nodiscard]] int Bin(double x, int count) const {
    if (!(high > low)) return 0;
    return std::clamp(static_cast<int>((x - low) / (high - low) * count), 0, count - 1);
  }
  [[nodiscard]] double Middle(int bin, int count) const { return low + (high - low) * (bin + 0.5) / count; }
};

Range RangeOf(const Signal& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return {*low, std::max(*high, *low + kLeast)};
}

std::string Text(double x, const char* unit) {
  char text[48];
  std::snprintf(text, sizeof text, "%.3g %s", x, unit);
  return text;
}

/// Slow speeds in finer steps.
int SpeedBin(const Signals& s, std::size_t k) {
  return Range{}.Bin(std::sqrt(std::fabs(s.velocity[k]) / std::max(s.max_speed, kLeast)), kBins);
}

/// Of the travel of the table: a rotary axis without a lead turns.
struct TravelUnit {
  double per_unit;
  const char *travel, *speed, *after_reversal;
};
TravelUnit UnitOf(const Problem& p) {
  const bool turns = !p.log.linear && p.stated.table_per_q == 1.0;
  return turns ? TravelUnit{1.0, "rad", "rad/s", "rad after a reversal"}
               : TravelUnit{1e3, "mm", "mm/s", "mm after a reversal"};
}

class Maps {
 public:
  Maps(const Problem& p, const std::vector<bool>& slides)
      : p_(p), s_(*p.signals), n_(p.rows()), slides_(slides) {}

  std::vector<BinnedRows> All() {
    const Range x = RangeOf(s_.table_m);
    const TravelUnit unit = UnitOf(p_);
    BothDirections(
        "the position", Quantity::kPosition, kBins,
        [&](std::size_t k) { return x.Bin(s_.table_m[k], kBins); },
        [x, unit, middle_m = s_.middle_m](int b) {
          return Text(unit.per_unit * (x.Middle(b, kBins) + middle_m), unit.travel);
        });
    BothDirections(
        "the speed", Quantity::kSpeed, kBins, [&](std::size_t k) { return SpeedBin(s_, k); },
        [unit, fastest_m_s = s_.max_speed * p_.stated.table_per_q](int b) {
          return Text(unit.per_unit * fastest_m_s * std::pow(Range{}.Middle(b, kBins), 2), unit.speed);
        });
    const std::vector<double> travel = TravelSinceReversal(s_);
    // From the length of a bristle on.
    const StatedFriction& f = p_.nominal.friction;
    const double shortest_m = std::max(f.Fc_plus / f.s0 * p_.stated.table_per_q, kLeast);
    const Range log_travel{std::log(shortest_m), std::log(2.0 * s_.half_stroke_m + shortest_m)};
    BothDirections(
        "the travel since the last reversal", Quantity::kTravelSinceReversal, kBins,
        [&](std::size_t k) { return log_travel.Bin(std::log(travel[k] + shortest_m), kBins); },
        [unit, log_travel](int b) {
          return Text(unit.per_unit * std::exp(log_travel.Middle(b, kBins)), unit.after_reversal);
        });
    BothDirections(
        "the angle of the motor", Quantity::kAngle, kBins,
        [&](std::size_t k) {
          const double turns = s_.angle_rad[k] / kTurn;
          return Range{}.Bin(turns - std::floor(turns), kBins);
        },
        [](int b) { return Text(kDegreesPerTurn * Range{}.Middle(b, kBins), "degrees"); });
    out_.back().series = true;
    if (!s_.temperature_K.empty()) {
      const Range t = RangeOf(s_.temperature_K);
      BothDirections(
          "the temperature", Quantity::kTemperature, kBins,
          [&](std::size_t k) { return t.Bin(s_.temperature_K[k], kBins); },
          [t, mean_degC = s_.mean_degC](int b) { return Text(t.Middle(b, kBins) + mean_degC, "degC"); });
    }
    OfTime("time, as a torque", kAdequacy.time_bin_s, {}, kUnexplainedTorque);
    OfTime("time, as friction", kAdequacy.time_bin_s, s_.sign, kUnexplainedFriction);
    return std::move(out_);
  }

 private:
  template <class BinOf, class PlaceOf>
  void BothDirections(const char* over, Quantity quantity, int count, BinOf&& bin_of, PlaceOf place) {
    BinnedRows rows;
    rows.over = std::string(over) + " and the direction";
    rows.quantity = quantity;
    rows.bin.assign(n_, -1);
    rows.count = 2 * count;
    for (std::size_t k = 0; k < n_; ++k)
      if (slides_[k]) rows.bin[k] = bin_of(k) + (s_.sign[k] > 0.0 ? count : 0);
    rows.place = [count, place](int b) {
      return place(b % count) + (b < count ? ", moving down" : ", moving up");
    };
    out_.push_back(std::move(rows));
  }

  void OfTime(const char* over, double each_s, const std::vector<double>& size,
              std::string_view structure_class) {
    const Range time{0.0, static_cast<double>(n_) * p_.log.period_s};
    const int count = std::max(1, static_cast<int>(time.high / each_s));
    BinnedRows rows;
    rows.over = over;
    rows.quantity = Quantity::kTime;
    rows.bin.assign(n_, -1);
    rows.size = size;
    rows.structure_class = structure_class;
    rows.count = count;
    for (std::size_t k = 0; k < n_; ++k)
      if (slides_[k]) rows.bin[k] = time.Bin(static_cast<double>(k) * p_.log.period_s, count);
    rows.place = [time, count](int b) { return Text(time.Middle(b, count), "s"); };
    out_.push_back(std::move(rows));
  }

  const Problem& p_;
  const Signals& s_;
  std::size_t n_;
  const std::vector<bool>& slides_;
  std::vector<BinnedRows> out_;
};

}  // namespace

std::vector<bool> Slides(const Problem& p) {
  std::vector<bool> out(p.rows());
  for (std::size_t k = 0; k < out.size(); ++k)
    out[k] = p.counted[k] != 0 && std::fabs(p.signals->sign[k]) > kFollowsMotion;
  return out;
}

std::vector<BinnedRows> StructureMaps(const Problem& problem, const std::vector<bool>& slides) {
  return Maps(problem, slides).All();
}

BinnedRows FrictionCurve(const Problem& problem, const std::vector<bool>& slides) {
  const Signals& s = *problem.signals;
  BinnedRows rows;
  rows.bin.assign(slides.size(), -1);
  rows.size = s.sign;
  rows.count = kBins;
  for (std::size_t k = 0; k < slides.size(); ++k)
    if (slides[k]) rows.bin[k] = SpeedBin(s, k);
  return rows;
}

}  // namespace contour::diagnosis
