#include "tools/simulate/controller_trial.h"

#include <algorithm>
#include <array>
#include <vector>

#include "config/number_text.h"
#include "daemon/program/program.h"
#include "daemon/reason_text.h"
#include "tools/machine/stated_machine.h"
#include "tools/simulate/virtual_machine.h"

namespace contour {
namespace {

// As long as the supervisor needs to notice a swing, to soften it, and to see whether that helped.
constexpr double kRests_s = 2.0;
constexpr double kLongest_s = 20.0;
// In turns of the motor, by which its ripples come and friction's speeds go. A slow axis does not go all of
// it, but for so long.
constexpr double kStroke_turns = 2.0, kGoes_s = 2.0;
constexpr double kSpeed_turns_s = 4.0;

struct Member {
  const char* name;
  OffStated off;
};

/// What is not known: one standard deviation.
constexpr std::array<Member, 5> kMembers{
    {{"as stated", {}},
     {"with its inertias larger by what is not known of them", {.inertia = 1.0}},
     {"with its inertias smaller by what is not known of them", {.inertia = -1.0}},
     {"with its screws stiffer by what is not known of them", {.stiffness = 1.0}},
     {"with its screws softer by what is not known of them", {.stiffness = -1.0}}}};

Program Stroke(const std::string& name, const AxisConfig& axis) {
  const double room_mm = 0.25 * (axis.limits.position_mm[1] - axis.limits.position_mm[0]);
  const double lead_mm = axis.model.mechanics.lead_mm;
  const double speed_mm_s = std::min(kSpeed_turns_s * lead_mm, 0.5 * axis.limits.velocity_mm_s);
  const double stroke_mm = std::min({kStroke_turns * lead_mm, room_mm, kGoes_s * speed_mm_s});
  return ParseProgram("{shape: creep, axis: " + name + ", stroke_mm: " + RoundedText(stroke_mm) +
                          ", velocities_mm_s: [" + RoundedText(speed_mm_s) + "]}",
                      "a stroke", ProgramFormat::kYaml);
}

class Trial {
 public:
  Trial(const MachineConfig& machine, const OffStated& off)
      : config_(machine),
        machine_({machine, StatedMachine(machine, off)}, machine.machine.controller),
        bus_names_(BusNames(machine)) {}

  ControllerTrial Run() {
    machine_.BringUp();
    machine_.mailbox().Post(RequestKind::kEnable);
    where_ = "when it is enabled: ";
    if (!Goes(kRests_s)) return found_;
    for (const auto& [name, axis] : config_.axes) {
      machine_.Start(Stroke(name, axis));
      where_ = "in a slow stroke of axis " + name + ": ";
      if (!Goes(kLongest_s, true)) return found_;
      if (machine_.record().reason != Reason::kProgramEnd) break;  // held so far; no other stroke begins
    }
    return found_;
  }

 private:
  /// Until the time is over, or a program has ended.
  bool Goes(double most_s, bool program = false) {
    const auto cycles = static_cast<int>(1e6 * most_s / config_.machine.cycle_us);
    for (int i = 0; i < cycles && found_.lost.empty(); ++i) {
      machine_.Tick();
      Look();
      if (program && machine_.record().reason == Reason::kProgramEnd) break;
    }
    return found_.lost.empty();
  }

  void Look() {
    const CycleRecord& r = machine_.record();
    const bool stopped = r.reason != Reason::kNone && r.reason != Reason::kProgramEnd;
    if (r.state == MachineState::kFaulted || stopped) {
      found_.lost = where_ + ReasonText(r, machine_.axis_names(), bus_names_);
      return;
    }
    // All axes are softened together; the one that is why was noticed before.
    for (std::size_t i = 0; i < r.axes.size(); ++i) {
      const Reason limit = r.axes[i].limit;
      if (limit == Reason::kOscillationNoticed || limit == Reason::kInnovationGated)
        noticed_ = ", after " + std::string(Name(limit)) + " of axis " + machine_.axis_names()[i];
      if ((limit == Reason::kSoftened || limit == Reason::kFallenBack) && found_.softened.empty())
        found_.softened = where_ + "the supervision of its loops softens them" + noticed_;
    }
  }

  MachineConfig config_;
  VirtualMachine machine_;
  std::vector<std::string> bus_names_;
  ControllerTrial found_;
  std::string where_, noticed_;
};

/// What the trial is not about.
MachineConfig Referenced(MachineConfig machine) {
  for (auto& [name, axis] : machine.axes) axis.drive.absolute_encoder = true;
  machine.io.modbus.reset();
  machine.learning.enabled = false;
  return machine;
}

}  // namespace

ControllerTrial TryController(const MachineConfig& stated) {
  const MachineConfig machine = Referenced(stated);
  ControllerTrial found;
  for (const Member& member : kMembers) {
    const ControllerTrial of = Trial(machine, member.off).Run();
    const std::string name = std::string("the machine ") + member.name;
    if (found.softened.empty() && !of.softened.empty()) found.softened = name + " " + of.softened;
    if (of.lost.empty()) continue;
    found.lost = name + " is lost " + of.lost;
    break;
  }
  return found;
}

}  // namespace contour
