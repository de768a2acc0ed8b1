#include "daemon/program/gcode/program_run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "daemon/program/gcode/line_ends.h"

namespace contour {
namespace {

using Kind = OWord::Kind;

constexpr std::size_t kDeepestCalls = 10;
// A program that runs through so many lines more than it has does not end.
constexpr std::int64_t kMostLines = 5'000'000;
constexpr double kMostRepeats = 1e9;
/// Lines from one whose place is kept to the next.
constexpr std::size_t kMark = 256;

bool IsFrame(std::string_view line) {
  const std::size_t at = line.find_first_not_of(" \t\r");
  return at != std::string_view::npos && line[at] == '%' &&
         line.find_first_not_of(" \t\r", at + 1) == std::string_view::npos;
}

bool IsEmpty(std::string_view line) { return line.find_first_not_of(" \t\r") == std::string_view::npos; }

}  // namespace

ProgramRun::ProgramRun(std::string_view text, const std::string& name, const GcodeSettings& settings,
                       GcodeInterpreter::Sink sink)
    : source_(WithoutByteOrderMark(text)),
      name_(name),
      settings_(settings),
      text_(name),
      values_(text_, parameters_),
      interpreter_(settings, std::move(sink)) {
  FindLines();
  FindOWords();
}

std::size_t ProgramRun::BeginOf(std::size_t index) {
  const std::size_t mark = index - index % kMark;
  if (index < found_line_ || mark > found_line_) {
    found_line_ = mark;
    found_at_ = marks_[mark / kMark];
  }
  for (; found_line_ < index; ++found_line_) found_at_ = EndOfLineFrom(source_, found_at_).next;
  return found_at_;
}

std::string_view ProgramRun::Line(std::size_t index) {
  const std::size_t begin = BeginOf(index);
  return source_.substr(begin, EndOfLineFrom(source_, begin).text - begin);
}

/// Where lines begin, up to the end of the text or of its frame of percent signs.
void ProgramRun::FindLines() {
  std::size_t at = 0;
  bool begun = false;
  while (at < source_.size()) {
    const LineEnd end = EndOfLineFrom(source_, at);
    const std::string_view text = source_.substr(at, end.text - at);
    if (begun && framed_ && IsFrame(text)) {
      closed_ = true;
      break;
    }
    if (lines_ % kMark == 0) marks_.push_back(at);
    ++lines_;
    if (!begun && !IsEmpty(text)) {
      begun = true;
      framed_ = IsFrame(text);
      first_ = framed_ ? lines_ : 0;
    }
    at = end.next;
  }
}

void ProgramRun::FindOWords() {
  std::vector<OWord> words;
  for (std::size_t i = first_; i < lines_; ++i) {
    if (!BeginsWithO(Line(i))) continue;
    try {
      text_.Assign(Line(i), static_cast<int>(i) + 1);
      if (TakeBlockDelete(text_) && settings_.block_delete) continue;
      TakeBlockNumber(text_);
      OWord word = ReadOWord(text_);
      word.line = i;
      words.push_back(std::move(word));
    } catch (const ProgramError&) {
      // It may lie behind the end of the program, where anything may stand. Otherwise it is refused when it
      // runs.
    }
  }
  o_words_ = OWords(std::move(words), name_);
}

void ProgramRun::Run() {
  std::int64_t done = 0;
  for (std::size_t at = first_; at < lines_ && !interpreter_.ended();) {
    text_.Assign(Line(at), static_cast<int>(at) + 1);
    if (++done > kMostLines + static_cast<std::int64_t>(lines_))
      text_.Fail("the program runs through more lines than it may: does it end?");
    if (TakeBlockDelete(text_) && settings_.block_delete) {
      ++at;
      continue;
    }
    TakeBlockNumber(text_);
    if (text_.AtEnd()) {
      ++at;
      continue;
    }
    interpreter_.PutPosition(parameters_.position());
    if (text_.Rest().find("#<_") != std::string_view::npos) interpreter_.PutModes(parameters_.modal());
    if (text_.Peek() == 'o') {
      at = Flow(at);
      continue;
    }
    ReadBlock(text_, parameters_, name_, block_);
    for (const Assignment& assignment : block_.assignments) parameters_.Set(assignment);
    if (block_.sets_something) interpreter_.Execute(block_, parameters_.depth() > 0);
    ++at;
  }
  if (framed_ && !closed_ && !interpreter_.ended()) {
    Refuse(
        {&name_, static_cast<int>(lines_), 1},
        "the file begins with a percent sign and has neither another nor M2 or M30 at its end: is it whole?");
  }
}

/// Puts the text behind the keyword of an O word that is not the one at work.
void ProgramRun::OpenOWord(std::size_t at) {
  text_.Assign(Line(at), static_cast<int>(at) + 1);
  TakeBlockDelete(text_);
  TakeBlockNumber(text_);
  ReadOWord(text_);
}

bool ProgramRun::Condition() {
  const bool holds = values_.Bracketed() != 0.0;
  EndOfLine();
  return holds;
}

/// Of a loop whose condition in the line `at` holds, with its lines between `begin` and `end`: what is no
/// parameter will always hold, and only these words leave it.
void ProgramRun::RefuseEndless(std::size_t at, std::size_t begin, std::size_t end) {
  if (!may_end_.insert(at).second) return;
  text_.Assign(Line(at), static_cast<int>(at) + 1);
  if (text_.Rest().find('#') != std::string_view::npos) return;
  for (std::size_t i = begin + 1; i < end; ++i) {
    const OWord* word = o_words_.At(i);
    const bool leaves = word != nullptr && (word->kind == Kind::kBreak || word->kind == Kind::kReturn ||
                                            word->kind == Kind::kEndSub || word->kind == Kind::kCall);
    // M2 and M30 end the program, and what their numbers are may be computed.
    text_.Assign(Line(i), static_cast<int>(i) + 1);
    if (leaves || text_.Rest().find('m') != std::string_view::npos) return;
  }
  text_.Assign(Line(at), static_cast<int>(at) + 1);
  text_.Fail("the condition always holds, and nothing leaves the loop: the program does not end");
}

void ProgramRun::EndOfLine() {
  while (text_.TakeIf('(')) {
  }
  if (!text_.AtEnd()) text_.Fail("nothing more is expected in this line");
}

std::size_t ProgramRun::CloseOf(std::size_t at) const {
  std::size_t close = at;
  for (const OWord* word = o_words_.At(at); word && word->next != OWord::kNone; word = o_words_.At(close))
    close = word->next;
  return close;
}

/// The line after an O word.
std::size_t ProgramRun::Flow(std::size_t at) {
  ReadOWord(text_);
  const OWord& word = *o_words_.At(at);
  switch (word.kind) {
    case Kind::kNumber:
      return at + 1;
    case Kind::kSub:
      return CloseOf(at) + 1;  // it runs when it is called
    case Kind::kCall:
      return Call(word, at);
    case Kind::kReturn:
    case Kind::kEndSub:
      return LeaveSub();
    case Kind::kIf:
      return Choose(at);
    case Kind::kElseIf:
    case Kind::kElse:
      return CloseOf(at) + 1;  // the branch before it has run
    case Kind::kEndIf:
    case Kind::kDo:
      EndOfLine();
      return at + 1;
    case Kind::kWhile:
      if (!Condition()) return CloseOf(at) + 1;
      RefuseEndless(at, at, CloseOf(at));
      return at + 1;
    case Kind::kEndWhile:
      EndOfLine();
      return word.begin;
    case Kind::kDoWhile:
      if (!Condition()) return at + 1;
      RefuseEndless(at, word.begin, at);
      return word.begin + 1;
    case Kind::kRepeat:
    case Kind::kEndRepeat:
      return Repeat(word, at);
    case Kind::kBreak:
      EndOfLine();
      repeats_.erase(word.begin);
      return CloseOf(word.begin) + 1;
    case Kind::kContinue:
      EndOfLine();
      return CloseOf(word.begin);
  }
  return at + 1;
}

std::size_t ProgramRun::Call(const OWord& word, std::size_t at) {
  std::vector<double> arguments;
  while (text_.Peek() == '[') arguments.push_back(values_.Bracketed());
  EndOfLine();
  const OWord* sub = o_words_.Sub(word.label);
  if (sub == nullptr)
    text_.Fail("there is no sub O" + word.label + " in this program; other files are not read");
  if (returns_.size() >= kDeepestCalls) text_.Fail("more than ten subs inside each other");
  returns_.push_back({at + 1, std::exchange(repeats_, {})});
  parameters_.EnterSub(arguments);
  return sub->line + 1;
}

std::size_t ProgramRun::LeaveSub() {
  if (text_.Peek() == '[') {
    const double value = values_.Bracketed();
    parameters_.Set({0, "_value", value});
  }
  EndOfLine();
  const Return back = returns_.back();
  returns_.pop_back();
  repeats_ = back.repeats;
  parameters_.LeaveSub();
  return back.line;
}

/// From an if to the branch that is to run.
std::size_t ProgramRun::Choose(std::size_t at) {
  for (;;) {
    const OWord* word = o_words_.At(at);
    if (word->kind == Kind::kElse || word->kind == Kind::kEndIf) {
      EndOfLine();
      return at + 1;
    }
    if (Condition()) return at + 1;
    at = word->next;
    OpenOWord(at);
  }
}

std::size_t ProgramRun::Repeat(const OWord& word, std::size_t at) {
  if (word.kind == Kind::kRepeat) {
    const SourcePlace place = text_.place();
    const double passes = values_.Bracketed();
    EndOfLine();
    if (!(passes < kMostRepeats)) Refuse(place, "repeat: more passes than a program may have");
    if (passes < 1.0) return CloseOf(at) + 1;
    repeats_[at] = static_cast<std::int64_t>(passes);
    return at + 1;
  }
  EndOfLine();
  const auto left = repeats_.find(word.begin);
  if (left == repeats_.end()) return at + 1;
  if (--left->second > 0) return word.begin + 1;
  repeats_.erase(left);
  return at + 1;
}

}  // namespace contour
