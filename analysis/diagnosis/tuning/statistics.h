#pragma once

// Mathematical constants, as everything that was calibrated with them has them rounded.
namespace contour::diagnosis {

/// Standard deviations that 95 % of a normal distribution lie within.
inline constexpr double kNormal95 = 1.96;
/// Of draws in order of size, what lies outside of either end of an interval of 95 %.
inline constexpr double kTail95 = 0.025;
/// Standard deviations that 90 % of cases stay within on one side.
inline constexpr double kNormal90 = 1.2816;
/// A normal distribution's deviation over its median absolute deviation.
inline constexpr double kNormalMad = 1.4826;
/// Variance of a rounding error, over the square of the step.
inline constexpr double kUniformVariance = 1.0 / 12.0;
/// From a number to the nearest whole one, on the average.
inline constexpr double kMeanDistanceToWhole = 0.25;
/// Of the second difference of white noise, over the noise's own: 1 + 2^2 + 1.
inline constexpr double kVarianceOfSecondDifference = 6.0;

}  // namespace contour::diagnosis
