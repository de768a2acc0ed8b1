#pragma once

#include <complex>
#include <vector>

namespace contour::diagnosis {

using HalfSpectrum = std::vector<std::complex<double>>;

/// Of a real signal of even length n, without scale: n / 2 + 1 values, from frequency 0 to half the rate.
/// Eigen's own transform (kissfft), which plans nothing at run time: the same bits on every machine.
HalfSpectrum FourierTransform(const std::vector<double>& signal);

/// The real signal of so many values that the half spectrum is of; undoes FourierTransform.
std::vector<double> InverseFourierTransform(const HalfSpectrum& spectrum);

}  // namespace contour::diagnosis
