#pragma once

/// Cosine and sine of a fraction of a turn as plain arithmetic: the same on every machine, and exact for
/// whole turns however many.
namespace contour {

struct CosSin {
  double cos = 1.0;
  double sin = 0.0;
};

/// Of 2 pi turns. |turns| < 2^51. Error below 1e-15.
inline CosSin Turn(double turns) noexcept {
  constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52: adding it rounds to an integer
  const double quarters = turns * 4.0;
  const double quarter = (quarters + kShift) - kShift;  // nearest whole number
  // |x| <= pi / 4
  const double x = (quarters - quarter) * 1.5707963267948966;
  const double y = x * x;
  constexpr double k15 = -1.0 / 1307674368000.0;
  constexpr double k14 = -1.0 / 87178291200.0;
  const double s =
      x * (1.0 + y * (-1.0 / 6 +
                      y * (1.0 / 120 + y * (-1.0 / 5040 +
                                            y * (1.0 / 362880 + y * (-1.0 / 39916800 +
                                                                     y * (1.0 / 6227020800.0 + y * k15)))))));
  const double c =
      1.0 +
      y * (-0.5 +
           y * (1.0 / 24 + y * (-1.0 / 720 +
                                y * (1.0 / 40320 + y * (-1.0 / 3628800 + y * (1.0 / 479001600 + y * k14))))));
  // Quarter modulo 4, in -2 .. 2, and what it does to both; no branches, so that loops vectorise.
  const double whole = (quarter * 0.25 + kShift) - kShift;  // whole turns
  const double phase = quarter - 4.0 * whole;
  const double size = phase < 0.0 ? -phase : phase;
  const bool odd = size == 1.0;
  const double along = odd ? s : c;
  const double across = odd ? c : s;
  // phase: 0: c, s; 1: -s, c; 2 and -2: -c, -s; -1: s, -c
  const double cos_sign = phase == 1.0 ? -1.0 : size == 2.0 ? -1.0 : 1.0;
  const double sin_sign = phase == -1.0 ? -1.0 : size == 2.0 ? -1.0 : 1.0;
  return {cos_sign * along, sin_sign * across};
}

}  // namespace contour
