/* The sub-steps of simulate.Batch, friction_laws and needed_torque.NeededTorque in one pass, for speed: those
   are the definition, and a test compares. Shares nothing with contourd. Tables are numbers by axes; before
   this text stand the enums of their rows. */
#include <math.h>
#include <string.h>

#define TURN 6.283185307179586
#define P(name) p[P_##name * n + i]
#define S(name) s[S_##name * n + i]
#define M(name) m[M_##name * n + i]

enum { LUGRE, DAHL, MAXWELL_SLIP };

static double clipped(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

/* z, stiffness: of the one bristle, or of ten elements. */
static double law_torque(int law, int n, int i, double s0, double s1, const double* stiffness, double* z,
                         double w, double level, double h) {
  if (law == LUGRE) {
    const double before = z[i];
    z[i] = (before + h * w) / (1.0 + h * fabs(w) * s0 / level);
    return 0.5 * s0 * (z[i] + before) + s1 * (z[i] - before) / h;
  }
  if (law == DAHL) {
    const double before = z[i], end = level / s0;
    const double sign = (w > 0.0) - (w < 0.0), left = clipped(1.0 - sign * before / end, 0.0, 2.0);
    z[i] = clipped(before + h * w * left * left, -end, end);
    return 0.5 * s0 * (z[i] + before);
  }
  double sum = 0.0;
  for (int e = 0; e < 10; ++e) {
    double* const at = &z[e * n + i];
    const double k = stiffness[e * n + i], end = 0.1 * level / k, before = *at;
    *at = clipped(before + h * w, -end, end);
    sum += 0.5 * k * (*at + before);
  }
  return sum;
}

static double level_at(double w, double fc, double fs, double vs, double exponent) {
  const double x = fabs(w) / vs;
  return fc + (fs - fc) * exp(-(exponent == 1.0 ? x : exponent == 2.0 ? x * x : pow(x, exponent)));
}

static double friction(int law, int n, int i, const double* p, double* s, const double* stiffness, double* z,
                       double w, double q, double h) {
  const double side = (w > 0.0) - (w < 0.0);
  const double ripple = P(ripple) == 0.0 ? 1.0 : 1.0 + P(ripple) * sin(P(ripple_order) * q + P(phase));
  const double level = level_at(w, P(Fc), P(Fs), P(vs), P(stribeck_exponent)) *
                       fmax(0.05, P(level_factor) * ripple + 0.5 * P(asymmetry) * side);
  const double hard =
      law_torque(law, n, i, P(sigma0), P(sigma1), stiffness, z, w, level * (1.0 - P(soft_share)), h);
  double soft = 0.0;
  if (P(soft_share) > 0.0) {
    const double k = P(sigma0) * fmax(P(soft_share) * P(soft_ratio), 1e-6);
    S(soft) = (S(soft) + h * w) / (1.0 + h * fabs(w) * k / (level * fmax(P(soft_share), 1e-9)));
    soft = k * S(soft);
  }
  return hard + soft + P(viscous) * w * (1.0 + 0.5 * P(asymmetry_viscous) * side) +
         P(square_drag) * w * fabs(w) / (P(fast_rad_s) * P(fast_rad_s));
}

static void step(int law, int n, int i, const double* p, double* s, double* x, const double* stiffness,
                 double* z, double command, double noise, double t, double h) {
  const double keep = P(keep), mean = command + (S(torque) - command) * P(kept_mean);
  S(torque) = command + (S(torque) - command) * keep;
  const double of_rated = mean / P(rated);
  double motor = mean * P(ratio) * (1.0 - P(saturation) * of_rated * of_rated) + noise;
  const int on_load = P(friction_on_load) > 0.5;
  const double w = (on_load ? x[3] : x[1]) + 0.5 * h * S(last_acceleration);
  const double f = friction(law, n, i, p, s, stiffness, z, w, x[0], h);
  if (P(cogging) != 0.0) motor -= P(cogging) * sin(P(cogging_order) * x[0] + P(phase));
  double outside = P(outside);
  if (P(vibration) != 0.0) outside -= P(vibration) * sin(TURN * P(vibration_Hz) * t);
  const double half = 0.5 * P(gap), twist = x[0] - x[2], spin = x[1] - x[3];
  const double lost = P(k) * clipped(twist, -half, half) + P(d) * spin * (fabs(twist) < half);
  const double on[2] = {motor + lost - (on_load ? 0.0 : f), outside - lost - (on_load ? f : 0.0)};
  double to[4];
  for (int r = 0; r < 4; ++r) {
    to[r] = p[(P_b + 2 * r) * n + i] * on[0] + p[(P_b + 2 * r + 1) * n + i] * on[1];
    for (int c = 0; c < 4; ++c) to[r] += p[(P_a + 4 * r + c) * n + i] * x[c];
  }
  S(last_acceleration) = (on_load ? to[3] - x[3] : to[1] - x[1]) / h;
  S(heat) = f * w;
  memcpy(x, to, sizeof(to));
}

static void look(int law, int n, int i, const double* p, double* m, const double* x, const double* stiffness,
                 double* z, double command, double h) {
  const double wave = P(reading_order) * x[0] + P(phase);
  const double q1 = P(reading) == 0.0 ? x[0] : x[0] + P(reading) * sin(wave);
  const double w1 = P(reading) == 0.0 ? x[1] : x[1] * (1.0 + P(reading) * P(reading_order) * cos(wave));
  const double arriving = command + (M(torque) - command) * (1.0 - M(keep)) * M(lag_s) / h;
  M(torque) = command + (M(torque) - command) * M(keep);
  const int on_load = P(friction_on_load) > 0.5;
  const double side = (on_load ? M(w2) : M(w1)) + 0.5 * h * M(acceleration);
  const double f = law_torque(law, n, i, M(sigma0), M(sigma1), stiffness, z, side,
                              level_at(side, M(Fc), M(Fs), M(vs), M(stribeck_exponent)), h) +
                   M(sigma2) * side;
  const double behind = on_load ? f : 0.0, k = M(stiffness), d = M(d);
  const double twist = M(q1) - M(q2), spin = M(w1) - M(w2);
  const double pull = 0.5 * k * (twist + q1 - M(q2) - 0.5 * h * M(w2)) + 0.5 * d * (spin + w1);
  const double w2 = M(share) * (M(load_inertia) / h * M(w2) - behind + pull),
               q2 = M(q2) + 0.5 * h * (M(w2) + w2);
  const double coupling = 0.5 * (k * (twist + q1 - q2) + d * (spin + w1 - w2));
  M(too_many) += arriving - M(motor_inertia) * (w1 - M(w1)) / h - coupling - (on_load ? 0.0 : f);
  M(acceleration) = (on_load ? w2 - M(w2) : w1 - M(w1)) / h;
  M(q1) = q1, M(w1) = w1, M(q2) = q2, M(w2) = w2;
}

/* A tick: `commands`, `stated` are sub-steps by axes; m is null where no model looks. x: axes by four. */
void steps(int law, int n, int sub, double h, double t, const double* p, double* s, double* x,
           const double* stiffness, double* z, const double* commands, const double* noise, double* m,
           const double* model_stiffness, double* model_z, double* twin, const double* twin_stiffness,
           double* twin_z, const double* stated) {
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < sub; ++j) {
      step(law, n, i, p, s, x + 4 * i, stiffness, z, commands[j * n + i], noise[i], t + j * h, h);
      if (!m) continue;
      look(law, n, i, p, m, x + 4 * i, model_stiffness, model_z, stated[j * n + i], h);
      look(law, n, i, p, twin, x + 4 * i, twin_stiffness, twin_z, stated[j * n + i], h);
    }
}
