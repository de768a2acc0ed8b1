#include "daemon/program/gcode/block_rules.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "daemon/program/gcode/drilling_cycle.h"
#include "daemon/program/gcode/tool_table.h"

namespace contour {
namespace {

constexpr int kMostMCodes = 4;
constexpr double kMostTurns = 1e6;
// Of one line: more is a typing error, and would be unrolled for minutes.
constexpr double kMostHoles = 1e6;
constexpr double kNearlyWhole = 1e-3;

bool IsArc(int motion) { return motion == 20 || motion == 30; }

bool TakesAxes(int nonmodal) {
  return nonmodal == 100 || nonmodal == 280 || nonmodal == 300 || nonmodal == 520 || nonmodal == 920;
}

bool NeedsAxes(int nonmodal) { return nonmodal == 520 || nonmodal == 920; }

void CheckPolar(const Block& block, const RuleContext& context) {
  if (!block.IsPolar()) return;
  const int column = (block.polar_radius ? block.polar_radius : block.polar_angle_deg)->column;
  if (context.plane != 170) block.FailAt(column, "polar coordinates need the plane G17");
  if (block.HasAny("xy")) block.FailAt(column, "polar coordinates beside X or Y");
  if (block.G(kNonModal) == 530) block.FailAt(column, "polar coordinates with G53");
  if (block.motion == kNoCode || block.motion == kNoMotion || TakesAxes(block.G(kNonModal)))
    block.FailAt(column, "polar coordinates belong to motion");
}

[[noreturn]] void FailWithoutMotion(const Block& block, int modal_motion) {
  const std::string what = std::string("a position without G0, G1, G2 or G3 ") +
                           (modal_motion == kNoMotion ? "since G80" : "before it") +
                           ": write one of them in this block";
  for (const char letter : kGcodeAxes)
    if (block.Has(letter)) block.FailAtWord(letter, what);
  block.FailAt(1, what);
}

void FindMotion(Block& block, int modal_motion) {
  const bool axes = block.HasAny(kGcodeAxes) || block.IsPolar();
  const int nonmodal = block.G(kNonModal);
  const int own = block.G(kMotion);
  if (!axes && NeedsAxes(nonmodal) && (own == kNoCode || own == kNoMotion))
    block.FailAtG(kNonModal, NameOfG(nonmodal) + ": expected axis words");
  if (own == kNoMotion && axes && !TakesAxes(nonmodal)) block.FailAtG(kMotion, "G80 takes no axis words");
  if (IsDrillingCycle(own) && !axes) block.FailAtG(kMotion, NameOfG(own) + ": expected axis words");
  if (own != kNoCode && own != kNoMotion && TakesAxes(nonmodal)) {
    block.FailAtG(kMotion, NameOfG(own) + " and " + NameOfG(nonmodal) + " would both use the axis words");
  }
  block.motion = own;
  if (own != kNoCode || TakesAxes(nonmodal)) return;
  if (axes) {
    if (modal_motion == kNoCode || modal_motion == kNoMotion) FailWithoutMotion(block, modal_motion);
    block.motion = modal_motion;
  } else if (block.HasAny("ijk") && IsArc(modal_motion)) {
    block.motion = modal_motion;
  }
}

bool Whole(double value) { return std::abs(value - std::round(value)) <= kNearlyWhole; }

void CheckG10(const Block& block) {
  const auto& l = block.Get('l');
  if (!l || (l->value != 2.0 && l->value != 20.0)) {
    const int column = l ? l->column : block.g[kNonModal].column;
    block.FailAt(column, "G10: expected L2 or L20, the only ones that are supported");
  }
  const bool turned = block.Has('r') && block.Get('r')->value != 0.0;
  if (turned || block.HasAny("ij"))
    block.FailAtG(kNonModal, "G10: a rotation of coordinates is not supported");
  const auto& p = block.Get('p');
  if (!p || !Whole(p->value) || p->value < -kNearlyWhole || p->value > 9.0 + kNearlyWhole) {
    const int column = p ? p->column : block.g[kNonModal].column;
    block.FailAt(column, "G10: expected P0 to P9, the number of a coordinate system");
  }
}

void CheckNonModal(const Block& block, const RuleContext& context) {
  const int code = block.G(kNonModal);
  if (code == 40 && IsArc(block.G(kMotion)))
    block.FailAtG(kMotion, "G4 and an arc in the same block both use P");
  if (code == 100) CheckG10(block);
  if (code == 530) {
    if (block.motion != 0 && block.motion != 10) block.FailAtG(kNonModal, "G53 needs G0 or G1");
    const int distance = block.G(kDistance);
    if (distance == 910 || (distance == kNoCode && !context.absolute))
      block.FailAtG(kNonModal, "G53 needs absolute positions (G90)");
  }
  const bool in_machine = code == 280 || code == 300 || code == 530;
  if (in_machine && !context.referenced) {
    block.FailAtG(kNonModal,
                  NameOfG(code) + " counts from the machine's own zero, and the machine is not referenced");
  }
}

/// What is wrong with a code itself, whatever its axis words would do.
void CheckWordsOfCodes(const Block& block) {
  if (block.G(kNonModal) == 40 && (!block.Has('p') || block.Get('p')->value < 0.0)) {
    block.FailAtG(kNonModal, std::string("G4: expected P with a time in seconds") +
                                 (block.HasAny("xu") ? "; X and U are positions here" : ""));
  }
  const auto &h = block.Get('h'), &t = block.Get('t');
  if (t && (!Whole(t->value) || t->value > kMostTools))
    block.FailAtWord('t', "T: expected the whole number of a tool");
  if (block.G(kToolLength) == 430 && h && (!Whole(h->value) || h->value > kMostTools))
    block.FailAtWord('h', "G43: expected H with the number of a tool");
}

void CheckDrilling(const Block& block) {
  for (const char letter : {'u', 'v', 'w'})
    if (block.Has(letter)) block.FailAtWord(letter, "a drilling cycle moves X, Y and Z only");
  const auto& l = block.Get('l');
  if (l && (!Whole(l->value) || l->value < 1.0 - kNearlyWhole || l->value > kMostHoles))
    block.FailAtWord('l', "L of a drilling cycle: expected how many holes, 1 at least");
  if (block.Has('p') && DwellsInCycle(block.motion) && block.Get('p')->value < 0.0)
    block.FailAtWord('p', "P of a drilling cycle: expected a time in seconds");
  if (block.Has('q') && PecksInCycle(block.motion) && block.Get('q')->value <= 0.0)
    block.FailAtWord('q', "Q of a drilling cycle: expected the depth of a peck, more than 0");
}

void CheckWords(const Block& block) {
  const bool arc = IsArc(block.motion);
  const bool drills = IsDrillingCycle(block.motion);
  const bool g64 = block.G(kPathControl) == 640;
  const bool g10 = block.G(kNonModal) == 100;
  for (const char letter : {'i', 'j', 'k'})
    if (block.Has(letter) && !arc) block.FailAtWord(letter, "I, J and K belong to G2 and G3");
  if (block.Has('r') && !arc && !drills && !g10)
    block.FailAtWord('r', "R belongs to G2, G3 and drilling cycles");
  if (block.Has('d')) block.FailAtWord('d', "D belongs to G41 and G42, which are not supported");
  if (block.Has('h') && block.G(kToolLength) != 430) block.FailAtWord('h', "H belongs to G43");
  if (block.Has('l') && !g10 && !drills) block.FailAtWord('l', "L belongs to G10 and drilling cycles");
  if (block.Has('q') && !g64 && !PecksInCycle(block.motion))
    block.FailAtWord('q', "Q belongs to G64, G73 and G83");
  if (drills) CheckDrilling(block);
  if (!block.Has('p')) return;
  if (!g10 && !g64 && !arc && !DwellsInCycle(block.motion) && block.G(kNonModal) != 40)
    block.FailAtWord('p', "P belongs to G2, G3, G4, G10, G64, G82 and G89");
  const double p = block.Get('p')->value;
  if (arc && !Whole(p)) block.FailAtWord('p', "P of an arc: expected a whole number of turns");
  if (arc && p > kMostTurns) block.FailAtWord('p', "P of an arc: more turns than an arc may have");
  if (arc && std::round(p) < 1.0) block.FailAtWord('p', "P of an arc: expected at least one turn");
}

}  // namespace

void CheckBlock(Block& block, const RuleContext& context) {
  CheckWordsOfCodes(block);
  FindMotion(block, context.modal_motion);
  CheckPolar(block, context);
  CheckNonModal(block, context);
  if (block.m_count > kMostMCodes) {
    const auto last = std::max_element(block.m.begin(), block.m.end(),
                                       [](const auto& a, const auto& b) { return a.column < b.column; });
    block.FailAt(last->column, "more than four M codes in a block");
  }
  CheckWords(block);
}

}  // namespace contour
