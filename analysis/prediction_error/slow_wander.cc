#include "analysis/prediction_error/slow_wander.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "analysis/diagnosis/tuning/prediction_tuning.h"

namespace contour::diagnosis {
namespace {

// Rows that are one datum where the wander is learnt: what is faster the taps take out.
constexpr std::size_t kTogether = kNoise.whitener_order;

/// The variance of what is not known yet of the wander, from row to row.
class Unknown {
 public:
  explicit Unknown(const SlowWander& wander)
      : keep_(std::exp(-1.0 / wander.memory_rows)), all_(wander.variance), now_(wander.variance) {}

  void BeginAnew() { now_ = all_; }
  /// Before a row with so much information.
  [[nodiscard]] double now() const { return now_; }
  void Past(double information) {
    const double left = now_ / (now_ * information + 1.0);
    now_ = keep_ * keep_ * left + (1.0 - keep_ * keep_) * all_;
  }
  [[nodiscard]] double keep() const { return keep_; }

 private:
  double keep_, all_, now_;
};

struct Means {
  std::vector<double> mean, information;
  std::vector<std::size_t> begins;
};

Means MeansOf(std::span<const double> white, std::span<const double> root_weight,
              std::span<const std::size_t> begins) {
  Means out;
  auto next = begins.begin();
  for (std::size_t from = 0; from < white.size(); from += kTogether) {
    double sum = 0.0, information = 0.0;
    const std::size_t to = std::min(white.size(), from + kTogether);
    for (std::size_t k = from; k < to; ++k) {
      const double w = root_weight[k] * root_weight[k];
      sum += w * white[k];
      information += w;
    }
    bool anew = false;
    for (; next != begins.end() && *next < to; ++next) anew = true;
    if (anew) out.begins.push_back(out.mean.size());
    out.mean.push_back(information > 0.0 ? sum / information : 0.0);
    out.information.push_back(information);
  }
  return out;
}

/// -2 log likelihood, beyond that of no wander at all.
double Unlikely(const SlowWander& wander, const Means& means) {
  Unknown unknown(wander);
  auto next = means.begins.begin();
  double state = 0.0, sum = 0.0;
  for (std::size_t b = 0; b < means.mean.size(); ++b) {
    if (next != means.begins.end() && *next == b) {
      unknown.BeginAnew();
      state = 0.0;
      ++next;
    }
    const double information = means.information[b], spread = unknown.now() * information + 1.0;
    const double off = means.mean[b] - state;
    sum += std::log(spread) + information * (off * off / spread - means.mean[b] * means.mean[b]);
    state = unknown.keep() * (state + unknown.now() * information / spread * off);
    unknown.Past(information);
  }
  return sum;
}

/// Calls with each row's weight and the variance that is not known before it.
template <typename Row>
void AlongRows(const SlowWander& wander, std::span<const double> root_weight,
               std::span<const std::size_t> begins, double per_row, const Row& row) {
  Unknown unknown(wander);
  auto next = begins.begin();
  for (std::size_t k = 0; k < root_weight.size(); ++k) {
    const bool anew = next != begins.end() && *next == k;
    if (anew) {
      unknown.BeginAnew();
      ++next;
    }
    const double information = root_weight[k] * root_weight[k] / per_row;
    row(k, anew, information, unknown.now());
    unknown.Past(information);
  }
}

/// Each row waits for the one before it; columns next to each other do not wait for each other.
constexpr std::size_t kAbreast = 8;

struct Innovations {
  double keep;
  std::span<const double> root_weight;
  std::vector<double> narrow, gain;
  std::vector<std::uint8_t> begin;

  template <std::size_t kColumns>
  void Of(double* const* columns) const {
    double* x[kColumns];
    std::copy_n(columns, kColumns, x);
    double state[kColumns] = {};
    for (std::size_t k = 0; k < narrow.size(); ++k) {
      if (begin[k] != 0) std::fill_n(state, kColumns, 0.0);
      for (std::size_t i = 0; i < kColumns; ++i) {
        x[i][k] = (x[i][k] - root_weight[k] * state[i]) * narrow[k];
        state[i] = keep * (state[i] + gain[k] * x[i][k]);
      }
    }
  }

  /// As many as there are, which are no more than so many.
  template <std::size_t kColumns>
  void OfAll(std::span<double* const> columns) const {
    if (columns.size() == kColumns) return Of<kColumns>(columns.data());
    if constexpr (kColumns > 1) OfAll<kColumns - 1>(columns);
  }
};

}  // namespace

SlowWander LearnSlowWander(std::span<const double> white, std::span<const double> root_weight,
                           std::span<const std::size_t> begins) {
  const Means means = MeansOf(white, root_weight, begins);
  double squares = 0.0, information = 0.0;
  for (std::size_t b = 0; b < means.mean.size(); ++b) {
    squares += means.information[b] * means.mean[b] * means.mean[b];
    information += means.information[b];
  }
  SlowWander best;
  if (!(squares > 0.0)) return best;
  double least = 0.0;
  const auto count = static_cast<double>(means.mean.size());
  // By factors of two: the likelihood is flat.
  for (double memory = count; memory >= 1.0; memory /= 2.0)
    for (double variance = 2.0 * squares / information; variance * information > 1.0; variance /= 2.0) {
      const double unlikely = Unlikely({memory, variance}, means);
      if (unlikely >= least) continue;
      least = unlikely;
      best = {memory * static_cast<double>(kTogether), variance};
    }
  return best;
}

void TakeOutWander(const SlowWander& wander, std::span<const double> root_weight,
                   std::span<const std::size_t> begins, double per_row, std::span<double* const> columns) {
  if (!(wander.variance > 0.0)) return;
  Innovations to{Unknown(wander).keep(), root_weight, {}, {}, {}};
  to.narrow.resize(root_weight.size());
  to.gain.resize(root_weight.size());
  to.begin.assign(root_weight.size(), 0);
  AlongRows(wander, root_weight, begins, per_row,
            [&](std::size_t k, bool anew, double information, double unknown) {
              to.narrow[k] = 1.0 / std::sqrt(unknown * information + 1.0);
              to.gain[k] = unknown * root_weight[k] / per_row * to.narrow[k];
              to.begin[k] = anew ? 1 : 0;
            });
  for (; columns.size() > kAbreast; columns = columns.subspan(kAbreast)) to.Of<kAbreast>(columns.data());
  to.OfAll<kAbreast>(columns);
}

double LogVariances(const SlowWander& wander, std::span<const double> root_weight,
                    std::span<const std::size_t> begins) {
  if (!(wander.variance > 0.0)) return 0.0;
  double sum = 0.0;
  AlongRows(wander, root_weight, begins, 1.0, [&](std::size_t, bool, double information, double unknown) {
    sum += std::log(unknown * information + 1.0);
  });
  return sum;
}

}  // namespace contour::diagnosis
