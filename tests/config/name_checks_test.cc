#include "config/name_checks.h"

#include <gtest/gtest.h>

#include <string>

#include "config/config_error.h"
#include "config/load_machine.h"
#include "tests/config/test_files.h"

namespace contour {
namespace {

MachineConfig Example() { return LoadMachine(ExampleMachine("single_axis.yaml")); }

MachineConfig WithAxis(const std::string& name) {
  MachineConfig machine = Example();
  machine.axes.emplace(name, machine.axes.begin()->second);
  return machine;
}

TEST(CheckNames, NamesOfTheExamplesAndTheirLikeAreSound) {
  for (const char* name : {"x", "Y2", "_z", "table-left", "0", "12345678901234567890123456789012"})
    EXPECT_TRUE(CheckNames(WithAxis(name)).empty()) << name;
  MachineConfig machine = Example();
  machine.machine.name = "mill.v2-left";
  EXPECT_TRUE(CheckNames(machine).empty());
}

TEST(CheckNames, WhatBreaksColumnsKeysOrFilesIsNamedWithWhatIsAllowed) {
  for (const std::string name : {"x,1", "../x", "", " ", "x.1", "-x", "x\n", "\xFF\xFE", "\xC3\xA4", "x\"",
                                 "x/y", "123456789012345678901234567890123"}) {
    const std::vector<ConfigProblem> problems = CheckNames(WithAxis(name));
    ASSERT_EQ(problems.size(), 1u) << name;
    EXPECT_EQ(problems.front().key, "axes");
    EXPECT_NE(problems.front().message.find("expected 1 to 32 of A to Z, a to z, 0 to 9, _ and -"),
              std::string::npos);
  }
  EXPECT_TRUE(CheckNames(WithAxis(std::string("x\xFF,")))
                  .front()
                  .message.starts_with("found the name 'x\\xFF,' (3 bytes), expected "));
  EXPECT_LT(CheckNames(WithAxis(std::string(300, 'x'))).front().message.size(), 200u);
}

TEST(CheckNames, TheMachineAndItsBusesHaveNamesToo) {
  for (const char* name : {"../../etc/x", "", ".hidden", "a machine"}) {
    MachineConfig machine = Example();
    machine.machine.name = name;
    const std::vector<ConfigProblem> problems = CheckNames(machine);
    ASSERT_EQ(problems.size(), 1u) << name;
    EXPECT_EQ(problems.front().key, "machine.name");
  }
  MachineConfig machine = Example();
  machine.buses.emplace("a,b", machine.buses.begin()->second);
  EXPECT_EQ(CheckNames(machine).front().key, "buses");
}

TEST(CheckNames, AFileIsRefused) {
  EXPECT_THROW(LoadMachine(ExampleMachine("single_axis.yaml"), {"machine.name=../x"}), ConfigError);
}

}  // namespace
}  // namespace contour
