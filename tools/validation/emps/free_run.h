#pragma once

#include <cstddef>
#include <string>
#include <vector>

// Free runs of a rigid linear axis on its recorded force, for the EMPS data set. The friction here is written
// for fitting; nothing of the daemon or the emulator is in it.
namespace contour::emps {

/// One recording: position raw and filtered forward and backward (4th-order Butterworth, 150 Hz), velocity
/// its central difference; and the same at 50 Hz, with the force filtered alike, for force residuals.
struct Recording {
  std::string name;
  std::vector<double> time_s, reference_m, position_m, force_N;
  std::vector<double> filtered_m, velocity_m_s;
  std::vector<double> slow_position_m, slow_velocity_m_s, slow_acceleration_m_s2, slow_force_N;
};

/// Reads a file of the data set (columns t_s, qg_m, qm_m, force_N) and filters it. Throws ConfigError.
Recording ReadRecording(const std::string& file, const std::string& name);

/// M a = F - friction + offset, friction opposing motion:
///   sgn(v) (Fc(dir) + dFs(dir) exp(-|v| / vs)) (1 + x1 s + x2 s^2) (1 + ripple(x)) + Fv(dir) v,
/// s = (x - 0.12 m) / 0.12 m, the stroke's middle and half; ripple once and twice per motor turn of 2.5 mm.
struct Parameters {
  double mass_kg = 0.0;
  double Fv_plus_Ns_m = 0.0, Fv_minus_Ns_m = 0.0;
  double Fc_plus_N = 0.0, Fc_minus_N = 0.0;
  double offset_N = 0.0;  ///< positive pushes towards positive position
  double dFs_plus_N = 0.0, dFs_minus_N = 0.0;
  double vs_m_s = 10e-3;
  double x1 = 0.0, x2 = 0.0;
  double ripple_cos1 = 0.0, ripple_sin1 = 0.0, ripple_cos2 = 0.0, ripple_sin2 = 0.0;
};

inline constexpr double kTurn_m = 2.5e-3;
inline constexpr std::size_t kWindow = 1000;

/// A range of rows, and the windows of `length` rows that fit into it every `step` rows.
struct Segment {
  std::size_t from = 0, to = 0;
  [[nodiscard]] std::vector<std::size_t> Windows(std::size_t length, std::size_t step) const;
};

/// Positions of `rows` rows from row `start` on the recorded force alone, held over each sample; five steps
/// per sample.
std::vector<double> FreeRun(const Parameters& p, const Recording& r, std::size_t start, std::size_t rows);

/// Root mean square of model minus raw position over consecutive windows of a second.
double FreeRunRmse_m(const Parameters& p, const Recording& r, const Segment& segment);

}  // namespace contour::emps
