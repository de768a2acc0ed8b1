#include "control/lqr_terminal.h"

#include <cmath>
#include <stdexcept>

namespace contour {

TerminalFactor LqrTerminal(const AxisDynamics& d, double weight, double effort) {
  if (!(weight > 0.0) || !(effort > 0.0)) throw std::invalid_argument("mpc: weights must be positive");
  const double a = d.position_from_velocity;
  const double e = d.velocity_kept;
  const double c = d.position_from_command;
  const double b_p = c + a * d.velocity_from_command + d.position_from_previous;
  const double b_v = e * d.velocity_from_command + d.velocity_from_previous;
  double pp = weight, pv = 0.0, vv = weight * a * a;
  for (int i = 0; i < 1000000; ++i) {
    const double w_p = pp * b_p + pv * b_v;
    const double w_v = pv * b_p + vv * b_v;
    const double uu = effort + c * weight * c + b_p * w_p + b_v * w_v;
    const double up = w_p + c * weight;
    const double uv = a * w_p + e * w_v;
    const double next_pp = pp + weight - up * up / uu;
    const double next_pv = a * pp + e * pv - up * uv / uu;
    const double next_vv = a * (a * pp + e * pv) + e * (a * pv + e * vv) - uv * uv / uu;
    const double change = std::abs(next_pp - pp) / next_pp + std::abs(next_vv - vv) / next_vv;
    pp = next_pp;
    pv = next_pv;
    vv = next_vv;
    if (change < 1e-14) {
      TerminalFactor f;
      f.pp = std::sqrt(pp);
      f.vp = pv / f.pp;
      f.vv = std::sqrt(vv - f.vp * f.vp);
      return f;
    }
  }
  throw std::invalid_argument("mpc: the weights lead to no stable loop");
}

}  // namespace contour
