#include "daemon/program/gcode/o_words.h"

#include <algorithm>
#include <utility>

namespace contour {
namespace {

using Kind = OWord::Kind;

struct Keyword {
  std::string_view text;
  Kind kind;
};
// What begins like another comes first.
constexpr Keyword kKeywords[] = {
    {"endrepeat", Kind::kEndRepeat},
    {"endwhile", Kind::kEndWhile},
    {"endsub", Kind::kEndSub},
    {"endif", Kind::kEndIf},
    {"elseif", Kind::kElseIf},
    {"else", Kind::kElse},
    {"repeat", Kind::kRepeat},
    {"return", Kind::kReturn},
    {"continue", Kind::kContinue},
    {"break", Kind::kBreak},
    {"while", Kind::kWhile},
    {"call", Kind::kCall},
    {"sub", Kind::kSub},
    {"do", Kind::kDo},
    {"if", Kind::kIf},
};

bool IsBlank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool IsDigit(char c) { return c >= '0' && c <= '9'; }

bool Opens(Kind kind) {
  return kind == Kind::kSub || kind == Kind::kIf || kind == Kind::kWhile || kind == Kind::kDo ||
         kind == Kind::kRepeat;
}

/// What a closing or middle word has to stand in; kNumber: it stands alone.
Kind OpenedBy(Kind kind) {
  switch (kind) {
    case Kind::kEndSub:
    case Kind::kReturn:
      return Kind::kSub;
    case Kind::kElseIf:
    case Kind::kElse:
    case Kind::kEndIf:
      return Kind::kIf;
    case Kind::kEndWhile:
      return Kind::kWhile;
    case Kind::kDoWhile:
      return Kind::kDo;
    case Kind::kEndRepeat:
      return Kind::kRepeat;
    default:
      return Kind::kNumber;
  }
}

bool Closes(Kind kind) {
  return kind == Kind::kEndSub || kind == Kind::kEndIf || kind == Kind::kEndWhile || kind == Kind::kDoWhile ||
         kind == Kind::kEndRepeat;
}

}  // namespace

bool BeginsWithO(std::string_view line) {
  std::size_t i = 0;
  const auto blanks = [&] {
    while (i < line.size() && IsBlank(line[i])) ++i;
  };
  blanks();
  if (i < line.size() && line[i] == '/') ++i;
  blanks();
  if (i < line.size() && (line[i] == 'n' || line[i] == 'N')) {
    for (++i; i < line.size() && (IsBlank(line[i]) || IsDigit(line[i]) || line[i] == '.');) ++i;
  }
  return i < line.size() && (line[i] == 'o' || line[i] == 'O');
}

OWord ReadOWord(LineText& text) {
  OWord word;
  const SourcePlace place = text.place();
  text.Skip(1);
  if (text.TakeIf('<')) {
    while (!text.AtEnd() && text.Peek() != '>') word.label += text.Take();
    if (!text.TakeIf('>') || word.label.empty()) Refuse(place, "O: expected a name that ends in '>'");
  } else {
    while (IsDigit(text.Peek())) word.label += text.Take();
    if (word.label.empty()) Refuse(place, "O: expected a number or a <name>");
    word.label.erase(0, std::min(word.label.find_first_not_of('0'), word.label.size() - 1));
  }
  for (const Keyword& keyword : kKeywords) {
    if (!text.TakeIf(keyword.text)) continue;
    word.kind = keyword.kind;
    return word;
  }
  while (text.TakeIf('(')) {
  }
  if (!text.AtEnd()) text.Fail("O: expected sub, call, return, if, while, do, repeat or what ends them");
  return word;
}

OWords::OWords(std::vector<OWord> words, const std::string& name) : words_(std::move(words)) {
  std::vector<std::size_t> open;
  std::size_t in_sub = OWord::kNone;
  const auto fail = [&](const OWord& word, const std::string& what) {
    Refuse({&name, static_cast<int>(word.line) + 1, 1}, "O" + word.label + ": " + what);
  };
  for (std::size_t i = 0; i < words_.size(); ++i) {
    OWord& word = words_[i];
    by_line_[word.line] = i;
    const bool known = !open.empty() && words_[open.back()].label == word.label;
    if (word.kind == Kind::kWhile && known && words_[open.back()].kind == Kind::kDo)
      word.kind = Kind::kDoWhile;
    word.in_sub = in_sub != OWord::kNone;
    if (Opens(word.kind)) {
      if (word.kind == Kind::kSub) {
        if (word.in_sub) fail(word, "a sub inside a sub");
        if (!subs_.emplace(word.label, i).second) fail(word, "a second sub of this name");
        in_sub = i;
      }
      open.push_back(i);
      continue;
    }
    if (word.kind == Kind::kReturn) {
      if (in_sub == OWord::kNone) fail(word, "return outside a sub");
      continue;
    }
    if (word.kind == Kind::kBreak || word.kind == Kind::kContinue) {
      const auto loop = std::find_if(open.rbegin(), open.rend(), [&](std::size_t k) {
        return words_[k].label == word.label && words_[k].kind != Kind::kSub && words_[k].kind != Kind::kIf;
      });
      if (loop == open.rend()) fail(word, "break or continue outside the loop of this name");
      word.begin = *loop;
      continue;
    }
    const Kind opener = OpenedBy(word.kind);
    if (opener == Kind::kNumber) continue;
    if (!known || words_[open.back()].kind != opener) fail(word, "this does not belong to what is open here");
    // A chain from branch to branch, and from the line that opens to the one that closes.
    std::size_t last = open.back();
    while (words_[last].next != OWord::kNone) last = words_[last].next;
    words_[last].next = i;
    word.begin = open.back();
    if (!Closes(word.kind)) continue;
    if (word.kind == Kind::kEndSub) in_sub = OWord::kNone;
    open.pop_back();
  }
  if (!open.empty()) fail(words_[open.back()], "this is not closed");
  // From here on the lines are indices into the text.
  for (OWord& word : words_) {
    if (word.begin != OWord::kNone) word.begin = words_[word.begin].line;
    if (word.next != OWord::kNone) word.next = words_[word.next].line;
  }
}

const OWord* OWords::At(std::size_t line) const {
  const auto found = by_line_.find(line);
  return found == by_line_.end() ? nullptr : &words_[found->second];
}

const OWord* OWords::Sub(const std::string& label) const {
  const auto found = subs_.find(label);
  return found == subs_.end() ? nullptr : &words_[found->second];
}

}  // namespace contour
