#include "analysis/prediction_error/likelihoods.h"

#include <cstddef>

#include "analysis/diagnosis/tuning/prediction_tuning.h"
#include "analysis/prediction_error/simd/lane_likelihood.h"
#include "analysis/prediction_error/simd/lane_loops.h"

namespace contour::diagnosis {

void AddLikelihoods(const PassRows& rows, std::span<const NoiseVariances> noises,
                    std::span<LikelihoodSums> sums) {
  const LinearModel& model = rows.model;
  LaneLikelihood m;
  m.from = rows.from;
  m.to = rows.to;
  m.stride = model.stride;
  m.states = model.states;
  m.settling = kNoise.settling_rows;
  m.most_square = kMostSquare;
  m.step = model.step.data();
  m.valid = model.valid.data();
  m.counted = rows.counted.data();
  m.innovation = model.innovation.data();
  m.begins = model.begins.data();
  m.begins_count = model.begins.size();
  m.lanes = noises.size();
  m.reading = noises[0].reading;
  m.start_w = m.reading / (rows.period_s * rows.period_s);
  m.count = sums[0].count;
  for (std::size_t i = 0; i < noises.size(); ++i) {
    m.slow = m.slow || noises[i].slow > 0.0;
    m.torque[i] = noises[i].torque;
    m.slow_torque[i] = noises[i].slow;
    m.keep[i] = noises[i].keep;
    m.squares[i] = sums[i].squares;
    m.logs[i] = sums[i].logs;
  }
  BestLoops().likelihood(m);
  for (std::size_t i = 0; i < noises.size(); ++i) sums[i] = {m.squares[i], m.logs[i], m.count};
}

}  // namespace contour::diagnosis
