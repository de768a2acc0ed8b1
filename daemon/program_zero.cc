#include "daemon/program_zero.h"

#include <utility>

namespace contour {
namespace {

PerAxis<double> PlaceOf(const CycleRecord& now) {
  PerAxis<double> place_m;
  for (const AxisRecord& a : now.axes) place_m.push_back(a.reference.position_m);
  return place_m;
}

}  // namespace

void ProgramZero::Set(const CycleRecord& now) {
  const std::lock_guard lock(mutex_);
  zero_m_ = PlaceOf(now);
  references_.clear();
  for (const AxisRecord& a : now.axes) references_.push_back(a.reference_state);
  lost_.clear();
}

void ProgramZero::Lose(std::string why) {
  const std::lock_guard lock(mutex_);
  if (!zero_m_) return;
  zero_m_.reset();
  lost_ = std::move(why);
}

// An axis that has lost its count, or was told where it is, has other coordinates than it had.
std::string ProgramZero::Lost(const CycleRecord& now) const {
  for (std::size_t i = 0; i < now.axes.size() && i < references_.size(); ++i)
    if (now.axes[i].reference_state != references_[i]) return "an axis does not know its place as it did";
  return {};
}

ProgramZero::Found ProgramZero::ForProgram(const CycleRecord& now, bool here) {
  const PerAxis<double> start_m = PlaceOf(now);
  if (here) return {Placement::Here(start_m), false, {}};
  {
    const std::lock_guard lock(mutex_);
    if (zero_m_)
      if (std::string why = Lost(now); !why.empty()) {
        zero_m_.reset();
        lost_ = std::move(why);
      }
    if (zero_m_) return {Placement{start_m, *zero_m_}, false, {}};
    if (!lost_.empty())
      return {std::nullopt, false,
              "program zero is lost: " + lost_ +
                  ". Set it anew (contour zero), or run from where the machine stands (--from-here)"};
  }
  return {Placement::Here(start_m), true, {}};
}

std::optional<PerAxis<double>> ProgramZero::zero_m() const {
  const std::lock_guard lock(mutex_);
  return zero_m_;
}

}  // namespace contour
