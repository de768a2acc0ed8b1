#include "daemon/learning/program_learning.h"

#include <cmath>
#include <utility>

#include "core/reason.h"

namespace contour {
namespace {

/// A program that begins farther away than this is another one: screws and rails are not the same everywhere.
constexpr double kSamePlace_m = 10e-6;
constexpr double kMicro = 1e6;

bool SamePlace(const PerAxis<double>& a, const PerAxis<double>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!(std::abs(a[i] - b[i]) <= kSamePlace_m)) return false;
  return true;
}

}  // namespace

ProgramLearning::ProgramLearning(const MachineConfig& machine)
    : config_(machine.learning), period_s_(1e-6 * machine.machine.cycle_us) {
  for (const auto& [name, axis] : machine.axes) {
    mechanics_.push_back(ToSi(axis.model.mechanics));
    acceleration_m_s2_.push_back(1e-3 * axis.limits.acceleration_mm_s2);
  }
}

std::optional<LearningReport> ProgramLearning::Prepare(const std::function<std::string()>& text,
                                                       const PerAxis<double>& start_m,
                                                       std::uint32_t program_id, PathGenerator& generator) {
  if (!config_.enabled) return std::nullopt;
  std::optional<Pass> last;
  {
    const std::scoped_lock lock(mutex_);
    std::swap(last, pass_);
    if (known_forgets_ != forgets_) {
      known_forgets_ = forgets_;
      entries_.clear();
      last.reset();
    }
  }
  // Whoever hands the cycles over does not wait for this.
  const std::string refused = last && last->over ? LearnFrom(last->measured) : std::string();
  // Of a long program no more is planned than tells that it is long.
  if (generator.plan()->GoesOnAfter(config_.longest_s)) return std::nullopt;
  Entry& entry = Find(text(), start_m, generator);
  generator.Shift(entry.learnt.next());
  const auto points = static_cast<std::size_t>(generator.points());
  Pass next{program_id, MeasuredPass(mechanics_, points, period_s_), false};
  {
    const std::scoped_lock lock(mutex_);
    pass_ = std::move(next);
  }
  const LearntProgram& l = entry.learnt;
  return LearningReport{l.passes(), kMicro * l.last_peak_m(), kMicro * l.best_peak_m(), refused};
}

void ProgramLearning::Consume(const CycleRecord& record) {
  if (!config_.enabled) return;
  const std::scoped_lock lock(mutex_);
  if (record.state == MachineState::kFaulted) {
    pass_.reset();
    ++forgets_;
  }
  if (!pass_ || pass_->over || record.program_id != pass_->program_id) return;
  if (record.state == MachineState::kRunning) {
    pass_->measured.Add(record);
  } else if (record.state == MachineState::kReady && record.reason == Reason::kProgramEnd) {
    pass_->over = true;
  } else if (record.state == MachineState::kStopping) {
    pass_.reset();  // broken off
  }
}

void ProgramLearning::Forget() {
  const std::scoped_lock lock(mutex_);
  pass_.reset();
  ++forgets_;
}

// The program that ran last is the first of the entries.
std::string ProgramLearning::LearnFrom(const MeasuredPass& pass) {
  if (std::string problem = pass.Problem(); !problem.empty()) return problem;
  Entry& entry = entries_.front();
  const std::shared_ptr<const PathOffsets> followed = entry.learnt.next();
  return entry.learnt.Learn(FindErrorAcross(*entry.plan, pass, followed.get(), period_s_));
}

ProgramLearning::Entry& ProgramLearning::Find(const std::string& text, const PerAxis<double>& start_m,
                                              const PathGenerator& generator) {
  for (auto at = entries_.begin(); at != entries_.end(); ++at) {
    if (at->text != text) continue;
    if (SamePlace(at->start_m, start_m) && at->points == generator.points()) {
      entries_.splice(entries_.begin(), entries_, at);
      return entries_.front();
    }
    entries_.erase(at);
    break;
  }
  entries_.push_front({text, start_m, generator.points(), generator.plan(),
                       LearntProgram(config_, period_s_, acceleration_m_s2_)});
  while (entries_.size() > static_cast<std::size_t>(config_.programs)) entries_.pop_back();
  return entries_.front();
}

}  // namespace contour
