#include "analysis/rough_fit/unlike_directions.h"

#include <algorithm>
#include <cmath>

namespace contour::diagnosis {
namespace {

/// [deviations; share of the level] From where two directions are not alike.
constexpr double kSure = 4.0, kUnlike_rel = 0.1;

void TakeLevel(double level, double& Fc, double& Fs) {
  Fs *= level / Fc;
  Fc = level;
}

}  // namespace

std::optional<UnlikeDirections> FindUnlikeDirections(const RoughFit& rough, const StatedAxis& stated) {
  const StatedFriction& f = stated.friction;
  if (rough.one_direction || !(rough.coulomb > 0.0) || !(f.Fc_plus > 0.0) || !(f.Fc_minus > 0.0)) return {};
  // A force towards positive places helps forth and hinders back.
  const double level = 0.5 * (rough.coulomb_forth + rough.coulomb_back);
  const double as_stated = level * (f.Fc_plus - f.Fc_minus) / (f.Fc_plus + f.Fc_minus);
  const double force = as_stated - 0.5 * (rough.coulomb_forth - rough.coulomb_back);
  const double beyond = std::abs(force - stated.offset);
  if (2.0 * beyond < std::max(kSure * rough.coulomb_sigma, kUnlike_rel * rough.coulomb)) return {};
  UnlikeDirections out{stated, {}, rough.coulomb_forth, rough.coulomb_back, beyond / rough.coulomb};
  out.pulled.offset = force;
  out.pulled.sigma["offset"] = std::max(1.0, rough.coulomb / std::abs(force));
  const double forth = rough.coulomb_forth + stated.offset, back = rough.coulomb_back - stated.offset;
  if (!(forth > 0.0) || !(back > 0.0)) return out;
  StatedFriction& u = out.uneven.emplace(stated).friction;
  TakeLevel(forth, u.Fc_plus, u.Fs_plus);
  TakeLevel(back, u.Fc_minus, u.Fs_minus);
  return out;
}

}  // namespace contour::diagnosis
