#include "analysis/prediction_error/fourier_transform.h"

#include <unsupported/Eigen/FFT>

#ifdef EIGEN_FFTW_DEFAULT
#error "FFTW's plans are made at run time, and its results differ from machine to machine"
#endif

namespace contour::diagnosis {

HalfSpectrum FourierTransform(const std::vector<double>& signal) {
  Eigen::FFT<double> transform(Eigen::FFT<double>::impl_type(), Eigen::FFT<double>::HalfSpectrum);
  HalfSpectrum spectrum;
  transform.fwd(spectrum, signal);
  return spectrum;
}

std::vector<double> InverseFourierTransform(const HalfSpectrum& spectrum) {
  Eigen::FFT<double> transform(Eigen::FFT<double>::impl_type(), Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> signal(2 * (spectrum.size() - 1));
  transform.inv(signal.data(), spectrum.data(), static_cast<Eigen::Index>(signal.size()));
  return signal;
}

}  // namespace contour::diagnosis
