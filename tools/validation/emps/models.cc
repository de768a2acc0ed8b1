#include "tools/validation/emps/models.h"

#include <utility>

namespace contour::emps {
namespace {

std::vector<Free> With(std::vector<Free> terms, std::initializer_list<Free> more) {
  terms.insert(terms.end(), more);
  return terms;
}

}  // namespace

Parameters AuthorsSymmetric() {
  Parameters p;
  p.mass_kg = 95.1089;
  p.Fv_plus_Ns_m = p.Fv_minus_Ns_m = 203.5034;
  p.Fc_plus_N = p.Fc_minus_N = 20.3935;
  p.offset_N = 3.1648;  // the authors write it on the other side of the equation
  return p;
}

Parameters AuthorsAsymmetric() {
  Parameters p;
  p.mass_kg = 95.154;
  p.Fv_plus_Ns_m = 166.7061;
  p.Fc_plus_N = 20.144;
  p.Fv_minus_Ns_m = 240.4236;
  p.Fc_minus_N = 20.6277;
  return p;
}

std::vector<Free> DirectionTerms() {
  return {{&Parameters::mass_kg, 95.0},
          {&Parameters::Fv_plus_Ns_m, 200.0},
          {&Parameters::Fv_minus_Ns_m, 200.0},
          {&Parameters::Fc_plus_N, 20.0},
          {&Parameters::Fc_minus_N, 20.0}};
}

std::vector<Free> StrokeTerms() {
  return With(DirectionTerms(), {{&Parameters::x1, 0.1}, {&Parameters::x2, 0.1}});
}

std::vector<Free> StribeckTerms() {
  return With(StrokeTerms(), {{&Parameters::dFs_plus_N, 3.0}, {&Parameters::dFs_minus_N, 3.0}});
}

ScoredModel Score(std::string name, const Parameters& p, const Recording& train, const Recording& pulses) {
  return {std::move(name), p, FreeRunRmse_m(p, train, kFirstHalf), FreeRunRmse_m(p, train, kSecondHalf),
          FreeRunRmse_m(p, pulses, kWhole)};
}

}  // namespace contour::emps
