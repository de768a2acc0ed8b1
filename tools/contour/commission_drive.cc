#include "tools/contour/commission_drive.h"

#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "analysis/drive_loop/drive_response.h"
#include "analysis/drive_loop/report_noise.h"
#include "config/loop_axis.h"
#include "config/whole_file.h"
#include "core/exit_status.h"
#include "core/two_inertia_axis.h"
#include "design/drive_fit.h"
#include "design/drive_motions.h"
#include "design/drive_report.h"
#include "design/loop_report.h"

namespace contour {
namespace {

/// Of the rated force: the step that loops are judged by.
constexpr double kStepOfRated = 0.1;
constexpr double kDegrees = 57.29577951308232;

nlohmann::json ToJson(const DriveReport& r, const DriveResponse& response, double period_s) {
  nlohmann::json lines = nlohmann::json::array();
  const DriveLoopOn on(r.fit.axis, r.fit.loop);
  for (const DriveResponse::Line& line : response.lines) {
    const std::complex<double> model = on.OffsetToMotor(line.frequency_Hz, period_s);
    lines.push_back({{"frequency_Hz", line.frequency_Hz},
                     {"compliance_um_N", 1e6 * std::abs(line.compliance_m_N)},
                     {"phase_deg", kDegrees * std::arg(line.compliance_m_N)},
                     {"scatter_rel", line.scatter_rel},
                     {"model_um_N", 1e6 * std::abs(model)},
                     {"model_phase_deg", kDegrees * std::arg(model)}});
  }
  return {{"axis", r.axis},
          {"velocity_Ns_m", r.fit.loop.velocity_Ns_m},
          {"position_1_s", r.fit.loop.position_1_s},
          {"integral_1_s", r.fit.loop.integral_1_s},
          {"offset_late_s", r.fit.loop.offset_late_s},
          {"model_error_rel", r.fit.error_rel},
          {"sensitivity_peak", r.figures.peak},
          {"phase_margin_deg", r.figures.phase_margin_deg},
          {"bandwidth_Hz", r.figures.bandwidth_Hz},
          {"stiffness_1Hz_N_um", r.figures.stiffness_1Hz_N_um},
          {"stiffness_10Hz_N_um", r.figures.stiffness_10Hz_N_um},
          {"least_stiffness_N_um", r.figures.least_stiffness_N_um},
          {"step_N", r.step_N},
          {"step_peak_um", 1e6 * r.figures.step_peak_m},
          {"gain_room", r.figures.gain_room},
          {"count_m", r.count_m},
          {"count_kick_N", r.kick_N},
          {"friction_N", r.friction_N},
          {"missing_acceleration_share", r.acceleration.missing},
          {"missing_acceleration_std", r.acceleration.std},
          {"csp_acceleration_share", AdvisedShare(r)},
          {"response", lines}};
}

}  // namespace

int ReportOnDrive(const MachineConfig& machine, const std::string& name,
                  const std::vector<DriveSample>& samples, const std::filesystem::path& file) {
  const AxisConfig& axis = machine.axes.at(name);
  const double period_s = 1e-6 * machine.machine.cycle_us;
  const TwoInertiaAxis stated = TwoInertiaAxisOf(axis);
  const DriveResponse response =
      MeasureDrive(samples, period_s, static_cast<std::size_t>(std::lround(kDrivePeriod_s / period_s)));
  DriveReport report;
  report.axis = name;
  std::string wrong;
  try {
    report.fit = FitDrive(response, stated, period_s);
    wrong = WhyUnusable(report.fit);
  } catch (const std::runtime_error& e) {
    wrong = e.what();
  }
  if (!wrong.empty()) {
    std::cout << "nothing was written: the loop of the drive could not be told: " << wrong << "\n";
    return kExitFailed;
  }
  report.step_N = kStepOfRated * axis.drive.rated_torque_Nm / ToSi(axis.model.mechanics).radius_m_rad;
  report.count_m = 1e-3 * axis.model.mechanics.lead_mm / axis.drive.encoder_counts_per_rev;
  report.kick_N = ReportNoise_N(samples);
  const Friction friction = ToSi(axis.model.friction, ToSi(axis.model.mechanics).radius_m_rad);
  report.friction_N = 0.5 * (friction.Fc_plus_N + friction.Fc_minus_N);
  report.figures = FiguresOf(report.fit.axis, report.fit.loop, report.step_N);
  report.acceleration = MissingAcceleration(samples, report.fit.axis, report.fit.loop, period_s);
  report.given_share = axis.drive.csp_acceleration_share;
  if (axis.loop)
    report.torque_mode_peak_m = ReportOn(LoopAxisOf(axis), *axis.loop, period_s).verdict.step.peak_m;
  std::cout << Describe(report) << Advice(report);
  WriteWholeFile(file, ToJson(report, response, period_s).dump(2) + "\n");
  std::cout << "wrote " << file.string() << "\n";
  return kExitDone;
}

}  // namespace contour
