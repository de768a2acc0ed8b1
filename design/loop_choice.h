#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "config/loop_axis.h"
#include "config/machine_config.h"
#include "core/loop_tuning.h"

namespace contour {

/// A loop at once for an axis that has none: solutions of the search on other axes, which are in units of the
/// axis's own mode, masses and period, and softer forms of them. The one with the least error under a force
/// step of those that keep every limit; none when none does. The search finds a better one.
std::optional<LoopTuning> ChooseLoop(const LoopAxis& axis, double period_s);

/// That there is none, and what would help (WhatWouldHelp, or who tries it).
std::string WhyNoLoop(const std::string& name, const std::vector<std::string>& help);

/// `axes.<name>.<key>={...}`, with three digits, to put on top of a machine file.
std::string LoopAssignment(const std::string& name, LoopTuning tuning, const std::string& key = "loop");

/// What to put on top of a machine file for kSrukf.
inline constexpr const char* kUseFilter = "control.friction=srukf";

/// Whether that is a way out where an axis has no loop: the file does not say what friction is known by, and
/// kSrukf serves.
bool MayUseFilter(const MachineConfig& machine);

/// A loop for every axis that needs one and has none, as assignments `axes.<name>.loop={...}` to put on top
/// of the machine file. When there is none for an axis, kUseFilter alone if that is a way out; or else throws
/// ConfigError, with `file`, where the machine stands, and the reason. What would help is not tried: a start
/// waits for this. `begins`: called before each axis, which takes some tenths of a second of one processor.
std::vector<std::string> LoopsThatAreMissing(const MachineConfig& machine, const std::string& file,
                                             const std::function<void()>& begins = nullptr);

}  // namespace contour
