#include "config/yaml_reader.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace contour {
namespace {

enum class Side { kTable, kMotor };
bool FromName(std::string_view name, Side& side) {
  if (name == "table") return side = Side::kTable, true;
  if (name == "motor") return side = Side::kMotor, true;
  return false;
}
std::string_view Name(Side side) { return side == Side::kTable ? "table" : "motor"; }
std::string_view Choices(Side) { return "table, motor"; }

struct Screw {
  double lead_mm = 0.0;
  double backlash_um = 0.25;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("lead_mm", lead_mm, Range{0.1, 200.0}, "travel per turn");
    v.Optional("backlash_um", backlash_um, kNotNegative, "play of the nut");
  }
};

struct Machine {
  std::string name;
  std::int32_t cycle_us = 0;
  std::uint8_t node_id = 7;
  bool required = false;
  Side side = Side::kTable;
  std::array<double, 2> position_mm{};
  std::vector<double> phases;
  std::optional<Screw> spare;
  std::map<std::string, Screw> axes;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("name", name, "the name");
    v.Required("cycle_us", cycle_us, Range{100, 10000}, "period");
    v.Optional("node_id", node_id, kAny, "node");
    v.Optional("required", required, "whether");
    v.Optional("side", side, "where");
    v.Optional("position_mm", position_mm, kAny, "stroke");
    v.Optional("phases", phases, kAny, "list");
    v.Optional("spare", spare, "a second screw");
    v.Required("axes", axes, "axes by name");
  }
};

struct Result {
  Machine machine;
  std::vector<std::string> errors;
};

Result Read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  YamlValue root = ParseYamlText(text, "m.yaml");
  for (const std::string& o : overrides) ApplyOverride(root, o);
  Result r;
  ReadYaml(root, r.machine, "", r.errors);
  return r;
}

std::string OnlyError(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const Result r = Read(text, overrides);
  EXPECT_EQ(r.errors.size(), 1U) << ::testing::PrintToString(r.errors);
  return r.errors.empty() ? "" : r.errors.front();
}

const char* const kGood = R"(name: xy
cycle_us: 1000
axes:
  x: {lead_mm: 5}
)";

TEST(YamlReader, ReadsEveryKindOfMember) {
  const Result r = Read(R"(
name: "5"
cycle_us: +2000
node_id: 0x7F
required: true
side: motor
position_mm: [-200, 2e2]
phases: [1, .5, 5e6]
spare: {lead_mm: 10, backlash_um: 1}
axes:
  x: {lead_mm: 5}
  y: {lead_mm: 4.5}
)");
  EXPECT_TRUE(r.errors.empty()) << ::testing::PrintToString(r.errors);
  EXPECT_EQ(r.machine.name, "5");
  EXPECT_EQ(r.machine.cycle_us, 2000);
  EXPECT_EQ(r.machine.node_id, 127);
  EXPECT_TRUE(r.machine.required);
  EXPECT_EQ(r.machine.side, Side::kMotor);
  EXPECT_EQ(r.machine.position_mm, (std::array<double, 2>{-200.0, 200.0}));
  EXPECT_EQ(r.machine.phases, (std::vector<double>{1.0, 0.5, 5e6}));
  ASSERT_TRUE(r.machine.spare.has_value());
  EXPECT_EQ(r.machine.spare->backlash_um, 1.0);
  EXPECT_EQ(r.machine.axes.at("y").lead_mm, 4.5);
  EXPECT_EQ(r.machine.axes.at("y").backlash_um, 0.25);
}

TEST(YamlReader, UnknownKeyNamesLineAndNearestKey) {
  EXPECT_EQ(OnlyError(std::string(kGood) + "requird: true\n"),
            "m.yaml:5: requird: unknown key; did you mean required?");
}

TEST(YamlReader, UnknownKeyNearNothingListsWhatThereIs) {
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\naxes: {x: {lead_mm: 5, colour_of_paint: 3}}\n"),
            "m.yaml:3: axes.x.colour_of_paint: unknown key; expected one of: lead_mm backlash_um");
}

TEST(YamlReader, MisspeltRequiredKeyIsOneMessage) {
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\naxes:\n  x:\n    leed_mm: 5\n"),
            "m.yaml:5: axes.x.leed_mm: unknown key; did you mean lead_mm?");
}

TEST(YamlReader, OtherUnitOfAKnownKeySaysSo) {
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\naxes:\n  x:\n    lead_m: 0.005\n"),
            "m.yaml:5: axes.x.lead_m: unknown key, wrong unit: expected lead_mm, in mm");
  EXPECT_EQ(OnlyError("name: a\ncycle_ms: 1\naxes: {x: {lead_mm: 5}}\n"),
            "m.yaml:2: cycle_ms: unknown key, wrong unit: expected cycle_us, in us");
  EXPECT_EQ(OnlyError("name: a\ncycle: 1\naxes: {x: {lead_mm: 5}}\n"),
            "m.yaml:2: cycle: unknown key, wrong unit: expected cycle_us, in us");
}

TEST(YamlReader, MissingKeySaysWhatIsExpectedAndWhere) {
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\naxes:\n\n  x:\n    backlash_um: 1\n"),
            "m.yaml:5: axes.x.lead_mm: missing, expected a number from 0.1 to 200: travel per turn");
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\n"),
            "m.yaml:1: axes: missing, expected a map of keys: axes by name");
}

TEST(YamlReader, WrongTypes) {
  const auto cycle = [](const std::string& value) {
    return OnlyError("name: a\ncycle_us: " + value + "\naxes: {x: {lead_mm: 5}}\n");
  };
  const std::string whole = ", expected a whole number from 100 to 10000";
  EXPECT_EQ(cycle("fast"), "m.yaml:2: cycle_us: found 'fast'" + whole);
  EXPECT_EQ(cycle("1000.5"), "m.yaml:2: cycle_us: found '1000.5'" + whole);
  EXPECT_EQ(cycle("1e3"), "m.yaml:2: cycle_us: found '1e3'" + whole);
  EXPECT_EQ(cycle("\"1000\""), "m.yaml:2: cycle_us: found the text \"1000\"" + whole);
  EXPECT_EQ(cycle("[1000]"), "m.yaml:2: cycle_us: found a list of 1" + whole);
  EXPECT_EQ(cycle("{us: 1000}"), "m.yaml:2: cycle_us: found a map of keys" + whole);
  EXPECT_EQ(cycle("10 us"), "m.yaml:2: cycle_us: found '10 us'" + whole);
  EXPECT_EQ(cycle("0x"), "m.yaml:2: cycle_us: found '0x'" + whole);
  EXPECT_EQ(cycle("99999999999999999999"), "m.yaml:2: cycle_us: found '99999999999999999999'" + whole);
  EXPECT_EQ(cycle(""), "m.yaml:2: cycle_us: found nothing" + whole);
  EXPECT_EQ(OnlyError(std::string(kGood) + "required: yes\n"),
            "m.yaml:5: required: found 'yes', expected true or false");
  EXPECT_EQ(OnlyError(std::string(kGood) + "side: middle\n"),
            "m.yaml:5: side: found 'middle', expected one of table, motor");
  EXPECT_EQ(OnlyError(std::string(kGood) + "position_mm: [1]\n"),
            "m.yaml:5: position_mm: found a list of 1, expected a list of 2, each a number");
  EXPECT_EQ(OnlyError(std::string(kGood) + "phases: [1, two]\n"),
            "m.yaml:5: phases[1]: found 'two', expected a number");
  EXPECT_EQ(OnlyError(std::string(kGood) + "spare: 3\n"),
            "m.yaml:5: spare: found '3', expected a map of keys");
}

TEST(YamlReader, KeyWithNothingBehindItIsAnEmptyMap) {
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\naxes:\n  x:\n"),
            "m.yaml:4: axes.x.lead_mm: missing, expected a number from 0.1 to 200: travel per turn");
  EXPECT_TRUE(Read("name: a\ncycle_us: 1000\naxes:\n").errors.empty());
}

TEST(YamlReader, OutOfRange) {
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 50\naxes: {x: {lead_mm: 5}}\n"),
            "m.yaml:2: cycle_us: found '50', expected a whole number from 100 to 10000");
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\naxes: {x: {lead_mm: 500}}\n"),
            "m.yaml:3: axes.x.lead_mm: found '500', expected a number from 0.1 to 200");
  // The type's own bounds, where no range is given.
  EXPECT_EQ(OnlyError(std::string(kGood) + "node_id: 256\n"),
            "m.yaml:5: node_id: found '256', expected a whole number from 0 to 255");
}

TEST(YamlReader, NotFiniteNumbersAreRefused) {
  for (const std::string bad : {".nan", "nan", ".inf", "inf", "-.inf", "1e400"}) {
    EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\naxes: {x: {lead_mm: " + bad + "}}\n"),
              "m.yaml:3: axes.x.lead_mm: found '" + bad + "', expected a number from 0.1 to 200");
  }
}

TEST(YamlReader, DuplicateKeysInStructsAndMaps) {
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\nname: b\naxes: {x: {lead_mm: 5}}\n"),
            "m.yaml:3: name: duplicate key, first given at m.yaml:1");
  EXPECT_EQ(OnlyError("name: a\ncycle_us: 1000\naxes:\n  x: {lead_mm: 5}\n  x: {lead_mm: 6}\n"),
            "m.yaml:5: axes.x: duplicate key, first given at m.yaml:4");
}

TEST(YamlReader, AllErrorsOfAFileAreCollected) {
  const Result r = Read("cycle_us: slow\nrequird: true\naxes: {x: {}}\n");
  ASSERT_EQ(r.errors.size(), 4U) << ::testing::PrintToString(r.errors);
  EXPECT_EQ(r.errors[0], "m.yaml:1: cycle_us: found 'slow', expected a whole number from 100 to 10000");
  EXPECT_EQ(r.errors[1],
            "m.yaml:3: axes.x.lead_mm: missing, expected a number from 0.1 to 200: travel per turn");
  EXPECT_EQ(r.errors[2], "m.yaml:2: requird: unknown key; did you mean required?");
  EXPECT_EQ(r.errors[3], "m.yaml:1: name: missing, expected text: the name");
}

TEST(YamlOverride, ReplacesAndAdds) {
  const Result r =
      Read(kGood, {"cycle_us=2000", "axes.x.backlash_um=3", "axes.y={lead_mm: 10}", "side=motor"});
  EXPECT_TRUE(r.errors.empty()) << ::testing::PrintToString(r.errors);
  EXPECT_EQ(r.machine.cycle_us, 2000);
  EXPECT_EQ(r.machine.axes.at("x").backlash_um, 3.0);
  EXPECT_EQ(r.machine.axes.at("y").lead_mm, 10.0);
  EXPECT_EQ(r.machine.side, Side::kMotor);
}

TEST(YamlOverride, ErrorsNameTheOption) {
  EXPECT_EQ(OnlyError(kGood, {"axes.x.lead_mm=0"}),
            "--set axes.x.lead_mm=0: axes.x.lead_mm: found '0', expected a number from 0.1 to 200");
  EXPECT_EQ(OnlyError(kGood, {"axes.x.leed_mm=5"}),
            "--set axes.x.leed_mm=5: axes.x.leed_mm: unknown key; did you mean lead_mm?");
}

std::string Thrown(const std::string& text, const std::string& assignment) {
  YamlValue root = ParseYamlText(text, "m.yaml");
  try {
    ApplyOverride(root, assignment);
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "nothing thrown";
}

TEST(YamlOverride, MalformedAssignments) {
  EXPECT_EQ(Thrown(kGood, "cycle_us"),
            "--set cycle_us: expected a dotted key and a value, as in --set machine.cycle_us=2000");
  EXPECT_EQ(Thrown(kGood, "axes..lead_mm=3"), "--set axes..lead_mm=3: found an empty part in the key");
  EXPECT_EQ(Thrown(kGood, "name.first=3"),
            "--set name.first=3: name (m.yaml:1) is 'xy', so it has no key first");
}

std::string ParseError(const std::string& text) {
  try {
    ParseYamlText(text, "m.yaml");
  } catch (const ConfigError& e) {
    return e.what();
  }
  return "nothing thrown";
}

TEST(YamlTree, NotYamlHasItsLine) {
  EXPECT_EQ(ParseError("name: a\naxes: {x: [\n"), "m.yaml:3: not YAML: end of sequence flow not found");
  EXPECT_NE(ParseError("\xff\xfe\x01"), "nothing thrown");
  EXPECT_NE(ParseError("a: b: c\n").find("m.yaml:1: not YAML:"), std::string::npos);
}

TEST(YamlTree, TopMustBeAMapAndTheOnlyDocument) {
  EXPECT_EQ(ParseError("just words\n"), "m.yaml:1: found 'just words' at the top, expected a map of keys");
  EXPECT_EQ(ParseError(""), "m.yaml: found nothing at the top, expected a map of keys");
  EXPECT_EQ(ParseError("- 1\n- 2\n"), "m.yaml:1: found a list of 2 at the top, expected a map of keys");
  EXPECT_EQ(ParseError("a: 1\n---\nb: 2\n"), "m.yaml: found more than one YAML document, expected one");
}

TEST(YamlTree, AliasesThatMultiplyAreStopped) {
  std::ostringstream text;
  text << "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 10; ++i) {
    text << "a" << i << ": &a" << i << " [*a" << i - 1;
    for (int j = 1; j < 10; ++j) text << ", *a" << i - 1;
    text << "]\n";
  }
  EXPECT_NE(ParseError(text.str()).find("nested too deeply or too large"), std::string::npos);
}

TEST(YamlTree, UnreadableFiles) {
  const auto error = [](const std::string& path) -> std::string {
    try {
      ParseYamlFile(path);
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "nothing thrown";
  };
  EXPECT_EQ(error("/nonexistent/m.yaml"), "/nonexistent/m.yaml: cannot be read: No such file or directory");
  EXPECT_EQ(error(::testing::TempDir()), ::testing::TempDir() + ": cannot be read: Is a directory");
}

TEST(YamlTree, WhereIsFindsTheDeepestPart) {
  const YamlValue root = ParseYamlText("name: a\naxes:\n  x:\n    lead_mm: 5\n", "m.yaml");
  EXPECT_EQ(WhereIs(root, "axes.x.lead_mm"), "m.yaml:4");
  EXPECT_EQ(WhereIs(root, "axes.x.backlash_um"), "m.yaml:3");
  EXPECT_EQ(WhereIs(root, "buses"), "m.yaml:1");
}

}  // namespace
}  // namespace contour
