#include "tests/analysis/support/scalar_predictor.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>

namespace contour::diagnosis::test {
namespace {

/// Wind-up and its speed after a time, from both and a constant difference of the accelerations.
Eigen::Matrix3d Coupling(const AxisModel& m, double load_inertia, double time_s) {
  const double per_inertia = 1.0 / m.motor_inertia + 1.0 / load_inertia;
  Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
  a(0, 1) = a(1, 2) = 1.0;
  a(1, 0) = -m.stiffness * per_inertia;
  a(1, 1) = -m.damping * per_inertia;
  return (a * time_s).exp();
}

struct Bodies {
  double theta = 0.0, w = 0.0, theta_load = 0.0, w_load = 0.0;
};

/// Both bodies after a time under constant accelerations from outside.
Bodies Moved(const Bodies& b, const AxisModel& m, double load_inertia, double motor, double load,
             double time_s) {
  const double part = m.motor_inertia / (m.motor_inertia + load_inertia);
  const Eigen::Vector3d d = Coupling(m, load_inertia, time_s) *
                            Eigen::Vector3d(b.theta - b.theta_load, b.w - b.w_load, motor - load);
  const double speed = part * b.w + (1.0 - part) * b.w_load;
  const double acceleration = part * motor + (1.0 - part) * load;
  const double centre =
      part * b.theta + (1.0 - part) * b.theta_load + time_s * speed + 0.5 * time_s * time_s * acceleration;
  const double after = speed + time_s * acceleration;
  Bodies out;
  out.theta_load = centre - part * d(0);
  out.theta = out.theta_load + d(0);
  out.w_load = after - part * d(1);
  out.w = out.w_load + d(1);
  return out;
}

struct Substep {
  double velocity, end, rate;
};

class Run {
 public:
  Run(const FilterSetup& setup, const AxisModel& model)
      : setup_(setup),
        m_(model),
        substeps_(SubstepsOf(setup, model)),
        h_(setup.log->period_s / substeps_),
        delivered_(DeliveredMeans(*setup.log, model.delay_s - model.lag_for_delay_s,
                                  model.lag_s + model.lag_for_delay_s, substeps_)) {
    stiff_ = 1.0 - m_.soft_share;
    s0_ = m_.friction.s0 * stiff_;
    soft_s0_ = m_.friction.s0 * m_.soft_share * m_.soft_ratio;
    soft_rate_ = std::max(1e-9, soft_s0_ / (s0_ * (m_.soft_share / stiff_)));
    b_.theta = b_.theta_load = setup.start[0];
    b_.w = b_.w_load = setup.start[1];
    z_ = m_.start_bristle;
  }

  std::vector<double> Innovation() {
    const std::size_t rows = setup_.log->size();
    std::vector<double> innovation(rows, 0.0);
    for (std::size_t k = 0; k < rows; ++k) {
      if (setup_.valid[k] != 0) innovation[k] = Correct(k);
      z_before_ = z_;
      soft_before_ = soft_;
      path_.clear();
      for (int j = 0; j < substeps_ && k + 1 < rows; ++j) Step(k, j);
      predicted_ = OnLoad() ? b_.theta_load : b_.theta;
    }
    return innovation;
  }

 private:
  bool OnLoad() const { return m_.two_inertia && m_.friction_on_load; }

  /// Of a signal inside row k.
  double At(const SharedSignal& s, std::size_t k, double share) const {
    if (!s) return 0.0;
    const std::size_t rows = setup_.log->size();
    const double to = s->size() == 2 * rows ? (*s)[rows + k] : (*s)[k + 1];
    return (*s)[k] + share * (to - (*s)[k]);
  }

  double WearSpeed(double v) const { return std::sqrt(std::max(v * v + m_.rough, 1e-4 * v * v + 1e-60)); }

  double Level(double v, double factor) const {
    const StatedFriction& f = m_.friction;
    const double fc = v < 0.0 ? f.Fc_minus : f.Fc_plus, fs = v < 0.0 ? f.Fs_minus : f.Fs_plus;
    const double y = std::fabs(v) / f.vs, x = f.exponent > 1.5 ? y * y : y;
    const double smallest = 1e-3 * 0.5 * (f.Fc_plus + f.Fc_minus);
    return std::max(smallest, factor * stiff_ * (fc + (fs - fc) * std::exp(-x)));
  }

  double Correct(std::size_t k) {
    const ObserverGain& l = m_.two_inertia ? setup_.gain_two : setup_.gain;
    const double reading_error = m_.reading_error ? (*m_.reading_error)[k] : 0.0;
    const double e = setup_.log->position[k] - reading_error - b_.theta;
    b_.theta += l[0] * e;
    b_.w += l[1] * e;
    if (m_.two_inertia) {
      b_.theta_load += l[2] * e;
      b_.w_load += l[3] * e;
    }
    if (k == 0) return e;
    // Presliding once more, along the corrected path.
    const double shift = ((OnLoad() ? b_.theta_load : b_.theta) - predicted_) / setup_.log->period_s;
    z_ = z_before_;
    soft_ = soft_before_;
    for (const Substep& s : path_) {
      const double v = s.velocity + shift, speed = WearSpeed(v);
      MoveBristles(s.rate * speed, s.end * v / speed);
    }
    return e;
  }

  void MoveBristles(double x, double end) {
    z_ = end + (z_ - end) * std::exp(-x);
    if (m_.soft_share > 0.0)
      soft_ = end / soft_rate_ + (soft_ - end / soft_rate_) * std::exp(-x * soft_rate_);
  }

  void Step(std::size_t k, int j) {
    const StatedFriction& f = m_.friction;
    const std::size_t at = k * static_cast<std::size_t>(substeps_) + static_cast<std::size_t>(j);
    const double share = (j + 0.5) / substeps_;
    const double carried =
        (m_.two_inertia ? m_.load_inertia : m_.motor_inertia) + (k >= m_.payload_row ? m_.payload : 0.0);
    const double torque = delivered_.mean[at];
    double motor = torque * (m_.torque_gain - m_.saturation * torque * torque) + m_.offset +
                   At(m_.motor_force, k, share);
    double load = At(m_.load_force, k, share);
    const double late = m_.torque_gain * delivered_.late[at] / (m_.two_inertia ? m_.motor_inertia : carried);
    const double known = s0_ * z_ + drag_ + soft_s0_ * soft_;
    const double v = SpeedHalfStep(motor, load, known, carried);
    const double g = Level(v, 1.0 + At(m_.level, k, share)), speed = WearSpeed(v);
    path_.push_back({v, g / s0_, s0_ * h_ / g});
    const double z = z_, soft = soft_;
    MoveBristles(s0_ * h_ / g * speed, g / s0_ * v / speed);
    const double fading = f.vd > 0.0 ? std::exp(-(v / f.vd) * (v / f.vd)) : 1.0;
    const double viscous = f.s2 * (1.0 + (m_.viscous ? (*m_.viscous)[k] : 0.0)) * v;
    drag_ = f.s1 * fading * (z_ - z) / h_ + viscous;
    const double friction = s0_ * 0.5 * (z + z_) + soft_s0_ * 0.5 * (soft + soft_) + drag_;
    if (!m_.two_inertia) {
      b_.w += h_ * (motor + load - friction) / carried;
      b_.theta += 0.5 * h_ * b_.w + late;
      return;
    }
    (OnLoad() ? load : motor) -= friction;
    b_ = Moved(b_, m_, carried, motor / m_.motor_inertia, load / carried, h_);
    b_.theta += late;
  }

  double SpeedHalfStep(double motor, double load, double friction, double carried) {
    if (!m_.two_inertia) {
      b_.theta += 0.5 * h_ * b_.w;
      return b_.w + 0.5 * h_ * (motor + load - friction) / carried;
    }
    (OnLoad() ? load : motor) -= friction;
    const Bodies half = Moved(b_, m_, carried, motor / m_.motor_inertia, load / carried, 0.5 * h_);
    return OnLoad() ? half.w_load : half.w;
  }

  const FilterSetup& setup_;
  const AxisModel& m_;
  int substeps_;
  double h_;
  Delivered delivered_;
  double stiff_, s0_, soft_s0_, soft_rate_;
  Bodies b_;
  double z_ = 0.0, soft_ = 0.0, drag_ = 0.0;
  double z_before_ = 0.0, soft_before_ = 0.0, predicted_ = 0.0;
  std::vector<Substep> path_;
};

}  // namespace

std::vector<double> ScalarInnovation(const FilterSetup& setup, const AxisModel& model) {
  return Run(setup, model).Innovation();
}

}  // namespace contour::diagnosis::test
