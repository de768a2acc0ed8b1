#include "daemon/memory/friction_memory.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "config/number_text.h"

namespace contour {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds kWritePeriod{60};

fs::path Variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? fs::path() : fs::path(value);
}

std::string List(const std::vector<double>& values) {
  std::string text;
  for (const double v : values) text += (text.empty() ? "" : ", ") + NumberText(v);
  return "[" + text + "]";
}

}  // namespace

fs::path MemoryDirectory(const MemoryConfig& config) {
  if (!config.directory.empty()) return config.directory;
  if (const fs::path service = Variable("STATE_DIRECTORY"); !service.empty()) return service;
  if (const fs::path user = Variable("XDG_STATE_HOME"); !user.empty()) return user / "contourd";
  if (const fs::path home = Variable("HOME"); !home.empty()) return home / ".local/state/contourd";
  return {};
}

FrictionMemory::FrictionMemory(const MachineConfig& machine, fs::path directory)
    : directory_(std::move(directory)) {
  if (!machine.memory.friction_map || machine.machine.controller != ControllerName::kFull ||
      directory_.empty())
    return;
  std::size_t index = 0;
  for (const auto& [name, axis] : machine.axes) {
    const std::size_t here = index++;
    if (!axis.drive.absolute_encoder || axis.model.extensions.position_friction) continue;
    MappedAxis mapped{machine.machine.name,
                      name,
                      {1e-3 * axis.limits.position_mm[0], 1e-3 * axis.limits.position_mm[1],
                       1e-3 * axis.model.mechanics.lead_mm},
                      static_cast<double>(axis.drive.encoder_counts_per_rev)};
    StrokeFriction friction(mapped.stroke);
    bool in_use = false;
    const fs::path file = StrokeFrictionFile(directory_, mapped);
    std::error_code unknown;
    if (fs::exists(file, unknown)) {
      StrokeFrictionRead read = ReadStrokeFriction(file, mapped);
      in_use = read.refused.empty();
      if (in_use) {
        friction = StrokeFriction(mapped.stroke, std::move(read.steps));
        used_.push_back("axis " + name + ": friction along the stroke from " + file.string());
      } else {
        refused_.push_back("axis " + name + ": " + file.string() + " is not used: " + read.refused);
      }
    }
    const double viscous_Ns_m =
        ToSi(axis.model.friction, ScrewRadius_m_rad(axis.model.mechanics.lead_mm)).sigma2_Ns_m;
    axes_.push_back({here, std::move(mapped), std::move(friction), viscous_Ns_m, 0, in_use});
  }
}

FrictionMemory::~FrictionMemory() { Finish(); }

std::vector<std::string> FrictionMemory::Overrides() const {
  std::vector<std::string> out;
  for (const Axis& axis : axes_) {
    if (!axis.in_use) continue;
    std::vector<double> position_mm;
    for (std::size_t i = 0; i < axis.friction.pieces(); ++i)
      position_mm.push_back(1e3 * axis.friction.Centre_m(i));
    out.push_back("axes." + axis.mapped.axis + ".model.extensions.position_friction={position_mm: " +
                  List(position_mm) + ", friction_rel: " + List(axis.friction.Relative()) + "}");
  }
  return out;
}

void FrictionMemory::Consume(const CycleRecord& record) {
  const std::scoped_lock lock(mutex_);
  for (Axis& axis : axes_) {
    if (axis.index >= record.axes.size()) continue;
    const AxisRecord& r = record.axes[axis.index];
    const double velocity_m_s = r.reference.velocity_m_s;
    const bool sound = r.feedback.fresh && !r.estimate.diverged && r.estimate.limit == Reason::kNone;
    const double along_N = std::copysign(r.estimate.friction_N, r.estimate.friction_N * velocity_m_s);
    axis.friction.Add({r.position_m, velocity_m_s, along_N - axis.viscous_Ns_m * std::abs(velocity_m_s),
                       record.state == MachineState::kRunning && sound});
  }
}

void FrictionMemory::Start() {
  if (!axes_.empty()) thread_ = std::thread(&FrictionMemory::Work, this);
}

void FrictionMemory::Finish() {
  {
    const std::scoped_lock lock(mutex_);
    finish_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void FrictionMemory::Work() {
  bool finish = false;
  while (!finish) {
    {
      std::unique_lock lock(mutex_);
      finish = wake_.wait_for(lock, kWritePeriod, [this] { return finish_; });
    }
    Write();
  }
}

void FrictionMemory::Write() {
  for (Axis& axis : axes_) {
    std::vector<StrokeFriction::Step> steps;
    std::size_t passes = 0;
    {
      const std::scoped_lock lock(mutex_);
      passes = axis.friction.passes();
      if (passes == axis.written_passes) continue;
      steps = axis.friction.steps();
    }
    try {
      WriteStrokeFriction(StrokeFrictionFile(directory_, axis.mapped), axis.mapped, steps);
      axis.written_passes = passes;  // what failed is tried again the next time
      complained_.clear();
    } catch (const std::exception& e) {
      if (complained_ != e.what()) spdlog::warn("friction along the stroke is not kept: {}", e.what());
      complained_ = e.what();
    }
  }
}

}  // namespace contour
