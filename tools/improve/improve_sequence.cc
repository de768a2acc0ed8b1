#include "tools/improve/improve_sequence.h"

#include <algorithm>
#include <utility>

#include "analysis/axis_model/read_stated_axis.h"
#include "analysis/diagnosis/causes/extensions_of.h"
#include "analysis/diagnosis/report/diagnosis_text.h"
#include "analysis/recording/read_log.h"
#include "analysis/text/format_text.h"
#include "config/config_error.h"
#include "config/yaml_writer.h"
#include "tools/improve/experiments.h"
#include "tools/improve/fitted_model.h"

namespace contour::improve {
namespace {

constexpr const char* kWithChirp = "path and chirp";
constexpr std::size_t kDiagnosedPasses = 2;
/// As commissioning has it.
constexpr double kMostLost = 0.01;
constexpr int kAttempts = 4;

PerAxis<double> Middle(const WorkingSpace& space) {
  PerAxis<double> out;
  for (const AxisSpace& s : space.axes) out.push_back(0.5 * (s.low_m + s.high_m));
  return out;
}

std::string TextOf(const ModelConfig& model) {
  ModelConfig copy = model;
  return WriteYaml(copy);
}

/// Kept before not kept, then by what is left of the error on the program that nothing was fitted on.
bool Better(const Trial& a, const Trial& b) {
  if (a.judgement.keep != b.judgement.keep) return a.judgement.keep;
  return a.check.after_um < b.check.after_um;
}

/// Both programs, every pass.
double SeriesOf_s(const ImproveRequest& request) {
  return static_cast<double>(request.passes + 1) * (request.path.duration_s + request.check.duration_s);
}

}  // namespace

ImproveSequence::ImproveSequence(ImproveMachine& machine, ImproveRequest request, DiagnoseAxis diagnose)
    : machine_(machine), request_(std::move(request)), diagnose_(std::move(diagnose)) {}

ImproveResult ImproveSequence::Run() {
  try {
    RunSteps();
  } catch (const std::exception& e) {
    try {
      if (enabled_) machine_.Disable();
      enabled_ = false;
      if (loaded_) RestoreOnceIdle();
    } catch (const std::exception& also) {
      throw std::runtime_error(std::string(e.what()) + "; and the old model is not back: " + also.what() +
                               ". contour status says with which model contourd runs; started anew, it runs "
                               "with the machine file's");
    }
    throw;
  }
  return std::move(result_);
}

void ImproveSequence::RunSteps() {
  result_.machine = machine_.Machine();
  RefuseTooLittleTime();
  machine_.Ask("The axes will be enabled and will move: " + request_.path.program.name + ", and " +
               request_.check.program.name + ".");
  std::optional<Series> before = DrawAll("before");
  if (!before)
    throw std::runtime_error(
        "cycles never arrived, and --max_minutes leaves no time to draw that once more: this computer is "
        "too slow or too busy");
  result_.before = *std::move(before);
  series_s_ = result_.machine_time_s;
  Find();
  machine_.Disable();
  enabled_ = false;
  const std::vector<Candidate> candidates = Candidates();
  if (candidates.empty()) {
    result_.judgement = {false, "nothing was found that changes the model"};
    return;
  }
  TakeYardstick();
  TryAll(candidates);
  KeepBest();
}

void ImproveSequence::RefuseTooLittleTime() const {
  const double both_s = 2.0 * SeriesOf_s(request_);
  if (both_s <= request_.machine_time_s) return;
  throw ConfigError(
      {FormatText("--max_minutes: found %.3g, but drawing both programs before and after takes %.3g minutes; "
                  "expected more, or fewer --passes, or shorter programs",
                  request_.machine_time_s / 60.0, both_s / 60.0)});
}

/// The ways to its start, and the program.
std::vector<Placed> ImproveSequence::WithWay(const Placed& program) {
  const PerAxis<double> here_m = machine_.Position_m();
  std::vector<Placed> all;
  for (const ProgramText& way : WayTo(here_m, program.start_m, request_.space))
    all.push_back(Place(way, request_.space, request_.limits, here_m));
  all.push_back(program);
  return all;
}

/// A record with holes says less of the axis, and not how large the largest error was: then once more.
std::optional<Drawing> ImproveSequence::Draw(const Placed& program, double reserved_s) {
  for (int attempt = 1;; ++attempt) {
    const std::vector<Placed> all = WithWay(program);
    double takes_s = 0.0;
    for (const Placed& p : all) takes_s += p.duration_s;
    if (attempt > 1 && takes_s > Left_s(reserved_s)) return std::nullopt;
    result_.machine_time_s += takes_s;
    for (std::size_t i = 0; i + 1 < all.size(); ++i) machine_.Run(all[i].program);
    Drawing drawing = machine_.Run(program.program);
    const double lost = static_cast<double>(drawing.lost);
    if (lost <= kMostLost * static_cast<double>(drawing.cycles.size())) return drawing;
    if (attempt == kAttempts)
      throw std::runtime_error(
          FormatText("%s: %.0f of its cycles never arrived: this computer is too slow or too busy",
                     program.program.name.c_str(), lost));
    machine_.Say(FormatText("%s: %.0f of its cycles never arrived", program.program.name.c_str(), lost));
  }
}

std::optional<Series> ImproveSequence::DrawAll(const std::string& when) {
  machine_.Enable();
  enabled_ = true;
  Series series;
  // What is drawn later has to fit, too: the rest of this series, and before there is a model, another one.
  double later_s = SeriesOf_s(request_) + (loaded_ ? 0.0 : SeriesOf_s(request_));
  const auto draw = [&](const Placed& program, std::vector<Drawing>& drawings) {
    later_s -= program.duration_s;
    std::optional<Drawing> drawing = Draw(program, later_s);
    if (drawing) drawings.push_back(*std::move(drawing));
    return drawing.has_value();
  };
  for (std::size_t pass = 0; pass <= request_.passes; ++pass) {
    if (!draw(request_.path, series.path) || !draw(request_.check, series.check)) return std::nullopt;
    const auto peak_um = [&](const Drawing& d, const Placed& p) {
      return ErrorsOf(d, p.program, request_.limits, result_.machine, nullptr).encoder.peak_um;
    };
    machine_.Say(FormatText("%s, pass %zu of %zu%s: largest error at the encoder %.3g um, %.3g um",
                            when.c_str(), pass + 1, request_.passes + 1, pass == 0 ? " (settling)" : "",
                            peak_um(series.path.back(), request_.path),
                            peak_um(series.check.back(), request_.check)));
  }
  return series;
}

void ImproveSequence::Find() {
  // Of passes that are alike two say what there is to say.
  for (std::size_t i = 0; i < kDiagnosedPasses; ++i) logs_.push_back(result_.before.path[i].log);
  Diagnose(request_.path.program.name);
  Experiment(request_.shaking, "No path shows the stiffness of the screw", kWithChirp);
  if (result_.diagnosed.back().open.empty()) return;
  // First what decides between the causes that are left, then what every axis needs.
  const std::vector<ProgramText> deciding = DecidingPrograms(result_.diagnosed.back().found, run_);
  if (!deciding.empty())
    Experiment(deciding, "Left open: " + result_.diagnosed.back().open, "path, chirp and what decides");
  if (result_.diagnosed.back().open.empty()) return;
  Experiment(NotYetRun(request_.experiments, run_), "Left open: " + result_.diagnosed.back().open,
             "path and experiments");
}

void ImproveSequence::Experiment(const std::vector<ProgramText>& programs, const std::string& why,
                                 const std::string& on) {
  const std::vector<Placed> runnable = Runnable(programs, request_.space, request_.limits,
                                                Middle(request_.space), Left_s(series_s_), result_.left_out);
  run_.insert(run_.end(), programs.begin(), programs.end());
  if (runnable.empty()) return;
  double all_s = 0.0;
  for (const Placed& p : runnable) all_s += p.duration_s;
  machine_.Ask(
      FormatText("%s: %zu experiments of %.0f s would decide.", why.c_str(), runnable.size(), all_s));
  const std::size_t before = logs_.size();
  for (const Placed& p : runnable) {
    double takes_s = 0.0;
    for (const Placed& part : WithWay(p)) takes_s += part.duration_s;
    if (takes_s > Left_s(series_s_)) {
      result_.left_out.push_back(FormatText("%s: takes %.0f s with the way there, and %.0f s are left",
                                            p.program.name.c_str(), takes_s, Left_s(series_s_)));
      continue;
    }
    machine_.Say("experiment: " + p.program.name);
    std::optional<Drawing> drawing = Draw(p, series_s_);
    if (!drawing) {
      result_.left_out.push_back(p.program.name +
                                 ": cycles never arrived, and there is no time to run it once more");
      continue;
    }
    logs_.push_back(std::move(drawing->log));
    result_.experiments.push_back(p.program.name);
  }
  if (logs_.size() > before) Diagnose(on);
}

void ImproveSequence::Diagnose(const std::string& on) {
  const diagnosis::AxisLog log = diagnosis::JoinLogs(logs_);
  Diagnosed& d = result_.diagnosed.emplace_back();
  d.on = on;
  d.seconds = static_cast<double>(log.rows) * log.period_s;
  d.found = diagnose_(log, diagnosis::ToStatedAxis(result_.machine, request_.axis));
  d.open = WhatIsOpen(d.found);
  machine_.Say(FormatText("diagnosis of %.0f s, %s: ", d.seconds, on.c_str()) +
               diagnosis::VerdictText(d.found));
}

/// Of every diagnosis, the one of most records first: what experiments add may be what no cause describes,
/// and then the path alone says more of the path.
std::vector<Candidate> ImproveSequence::Candidates() const {
  const ModelConfig& old = result_.machine.axes.at(request_.axis).model;
  const diagnosis::StatedAxis stated = diagnosis::ToStatedAxis(result_.machine, request_.axis);
  const double first_degC = diagnosis::TemperatureOf(logs_.front()).first_degC;
  std::vector<Candidate> out;
  for (auto d = result_.diagnosed.rbegin(); d != result_.diagnosed.rend(); ++d)
    for (ModelConfig& model : FittedModels(old, stated, d->found, first_degC)) {
      const bool known = std::any_of(out.begin(), out.end(),
                                     [&](const Candidate& c) { return TextOf(c.model) == TextOf(model); });
      if (!known) out.push_back({d->on, d->open.empty(), std::move(model)});
    }
  return out;
}

/// The screw is what the chirp shows by one-step errors. A candidate judged by its own screw would see the
/// error that it makes itself as one that was there before.
void ImproveSequence::TakeYardstick() {
  const ModelConfig& old = result_.machine.axes.at(request_.axis).model;
  const diagnosis::StatedAxis stated = diagnosis::ToStatedAxis(result_.machine, request_.axis);
  const double first_degC = diagnosis::TemperatureOf(logs_.front()).first_degC;
  result_.yardstick = old;
  for (const Diagnosed& d : result_.diagnosed) {
    const std::vector<ModelConfig> models = FittedModels(old, stated, d.found, first_degC);
    if (!models.empty()) result_.yardstick = models.back();
    if (d.on == kWithChirp) return;
  }
}

/// Until one whose diagnosis leaves nothing open draws better, or the time is over.
void ImproveSequence::TryAll(const std::vector<Candidate>& candidates) {
  for (const Candidate& c : candidates) {
    if (result_.machine_time_s + series_s_ > request_.machine_time_s) {
      result_.left_out.push_back("the model by " + c.from + ": there is no time to draw with it");
      continue;
    }
    try {
      Load(c.model, "; then the axes will be enabled and will draw both programs again.");
    } catch (const ModelRefused& e) {
      result_.left_out.push_back("the model by " + c.from + ": " + e.what());
      continue;
    }
    std::optional<Series> drawn = DrawAll("with the model by " + c.from);
    machine_.Disable();
    enabled_ = false;
    if (!drawn) {
      result_.left_out.push_back("the model by " + c.from +
                                 ": cycles never arrived, and there is no time to draw once more");
      continue;
    }
    result_.tried.push_back(Judged(c, *std::move(drawn), candidates.size()));
    const Judgement& judgement = result_.tried.back().judgement;
    machine_.Say((judgement.keep ? "better: " : "not better: ") + judgement.why);
    if (judgement.keep && c.decided) return;
  }
}

void ImproveSequence::Load(const ModelConfig& model, const std::string& then) {
  machine_.Ask("contourd will begin anew with the new model of axis " + request_.axis + then);
  const bool before = std::exchange(loaded_, true);
  try {
    machine_.LoadModel(TextOf(model));
    newest_ = TextOf(model);
  } catch (const NotIdle& e) {
    loaded_ = before;
    throw std::runtime_error(e.what());
  } catch (const ModelRefused&) {
    loaded_ = before;
    throw;
  }
}

Trial ImproveSequence::Judged(const Candidate& candidate, Series drawn, std::size_t candidates) const {
  MachineConfig yardstick = result_.machine;
  yardstick.axes.at(request_.axis).model = *result_.yardstick;
  double resolution_um = 0.0;
  for (const auto& [name, axis] : yardstick.axes)
    resolution_um =
        std::max(resolution_um, 1e3 * axis.model.mechanics.lead_mm / axis.drive.encoder_counts_per_rev);
  const auto compare = [&](const std::vector<Drawing>& before, const std::vector<Drawing>& after,
                           const Placed& program) {
    return Compare({Peaks_um(before, request_, program.program, yardstick),
                    Peaks_um(after, request_, program.program, yardstick)},
                   resolution_um, candidates);
  };
  Trial t{candidate.from, candidate.model, std::move(drawn), {}, {}, {}};
  t.path = compare(result_.before.path, t.drawn.path, request_.path);
  t.check = compare(result_.before.check, t.drawn.check, request_.check);
  t.judgement = Judge(t.path, t.check);
  return t;
}

/// The model that is loaded in the end is the best of those that are kept, or the old one.
void ImproveSequence::KeepBest() {
  for (std::size_t i = 0; i < result_.tried.size(); ++i)
    if (!result_.best || Better(result_.tried[i], result_.tried[*result_.best])) result_.best = i;
  if (!result_.best) {
    result_.judgement = {false, result_.left_out.empty() ? "there was no time to draw with another model"
                                                         : result_.left_out.back()};
    if (loaded_) Restore();
    return;
  }
  const Trial& best = result_.tried[*result_.best];
  result_.judgement = best.judgement;
  if (!best.judgement.keep)
    Restore();
  else if (TextOf(best.model) != newest_)
    Load(best.model, ", the best of those that were drawn with.");
}

/// The machine file's own model, or what had been loaded in its place before.
void ImproveSequence::Restore() {
  const std::string old = TextOf(result_.machine.axes.at(request_.axis).model);
  machine_.LoadModel("");
  if (TextOf(machine_.Machine().axes.at(request_.axis).model) != old) machine_.LoadModel(old);
  loaded_ = false;
  machine_.Say("the old model is loaded again");
}

/// contourd takes a model in Idle alone, and after a fault that is where an operator's reset leads.
void ImproveSequence::RestoreOnceIdle() {
  const std::string what_for = "the old model is loaded again then";
  machine_.AwaitIdle(what_for);
  for (;;) {
    try {
      return Restore();
    } catch (const ModelRefused&) {
      if (!machine_.AwaitIdle(what_for)) throw;
    }
  }
}

std::vector<double> Peaks_um(const std::vector<Drawing>& drawings, const ImproveRequest& request,
                             const ProgramText& program, const MachineConfig& yardstick) {
  std::vector<double> out;
  for (std::size_t i = 1; i < drawings.size(); ++i) {
    const PathErrors e = ErrorsOf(drawings[i], program, request.limits, yardstick, nullptr);
    out.push_back((e.scale ? *e.scale : e.believed).peak_um);
  }
  return out;
}

}  // namespace contour::improve
