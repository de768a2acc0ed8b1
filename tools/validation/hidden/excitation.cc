#include "tools/validation/hidden/excitation.h"

#include <utility>
#include <vector>

#include "analysis/text/format_text.h"

namespace contour::hidden {
namespace {

std::string Strokes(double stroke_mm, double mm_s, double dwell_s = 0.15) {
  return FormatText("{shape: creep, axis: x, stroke_mm: %.5g, velocities_mm_s: [%.5g], dwell_s: %.3g}",
                    stroke_mm, mm_s, dwell_s);
}

/// Moves of the other axis by itself while this one travels; nothing without another axis.
std::string OtherAxisMoves(const Setting& s, double stroke_mm, double mm_s) {
  if (!s.second_axis) return {};
  return FormatText(
      "{together: [{shape: multisine, axis: y, velocity_mm_s: 15, frequency_min_hz: 1.2, frequency_max_hz: "
      "12, lines: 7, seconds: %d}, %s]}",
      s.length == Length::kLong ? 10 : 5, Strokes(stroke_mm, mm_s).c_str());
}

std::string Sequence(const std::vector<std::string>& parts) {
  std::string text = "sequence:\n";
  for (const std::string& part : parts)
    if (!part.empty()) text += "  - " + part + "\n";
  return text;
}

}  // namespace

std::string ExcitationProgram(plant::Random& r, const Setting& s) {
  const TrueAxis& m = s.stated;
  const double lever = m.radius_m_rad();
  const double fast = 240.0 * r.Uniform(0.85, 1.0);
  const double middle = fast * r.Uniform(0.4, 0.5);
  const double slow = fast * r.Uniform(0.15, 0.22);
  const double stroke = 2.0 * m.half_stroke_mm;
  const double stick = m.Fs_N * lever;
  const std::string to_start = FormatText("{shape: line, dx_mm: %.5g, feed_mm_min: 9000}", -0.5 * stroke);
  const std::string back = FormatText("{shape: line, dx_mm: %.5g, feed_mm_min: 9000}", 0.5 * stroke);
  const std::string creep = FormatText(
      "{sequence: [{shape: creep, axis: x, stroke_mm: %.4g, velocities_mm_s: [%.4g, %.4g], dwell_s: 0.1}, "
      "{shape: creep, axis: x, stroke_mm: %.4g, velocities_mm_s: [%.4g, %.4g], dwell_s: 0.1}]}",
      0.8 * m.vs_mm_s * 0.5, 0.3 * m.vs_mm_s, 0.8 * m.vs_mm_s, 4.0 * m.vs_mm_s, 2.5 * m.vs_mm_s,
      8.0 * m.vs_mm_s);
  const std::string steps = FormatText(
      "{shape: torque_steps, axis: x, travel_mm: 0.8, torques_Nm: [%.4g, %.4g, %.4g, %.4g], rise_s: 0.1, "
      "hold_s: 0.15, rest_s: 0.15}",
      0.5 * stick, -0.5 * stick, 1.25 * stick, -1.25 * stick);
  const std::string reversals = FormatText(
      "{shape: reversals, axis: x, amplitudes_mm: [0.002, 0.006, 0.02, 0.08, 0.3, %.3g], frequency_hz: %.3g, "
      "cycles: %d}",
      r.Uniform(0.8, 1.5), r.Uniform(1.8, 2.4), s.length == Length::kLong ? 2 : 1);
  const std::string shake = FormatText(
      "{shape: creep, axis: x, stroke_mm: 40, velocities_mm_s: [%.3g], dwell_s: 0.1, torque: {axis: x, kind: "
      "multisine, amplitude_Nm: %.3g, frequency_min_hz: 15, frequency_max_hz: 350, lines: 40}}",
      r.Uniform(20.0, 30.0), 0.008 * r.Uniform(0.8, 1.2));
  const std::string pulses = FormatText(
      "{shape: creep, axis: x, stroke_mm: 60, velocities_mm_s: [%.3g], dwell_s: 0.1, torque: {axis: x, kind: "
      "pulses, amplitude_Nm: %.3g, width_s: 0.005, period_s: 0.17}}",
      r.Uniform(50.0, 70.0), 0.55 * r.Uniform(0.8, 1.0));
  const std::string sine = FormatText(
      "{shape: multisine, axis: x, velocity_mm_s: %.3g, frequency_min_hz: 1.5, frequency_max_hz: 15, "
      "lines: 8, seconds: 4}",
      r.Uniform(8.0, 12.0));
  const std::string rest = "{shape: hold, seconds: 0.4}";
  std::vector<std::string> head = {steps, reversals, creep, shake, pulses, sine};
  for (std::size_t i = head.size(); i-- > 1;)
    std::swap(head[i], head[static_cast<std::size_t>(r.Uniform() * static_cast<double>(i + 1))]);
  std::vector<std::string> parts = {rest};
  parts.insert(parts.end(), head.begin(), head.end());
  if (s.length == Length::kShort) {
    for (const std::string& part :
         {to_start, Strokes(stroke, middle), Strokes(stroke, fast), Strokes(0.25 * stroke, slow), back,
          pulses, OtherAxisMoves(s, 0.2 * stroke, slow), shake, to_start, Strokes(stroke, fast), back,
          reversals})
      parts.push_back(part);
    return Sequence(parts);
  }
  for (const std::string& part :
       {to_start, Strokes(stroke, middle), Strokes(stroke, fast), Strokes(stroke, slow), back, pulses, shake,
        rest, to_start, Strokes(stroke, fast), Strokes(stroke, fast, 0.05), back})
    parts.push_back(part);
  parts.push_back(OtherAxisMoves(s, 0.3 * stroke, slow));
  // Cooling down at rest, and the first segments once more.
  parts.push_back(FormatText("{shape: hold, seconds: %.3g}", s.temperature ? 8.0 : 1.0));
  for (const std::string& part :
       {reversals, to_start, Strokes(stroke, middle), Strokes(stroke, fast), back, creep, pulses})
    parts.push_back(part);
  return Sequence(parts);
}

}  // namespace contour::hidden
