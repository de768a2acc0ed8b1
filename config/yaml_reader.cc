#include "config/yaml_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "config/key_hints.h"
#include "config/number_text.h"

namespace contour {
namespace {

bool Inside(double number, const Range& range) {
  if (range.min_excluded ? number <= range.min : number < range.min) return false;
  return number <= range.max;
}

// std::from_chars takes no leading plus, which people do write.
std::string_view WithoutPlus(std::string_view text) {
  if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

bool ParseDouble(std::string_view text, double& number) {
  text = WithoutPlus(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} && end == text.data() + text.size();
}

bool ParseInteger(std::string_view text, std::int64_t& number) {
  text = WithoutPlus(text);
  const bool hex = text.starts_with("0x") || text.starts_with("0X");
  if (hex) text.remove_prefix(2);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, hex ? 16 : 10);
  return error == std::errc{} && end == text.data() + text.size() && !text.empty() &&
         !(hex && text.front() == '-');
}

}  // namespace

std::string YamlReader::Join(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : path + "." + std::string(key);
}

std::string YamlReader::ExpectedNumber(Range range, bool whole) {
  return (whole ? "a whole number" : "a number") + RangeText(range);
}

void YamlReader::WrongType(const YamlValue& from, const std::string& path, const std::string& expected,
                           std::vector<std::string>& errors) {
  errors.push_back(from.where + ": " + path + ": found " + from.Describe() + ", expected " + expected);
}

void YamlReader::ReadNumber(const YamlValue& from, double& value, Range range, const std::string& path,
                            std::vector<std::string>& errors) {
  const std::string expected = ExpectedNumber(range, false);
  double number = 0.0;
  if (from.kind != YamlValue::Kind::kScalar || from.quoted || !ParseDouble(from.text, number) ||
      !std::isfinite(number) || !Inside(number, range)) {
    WrongType(from, path, expected, errors);
    return;
  }
  value = number;
}

void YamlReader::ReadInteger(const YamlValue& from, std::int64_t& value, Range range, const std::string& path,
                             std::vector<std::string>& errors) {
  const std::string expected = ExpectedNumber(range, true);
  std::int64_t number = 0;
  if (from.kind != YamlValue::Kind::kScalar || from.quoted || !ParseInteger(from.text, number) ||
      !Inside(static_cast<double>(number), range)) {
    WrongType(from, path, expected, errors);
    return;
  }
  value = number;
}

void YamlReader::ReadBool(const YamlValue& from, bool& value, const std::string& path,
                          std::vector<std::string>& errors) {
  if (from.kind == YamlValue::Kind::kScalar && !from.quoted && (from.text == "true" || from.text == "false"))
    value = from.text == "true";
  else
    WrongType(from, path, "true or false", errors);
}

void YamlReader::ReadText(const YamlValue& from, std::string& value, const std::string& path,
                          std::vector<std::string>& errors) {
  if (from.kind == YamlValue::Kind::kScalar)
    value = from.text;
  else
    WrongType(from, path, "text", errors);
}

const YamlEntry* YamlReader::Take(std::string_view key) {
  known_.emplace_back(key);
  return map_.Find(key);
}

bool YamlReader::CheckDuplicates(const YamlValue& map, const std::string& path,
                                 std::vector<std::string>& errors) {
  const std::size_t before = errors.size();
  for (const YamlEntry& entry : map.entries) {
    const YamlEntry* first = map.Find(entry.key);
    if (first != &entry)
      errors.push_back(entry.where + ": " + Join(path, entry.key) + ": duplicate key, first given at " +
                       first->where);
  }
  return errors.size() == before;
}

void YamlReader::ReportUnknown(const YamlEntry& entry) {
  // A missing key is the likeliest thing a misspelt one stands for; the two then make one message.
  std::vector<std::string> missing;
  for (const Missing& m : missing_) missing.push_back(m.key);
  KeyHint hint = NearestKey(entry.key, missing);
  if (!hint.key.empty())
    std::erase_if(missing_, [&](const Missing& m) { return m.key == hint.key; });
  else
    hint = NearestKey(entry.key, known_);

  std::string message = entry.where + ": " + Dotted(entry.key) + ": unknown key";
  if (hint.other_unit) {
    const std::string unit = UnitText(SplitUnit(hint.key).unit);
    message += ", wrong unit: expected " + hint.key + (unit.empty() ? "" : ", in " + unit);
  } else if (!hint.key.empty()) {
    message += "; did you mean " + hint.key + "?";
  } else {
    message += "; expected one of:";
    for (const std::string& key : known_) message += " " + key;
  }
  errors_.push_back(message);
}

void YamlReader::Finish() {
  CheckDuplicates(map_, path_, errors_);
  for (const YamlEntry& entry : map_.entries) {
    const bool known = std::find(known_.begin(), known_.end(), entry.key) != known_.end();
    if (!known && map_.Find(entry.key) == &entry) ReportUnknown(entry);
  }
  for (const Missing& m : missing_)
    errors_.push_back(map_.where + ": " + Dotted(m.key) + ": missing, expected " + m.expected + ": " +
                      m.text);
}

}  // namespace contour
