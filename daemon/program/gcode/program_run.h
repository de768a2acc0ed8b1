#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/program/gcode/block_reader.h"
#include "daemon/program/gcode/interpreter.h"
#include "daemon/program/gcode/o_words.h"
#include "daemon/program/gcode/value_reader.h"

namespace contour {

/// Goes through a program line by line, as its O words lead, up to its end. `text` must outlive it.
class ProgramRun {
 public:
  ProgramRun(std::string_view text, const std::string& name, const GcodeSettings& settings,
             GcodeInterpreter::Sink sink);

  /// Throws ProgramError with the place.
  void Run();

 private:
  struct Return {
    std::size_t line = 0;
    std::map<std::size_t, std::int64_t> repeats;  ///< of the sub that called
  };

  void FindLines();
  void FindOWords();
  /// Looked for from the nearest mark, or from the line that was asked for last.
  [[nodiscard]] std::size_t BeginOf(std::size_t index);
  [[nodiscard]] std::string_view Line(std::size_t index);
  [[nodiscard]] std::size_t Flow(std::size_t at);
  [[nodiscard]] std::size_t Call(const OWord& word, std::size_t at);
  [[nodiscard]] std::size_t LeaveSub();
  [[nodiscard]] std::size_t Choose(std::size_t at);
  [[nodiscard]] std::size_t Repeat(const OWord& word, std::size_t at);
  [[nodiscard]] std::size_t CloseOf(std::size_t at) const;
  void OpenOWord(std::size_t at);
  bool Condition();
  void RefuseEndless(std::size_t at, std::size_t begin, std::size_t end);
  void EndOfLine();

  std::string_view source_;
  const std::string& name_;
  const GcodeSettings& settings_;
  std::vector<std::size_t> marks_;  ///< where every so many lines begin
  std::size_t lines_ = 0;
  std::size_t found_line_ = 0, found_at_ = 0;  ///< the line that was asked for last, and where it begins
  bool framed_ = false;                        ///< by lines of a percent sign
  bool closed_ = false;
  std::size_t first_ = 0;
  OWords o_words_;
  LineText text_;
  Parameters parameters_;
  ValueReader values_;
  GcodeInterpreter interpreter_;
  Block block_;
  std::vector<Return> returns_;
  std::map<std::size_t, std::int64_t> repeats_;  ///< passes left of each repeat that runs, by its line
  std::set<std::size_t> may_end_;                ///< lines of conditions that RefuseEndless has looked at
};

}  // namespace contour
