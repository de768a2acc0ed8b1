#include "daemon/program/gcode/value_reader.h"

#include <charconv>
#include <cmath>
#include <numbers>

namespace contour {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
// Two numbers nearer than this are EQ.
constexpr double kEqual = 1e-4;
constexpr double kNearlyWhole = 1e-4;
// Values inside values; more is no program but an attack on the stack.
constexpr int kDeepest = 100;

enum Operation { kPower, kTimes, kOver, kMod, kPlus, kMinus, kEq, kNe, kGt, kGe, kLt, kLe, kAnd, kOr, kXor };
struct Operator {
  std::string_view text;
  Operation operation;
  int precedence;
};
// A sign that begins another comes after it: "**" before "*".
constexpr Operator kOperators[] = {
    {"**", kPower, 5}, {"*", kTimes, 4}, {"/", kOver, 4},  {"mod", kMod, 4}, {"+", kPlus, 3},
    {"-", kMinus, 3},  {"eq", kEq, 2},   {"ne", kNe, 2},   {"gt", kGt, 2},   {"ge", kGe, 2},
    {"lt", kLt, 2},    {"le", kLe, 2},   {"and", kAnd, 1}, {"or", kOr, 1},   {"xor", kXor, 1},
};

const Operator* NextOperator(const LineText& text) {
  for (const Operator& op : kOperators)
    if (text.Rest().starts_with(op.text)) return &op;
  return nullptr;
}

double Rounded(double value) { return std::trunc(value + (value < 0.0 ? -0.5 : 0.5)); }

bool IsDigit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

double ValueReader::Value() {
  const SourcePlace place = text_.place();
  const double value = Operand();
  if (!std::isfinite(value)) Refuse(place, "the value is not a finite number");
  return value;
}

double ValueReader::Operand() {
  if (++depth_ > kDeepest) text_.Fail("too many brackets, signs or parameters inside each other");
  const double value = Term();
  --depth_;
  return value;
}

double ValueReader::Term() {
  const char c = text_.Peek();
  if (c == '[') return Bracketed();
  if (c == '#') return Parameter();
  if (c >= 'a' && c <= 'z') return Function();
  if (c != '+' && c != '-') return Number();
  text_.Skip(1);
  const double value = Operand();
  return c == '-' ? -value : value;
}

double ValueReader::Number() {
  const std::string_view rest = text_.Rest();
  std::size_t size = 0;
  int points = 0, digits = 0;
  for (; size < rest.size() && (IsDigit(rest[size]) || rest[size] == '.'); ++size)
    ++(rest[size] == '.' ? points : digits);
  if (digits == 0) text_.Fail("expected a number");
  if (points > 1) text_.Fail("a number with two decimal points");
  double value = 0.0;
  const auto end = std::from_chars(rest.data(), rest.data() + size, value, std::chars_format::fixed);
  if (end.ec != std::errc{}) text_.Fail("the number cannot be read");
  text_.Skip(size);
  return value;
}

int ValueReader::Whole(const char* what) {
  const SourcePlace place = text_.place();
  const double value = Value();
  if (std::abs(value - std::round(value)) > kNearlyWhole || std::abs(value) > 1e9)
    Refuse(place, std::string(what) + ": expected a whole number");
  return static_cast<int>(std::lround(value));
}

std::string ValueReader::Name() {
  text_.Skip(1);
  const std::size_t size = text_.Rest().find('>');
  if (size == std::string_view::npos || size == 0) text_.Fail("expected a name that ends in '>'");
  std::string name(text_.Rest().substr(0, size));
  text_.Skip(size + 1);
  return name;
}

double ValueReader::Parameter() {
  const SourcePlace place = text_.place();
  text_.Skip(1);
  if (text_.Peek() == '<') {
    const std::string name = Name();
    const auto value = parameters_.Value(name);
    if (!value) Refuse(place, "parameter #<" + name + "> has not been set");
    return *value;
  }
  const int number = Whole("#");
  const auto value = parameters_.Value(number);
  if (!value)
    Refuse(place, "parameter #" + std::to_string(number) +
                      " is not known here: expected #1 to #5000, or the position in #5420 to #5428");
  return *value;
}

double ValueReader::Exists() {
  if (!text_.TakeIf("[#")) text_.Fail("exists: expected [#<name>]");
  if (text_.Peek() != '<') text_.Fail("exists: expected [#<name>]");
  const bool exists = parameters_.Value(Name()).has_value();
  if (!text_.TakeIf(']')) text_.Fail("expected ']'");
  return exists ? 1.0 : 0.0;
}

double ValueReader::Function() {
  const SourcePlace place = text_.place();
  std::string name;
  while (text_.Peek() >= 'a' && text_.Peek() <= 'z') name += text_.Take();
  if (name == "exists") return Exists();
  if (text_.Peek() != '[') Refuse(place, "expected a number, or a function with its argument in brackets");
  const double x = Bracketed();
  if (name == "atan") {
    if (!text_.TakeIf('/') || text_.Peek() != '[')
      text_.Fail("atan: expected /[...] behind the first argument");
    return std::atan2(x, Bracketed()) / kDegree;
  }
  const bool in_range = std::abs(x) <= 1.0;
  if ((name == "acos" || name == "asin") && !in_range) Refuse(place, name + " of a number beyond -1 to 1");
  if (name == "ln" && !(x > 0.0)) Refuse(place, "ln of a number that is not above zero");
  if (name == "sqrt" && x < 0.0) Refuse(place, "sqrt of a negative number");
  if (name == "abs") return std::abs(x);
  if (name == "acos") return std::acos(x) / kDegree;
  if (name == "asin") return std::asin(x) / kDegree;
  if (name == "cos") return std::cos(x * kDegree);
  if (name == "exp") return std::exp(x);
  if (name == "fix") return std::floor(x);
  if (name == "fup") return std::ceil(x);
  if (name == "ln") return std::log(x);
  if (name == "round") return Rounded(x);
  if (name == "sin") return std::sin(x * kDegree);
  if (name == "sqrt") return std::sqrt(x);
  if (name == "tan") return std::tan(x * kDegree);
  Refuse(place, "function " + name + " is not known");
}

double ValueReader::Bracketed() {
  if (!text_.TakeIf('[')) text_.Fail("expected '['");
  const double value = Expression(1);
  if (!text_.TakeIf(']')) text_.Fail("expected an operator or ']'");
  return value;
}

/// Operators of the same precedence are taken from left to right, powers too.
double ValueReader::Expression(int least_precedence) {
  double left = Operand();
  for (const Operator* op = NextOperator(text_); op && op->precedence >= least_precedence;
       op = NextOperator(text_)) {
    text_.Skip(op->text.size());
    left = Apply(op->operation, left, Expression(op->precedence + 1));
  }
  return left;
}

double ValueReader::Apply(int op, double left, double right) const {
  const bool equal = std::abs(left - right) < kEqual;
  switch (op) {
    case kPower:
      if (left < 0.0 && std::floor(right) != right)
        text_.Fail("a negative number to a power that is not whole");
      return std::pow(left, right);
    case kTimes:
      return left * right;
    case kOver:
      if (right == 0.0) text_.Fail("division by zero");
      return left / right;
    case kMod: {
      const double rest = std::fmod(left, right);
      return rest < 0.0 ? rest + std::abs(right) : rest;
    }
    case kPlus:
      return left + right;
    case kMinus:
      return left - right;
    case kEq:
      return equal;
    case kNe:
      return !equal;
    case kGt:
      return left > right;
    case kGe:
      return equal || left >= right;
    case kLt:
      return left < right;
    case kLe:
      return equal || left <= right;
    case kAnd:
      return left != 0.0 && right != 0.0;
    case kOr:
      return left != 0.0 || right != 0.0;
    default:
      return (left != 0.0) != (right != 0.0);
  }
}

}  // namespace contour
