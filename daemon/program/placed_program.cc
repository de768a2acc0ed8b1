#include "daemon/program/placed_program.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "daemon/program/gcode_parser.h"
#include "daemon/program/piecewise_plan.h"

namespace contour {
namespace {

/// Closer than this the machine stands at program zero: rounding in where the last program ended.
constexpr double kSamePlace_m = 1e-9;
/// Of the speed that the axes may have along the line to where a shape begins.
constexpr double kApproachSpeed = 0.1;

std::shared_ptr<const MotionPlan> Approach(const Program& program, const Placement& place,
                                           const PerAxis<PlanLimits>& limits) {
  PieceRequest line;
  line.curve = LinePiece(place.start_m, place.zero_m);
  line.origin = program.name + ": on the way to program zero";
  line.speed_m_s = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < limits.size(); ++i)
    if (line.curve.direction[i] != 0.0)
      line.speed_m_s = std::min(line.speed_m_s,
                                kApproachSpeed * limits[i].velocity_m_s / std::abs(line.curve.direction[i]));
  return std::make_shared<PiecewisePlan>(std::vector{line}, PathTraits{}, limits);
}

}  // namespace

Program ReadPlaced(const ProgramSource& source, const Placement& place, const PerAxis<PlanLimits>& limits,
                   const ReadOptions& options) {
  const PartOfProgram& part = options.part;
  if (source.format != ProgramFormat::kGcode) {
    if (part.from_line > 0 || part.single_block)
      throw ProgramError(source.name +
                         ": single block and a line to begin with are for G-code: a shape has no lines");
    return ParseProgram(source.text, source.name, source.format);
  }
  constexpr std::string_view kLetters = "xyzuvw";
  GcodeSettings settings;
  settings.block_delete = part.block_delete.value_or(settings.block_delete);
  settings.begins_at_line = part.from_line;
  settings.tool_table = part.tool_table;
  settings.joins_lines = !part.single_block;
  if (options.referenced) settings.zero_m.emplace();
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const std::size_t letter = limits[i].axis.size() == 1 ? kLetters.find(limits[i].axis[0]) : kLetters.npos;
    if (letter == kLetters.npos) continue;
    settings.start_m[letter] = place.start_m[i] - place.zero_m[i];
    if (options.referenced) (*settings.zero_m)[letter] = place.zero_m[i];
  }
  GcodeMoves moves = FromLine(ParseGcode(source.text, source.name, settings), source.name, part);
  UseEvents(moves, source.name, options.events);
  return {source.name, part.single_block ? WithStops(std::move(moves)) : std::move(moves)};
}

double Placement::Off_m() const {
  double square_m2 = 0.0;
  for (std::size_t i = 0; i < start_m.size(); ++i)
    square_m2 += (start_m[i] - zero_m[i]) * (start_m[i] - zero_m[i]);
  return std::sqrt(square_m2);
}

std::shared_ptr<const MotionPlan> PlanPlaced(const Program& program, const Placement& place,
                                             const PerAxis<PlanLimits>& limits) {
  // G-code that was read for this place says itself where it goes first.
  if (place.Off_m() <= kSamePlace_m || std::holds_alternative<GcodeMoves>(program.shape))
    return PlanMotion(program, place.start_m, limits);
  std::shared_ptr<const MotionPlan> figure = PlanMotion(program, place.zero_m, limits);
  return std::make_shared<ApproachPlan>(Approach(program, place, limits), std::move(figure));
}

}  // namespace contour
