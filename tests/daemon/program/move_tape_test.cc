#include "daemon/program/gcode/move_tape.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace contour {
namespace {

std::vector<GcodeMove> RandomMoves(std::size_t count) {
  std::mt19937 random(11);
  const auto one_of = [&](unsigned n) { return random() % n; };
  const auto number = [&] { return std::uniform_real_distribution<double>(-0.1, 0.1)(random); };
  std::vector<GcodeMove> moves;
  GcodeMove move;
  for (std::size_t i = 0; i < count; ++i) {
    move.line += one_of(4) == 0 ? static_cast<int>(one_of(900)) - 300 : 1;
    for (std::size_t k = 0; k < 6; ++k)
      if (one_of(3) == 0) move.target_m[k] = one_of(20) == 0 ? -0.0 : number();
    if (one_of(10) == 0) {
      move.kind = static_cast<GcodeMove::Kind>(one_of(4));
      move.corner = static_cast<GcodeMove::Corner>(one_of(4));
      move.in_sub = one_of(2) == 0;
      move.plane = {static_cast<std::uint8_t>(one_of(3)), static_cast<std::uint8_t>(one_of(3))};
      move.centre_m = {number(), number()};
      move.sweep_rad = number();
    }
    if (one_of(20) == 0) move.feed_m_s = number();
    if (one_of(20) == 0) move.tolerance_m = number();
    if (one_of(20) == 0) move.dwell_s = number();
    moves.push_back(move);
  }
  return moves;
}

void ExpectSame(const GcodeMove& a, const GcodeMove& b) {
  for (std::size_t k = 0; k < 6; ++k) {
    ASSERT_EQ(a.target_m[k], b.target_m[k]);
    ASSERT_EQ(std::signbit(a.target_m[k]), std::signbit(b.target_m[k]));
  }
  ASSERT_EQ(a.kind, b.kind);
  ASSERT_EQ(a.corner, b.corner);
  ASSERT_EQ(a.in_sub, b.in_sub);
  ASSERT_EQ(a.plane, b.plane);
  ASSERT_EQ(a.line, b.line);
  ASSERT_EQ(a.centre_m, b.centre_m);
  ASSERT_EQ(a.sweep_rad, b.sweep_rad);
  ASSERT_EQ(a.feed_m_s, b.feed_m_s);
  ASSERT_EQ(a.tolerance_m, b.tolerance_m);
  ASSERT_EQ(a.dwell_s, b.dwell_s);
}

TEST(MoveTape, GivesEveryMoveBackBitForBit) {
  // Around the numbers at which a move is written whole, and of more than is in memory.
  for (const std::size_t count : {1u, 2u, 255u, 256u, 257u, 258u, 513u, 60000u}) {
    SCOPED_TRACE(count);
    const std::vector<GcodeMove> moves = RandomMoves(count);
    MoveTape tape;
    for (const GcodeMove& m : moves) tape.push_back(m);
    ASSERT_EQ(tape.size(), count);
    std::size_t i = 0;
    for (const GcodeMove& m : tape) ExpectSame(m, moves[i++]);
    ASSERT_EQ(i, count);
    for (std::size_t k = 0; k < count; k += 1 + count / 50) ExpectSame(tape[k], moves[k]);
    ExpectSame(tape[count - 1], moves[count - 1]);
    EXPECT_THROW(static_cast<void>(tape.at(count)), std::out_of_range);
  }
}

TEST(MoveTape, TheNewestMoveCanBeChanged) {
  MoveTape tape;
  for (int i = 0; i < 300; ++i) {
    tape.push_back({});
    tape.back().line = 2 * i;
  }
  for (auto move = tape.From(250); move != tape.end(); ++move)
    EXPECT_EQ(move->line, 2 * static_cast<int>(move.index()));
}

TEST(MoveTape, StopsAreThoseAskedFor) {
  MoveTape tape;
  for (int i = 0; i < 600; ++i) tape.push_back({});
  tape.StopAfter(0);
  tape.StopAfter(300);
  tape.StopAfter(300);
  tape.StopAfter(599);
  const auto stops = [&](std::size_t i) { return tape[i].corner == GcodeMove::Corner::kExactStop; };
  std::size_t count = 0;
  for (const GcodeMove& m : tape) count += m.corner == GcodeMove::Corner::kExactStop ? 1 : 0;
  EXPECT_EQ(count, 3u);
  EXPECT_TRUE(stops(0) && stops(300) && stops(599) && !stops(299) && !stops(301));
  tape.StopAfterAll();
  EXPECT_TRUE(stops(299));
}

TEST(MoveTape, CoordinatesAreHandedOutWhereTheyArePut) {
  MoveTape tape;
  GcodeMove move;
  move.kind = GcodeMove::Kind::kArc;
  move.plane = {1, 2};
  move.target_m = {0.0, 0.2, 0.3, 0.0, 0.0, 0.6};
  tape.push_back(move);
  MoveTape::Places places{};
  places[1] = 0;
  places[2] = 1;
  places[5] = 2;
  tape.Arrange(places);
  EXPECT_EQ(tape[0].target_m, (std::array<double, 6>{0.2, 0.3, 0.6, 0.0, 0.0, 0.0}));
  EXPECT_EQ(tape[0].plane, (std::array<std::uint8_t, 2>{0, 1}));
}

}  // namespace
}  // namespace contour
