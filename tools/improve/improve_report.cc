#include "tools/improve/improve_report.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/diagnosis/report/diagnosis_json.h"
#include "analysis/text/format_text.h"
#include "config/extended_model.h"
#include "config/number_text.h"

namespace contour::improve {
namespace {

using nlohmann::json;

std::optional<TruthTable> Load(const std::filesystem::path& file, const std::vector<std::string>& axes) {
  if (file.empty()) return {};
  return TruthTable::Load(file, axes);
}

/// One list for each place and kind of error, a number for each pass; the first pass is the settling one.
json ErrorsJson(const std::vector<Drawing>& drawings, const ImproveRequest& request,
                const ProgramText& program, const MachineConfig& yardstick, const TruthTable* truth) {
  json out;
  const auto add = [&](const char* place, const std::optional<PathError>& e) {
    out[place]["peak_um"].push_back(e ? json(e->peak_um) : json());
    out[place]["rms_um"].push_back(e ? json(e->rms_um) : json());
  };
  for (const Drawing& d : drawings) {
    const PathErrors e = ErrorsOf(d, program, request.limits, yardstick, truth);
    add("encoder", e.encoder);
    add("believed_table", e.believed);
    add("scale", e.scale);
    if (truth != nullptr) add("truth", e.truth);
  }
  return out;
}

json SeriesJson(const Series& series, const ImproveRequest& request, const MachineConfig& yardstick,
                const std::optional<TruthTable>& truth) {
  const TruthTable* table = truth ? &*truth : nullptr;
  return {{"path", ErrorsJson(series.path, request, request.path.program, yardstick, table)},
          {"check", ErrorsJson(series.check, request, request.check.program, yardstick, table)}};
}

json ComparisonJson(const Comparison& c) {
  return {{"before_um", c.before_um}, {"after_um", c.after_um}, {"repeatability_um", c.repeatability_um}};
}

json TrialJson(const Trial& t) {
  return {{"from", t.from},
          {"path", ComparisonJson(t.path)},
          {"check", ComparisonJson(t.check)},
          {"better", t.judgement.keep},
          {"why", t.judgement.why}};
}

MachineConfig Yardstick(const ImproveResult& result, const ImproveRequest& request) {
  MachineConfig machine = result.machine;
  if (result.yardstick) machine.axes.at(request.axis).model = *result.yardstick;
  return machine;
}

bool HasScale(const ImproveResult& result, const ImproveRequest& request) {
  return result.machine.axes.at(request.axis).drive.linear_scale.has_value();
}

std::string Line(const char* what, const Comparison& c) {
  return FormatText("  %-34s %10.3f %10.3f %8.0f %%   %.3f\n", what, c.before_um, c.after_um,
                    100.0 * (c.after_um / c.before_um - 1.0), c.repeatability_um);
}

/// The screw's stiffness moves the table and hardly the motor.
bool StiffnessChanged(const ImproveResult& result, const ImproveRequest& request) {
  constexpr double kChanged = 0.1;  ///< less is what commissioning leaves open
  if (result.chosen() == nullptr) return false;
  const double was = Extended(result.machine.axes.at(request.axis).model).mechanics.screw_stiffness_N_um;
  const double is = Extended(result.chosen()->model).mechanics.screw_stiffness_N_um;
  return std::abs(is / was - 1.0) > kChanged;
}

}  // namespace

std::string ImproveJson(const ImproveResult& result, const ImproveRequest& request, const TruthFiles& truth) {
  const MachineConfig yardstick = Yardstick(result, request);
  json out;
  out["axis"] = request.axis;
  out["path"] = request.path.program.name;
  out["check"] = request.check.program.name;
  out["machine_time_s"] = result.machine_time_s;
  out["experiments"] = result.experiments;
  out["left_out"] = result.left_out;
  for (const Diagnosed& d : result.diagnosed) {
    json entry{{"on", d.on}, {"seconds", d.seconds}, {"open", d.open}};
    entry["diagnosis"] = json::parse(diagnosis::DiagnosisJson(d.found, ""));
    out["diagnosed"].push_back(entry);
  }
  out["before"] = SeriesJson(result.before, request, yardstick, Load(truth.before, request.space.names));
  out["compared_at"] = HasScale(result, request) ? "scale" : "believed_table";
  out["tried"] = json::array();
  for (const Trial& t : result.tried) out["tried"].push_back(TrialJson(t));
  if (const Trial* best = result.chosen()) {
    out["after"] = SeriesJson(best->drawn, request, yardstick, Load(truth.after, request.space.names));
    out["compared"] = {{"path", ComparisonJson(best->path)}, {"check", ComparisonJson(best->check)}};
  }
  out["kept"] = result.judgement.keep;
  out["why"] = result.judgement.why;
  return out.dump(2) + "\n";
}

std::string ImproveText(const ImproveResult& result, const ImproveRequest& request) {
  std::string text;
  if (!result.tried.empty())
    text +=
        FormatText("largest error, um, mean of %zu passes, %s:\n", request.passes,
                   HasScale(result, request) ? "at the scale" : "at the encoder less the screw's wind-up");
  for (const Trial& t : result.tried) {
    text += FormatText("  %-34s %10s %10s %10s   %s\n", ("model by " + t.from + ",").c_str(), "before",
                       "after", "change", "chance");
    text += Line(request.path.program.name.c_str(), t.path);
    text += Line(request.check.program.name.c_str(), t.check);
  }
  if (!HasScale(result, request) && StiffnessChanged(result, request))
    text +=
        "note: the stiffness of the screw has changed, which moves the table and not the motor. Without a "
        "linear scale nothing on this machine shows whether the table is better for it.\n";
  for (const std::string& why : result.left_out) text += "left out: " + why + "\n";
  text += FormatText("machine time used: %.0f s\n", result.machine_time_s);
  text += (result.judgement.keep ? "kept: " : "not kept: ") + result.judgement.why + "\n";
  return text;
}

void WriteDrawing(const std::filesystem::path& file, const Drawing& drawing,
                  const std::vector<std::string>& axes) {
  std::ofstream out(file);
  out << "time_s";
  for (const std::string& a : axes)
    out << "," << a << "_reference_m," << a << "_encoder_m," << a << "_scale_m";
  out << "\n";
  for (const DrawnCycle& c : drawing.cycles) {
    out << NumberText(c.path_time_s);
    for (const DrawnAxis& a : c.axes)
      out << "," << NumberText(a.reference_m) << "," << NumberText(a.encoder_m) << ","
          << (std::isnan(a.scale_m) ? "" : NumberText(a.scale_m));
    out << "\n";
  }
  out.close();
  if (!out) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace contour::improve
