#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/visit.h"

namespace contour {

struct ContestProgram {
  std::string name;
  std::string program;
  std::int64_t passes = 1;
  std::vector<std::string> set;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("name", name, "its name in the tables");
    v.Required("program", program, "a program in YAML, as text");
    v.Optional("passes", passes, Range{1, 1000},
               "runs of it, one after the other, of which the last is scored");
    v.Optional("set", set, "assignments that belong to the program");
  }
};

struct ContestMachine {
  std::string name;
  std::vector<std::string> set;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("name", name, "its name in the tables");
    v.Optional("set", set, "assignments on top of the machine file");
  }
};

/// The part of the contest that runs by default with --short.
struct ContestSelection {
  std::vector<std::int64_t> seeds;
  std::vector<std::string> programs;
  std::vector<std::string> machines;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("seeds", seeds, kNotNegative, "seeds of the emulated machine");
    v.Required("programs", programs, "names of programs");
    v.Required("machines", machines, "names of machines");
  }
};

/// What a well-tuned controller reaches on the nominal machine: a prototype's figure to compare with.
struct ExpectedPeak {
  std::string controller;
  std::string program;
  double peak_um = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("controller", controller, "a controller");
    v.Required("program", program, "a program");
    v.Required("peak_um", peak_um, kPositive, "largest contour error at the table");
  }
};

struct TunedKey {
  std::string key;
  double min = 0.0;
  double max = 0.0;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("key", key, "dotted key of the machine file");
    v.Required("min", min, kPositive, "lowest value tried");
    v.Required("max", max, kPositive, "highest value tried");
  }
};

struct TunedController {
  std::string name;
  std::vector<TunedKey> keys;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("name", name, "a controller");
    v.Required("keys", keys, "what is tuned");
  }
};

struct TuneConfig {
  std::vector<std::int64_t> seeds;
  std::vector<ContestProgram> programs;
  std::vector<ContestMachine> machines;
  std::int64_t evaluations = 60;
  std::vector<TunedController> controllers;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("seeds", seeds, kNotNegative, "seeds that the contest does not use");
    v.Required("programs", programs, "programs that the contest does not score");
    v.Required("machines", machines, "machines tuned on");
    v.Optional("evaluations", evaluations, Range{4, 100000}, "budget of each controller");
    v.Required("controllers", controllers, "what is tuned of each controller");
  }
};

/// How a controller enters the contest, where the machine file leaves a choice.
struct ContestEntry {
  std::string controller;
  std::vector<std::string> machines;
  std::vector<std::string> set;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("controller", controller, "a controller");
    v.Optional("machines", machines, "on these machines; none given: on all");
    v.Required("set", set,
               "assignments on the machine file for its runs, as --set takes them; axes.* is every axis");
  }
};

/// config/contest.yaml.
struct ContestConfig {
  std::vector<std::string> controllers;
  std::vector<std::int64_t> seeds;
  std::vector<ContestProgram> programs;
  std::vector<ContestMachine> machines;
  std::vector<ContestEntry> entries;
  std::vector<ExpectedPeak> expected;
  ContestSelection shorter;
  TuneConfig tune;

  template <class Visitor>
  void Visit(Visitor& v) {
    v.Required("controllers", controllers, "names of controllers");
    v.Required("seeds", seeds, kNotNegative, "seeds of the emulated machine");
    v.Required("programs", programs, "what is drawn");
    v.Required("machines", machines, "on what");
    v.Optional("entries", entries, "how controllers enter, where the machine file leaves a choice");
    v.Optional("expected", expected, "figures of well-tuned controllers on the first machine");
    v.Required("short", shorter, "what --short runs");
    v.Optional("tune", tune, "what tuning runs");
  }
};

/// Throws ConfigError with all that is wrong: keys, programs that do not parse, controllers, programs or
/// machines that do not exist, seeds shared by contest and tuning.
ContestConfig LoadContest(const std::string& path);

}  // namespace contour
