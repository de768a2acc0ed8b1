#include "analysis/prediction_error/signal_cache.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace contour::diagnosis {
namespace {

constexpr std::size_t kMostKept = 12;

}  // namespace

std::uint64_t SignalCache::NewOwner() {
  const std::scoped_lock lock(mutex_);
  return ++owners_;
}

SignalCache::Signals SignalCache::For(std::uint64_t owner, double number,
                                      const std::function<Signals()>& make) {
  const std::scoped_lock lock(mutex_);
  const auto known = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const Entry& e) { return e.owner == owner && e.number == number; });
  if (known != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, known);
  } else {
    if (entries_.size() >= kMostKept) entries_.pop_back();
    entries_.push_front({owner, number, make()});
  }
  return entries_.front().signals;
}

}  // namespace contour::diagnosis
