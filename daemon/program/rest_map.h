#pragma once

namespace contour {

/// Way along a path by a parameter u, chosen so that motion from rest to rest has a finite speed of u all the
/// way. From rest at constant jerk the way grows with the cube of time; so does it with u here, over a first
/// part of the path, and likewise at the end. In between, u is the way but for a constant.
class RestMap {
 public:
  struct Derivatives {
    double way_m = 0.0;
    double first = 0.0;
    double second = 0.0;  ///< 1/m
    double third = 0.0;   ///< 1/m^2
  };

  RestMap() = default;
  /// From `from_m` to `to_m`; `begin_m` and `end_m` are twice the ways over which it starts and ends, 0: not
  /// at rest there. Longer ones than fit are shortened.
  RestMap(double from_m, double to_m, double begin_m, double end_m);

  [[nodiscard]] double end_u() const { return end_u_; }
  [[nodiscard]] double begin_width() const { return begin_; }
  [[nodiscard]] double end_width() const { return end_; }
  [[nodiscard]] Derivatives At(double u) const;
  /// As At, where a node belongs to the interval that lies at `within`.
  [[nodiscard]] Derivatives At(double u, double within) const;
  [[nodiscard]] double Inverse(double way_m) const;

 private:
  double from_m_ = 0.0;
  double to_m_ = 0.0;
  double begin_ = 0.0;
  double end_ = 0.0;
  double end_u_ = 0.0;
};

}  // namespace contour
