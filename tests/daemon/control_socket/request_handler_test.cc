#include "daemon/control_socket/request_handler.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <stdexcept>
#include <string>

#include "tests/daemon/control_socket/fake_desk.h"

namespace contour {
namespace {

using nlohmann::json;

class RequestHandlerTest : public ::testing::Test {
 protected:
  json Ask(const std::string& line) { return Handle(line, desk_, subscriptions_); }

  test::FakeDesk desk_;
  Subscriptions subscriptions_;
};

TEST_F(RequestHandlerTest, CarriesEachRequestToTheDeskAndItsIdBack) {
  for (const char* kind : {"enable", "disable", "stop", "reset"}) {
    const json reply = Ask(json{{"id", 42}, {"request", kind}}.dump());
    EXPECT_EQ(reply["ok"], true);
    EXPECT_EQ(reply["id"], 42);
    EXPECT_EQ(desk_.asked().back(), kind);
  }
}

TEST_F(RequestHandlerTest, ARefusalComesWithItsReason) {
  desk_.Refuse("axis x is in Fault");
  const json reply = Ask(R"({"request": "enable"})");
  EXPECT_EQ(reply["ok"], false);
  EXPECT_EQ(reply["error"], "axis x is in Fault");
}

TEST_F(RequestHandlerTest, ReferenceTellsWhereEachNamedAxisStands) {
  EXPECT_EQ(Ask(R"({"request": "reference", "position_mm": {"x": 12.5, "y": -3}})")["ok"], true);
  EXPECT_EQ(desk_.referenced_mm, (std::map<std::string, double>{{"x", 12.5}, {"y", -3.0}}));
  const auto asked = desk_.asked().size();
  for (const char* wrong : {R"({"request": "reference"})", R"({"request": "reference", "position_mm": 3})",
                            R"({"request": "reference", "position_mm": {"x": "12"}})"})
    EXPECT_EQ(Ask(wrong)["ok"], false) << wrong;
  EXPECT_EQ(desk_.asked().size(), asked);
}

TEST_F(RequestHandlerTest, PauseFeedAndZeroReachTheDesk) {
  for (const char* kind : {"pause", "resume", "zero"})
    EXPECT_EQ(Ask(std::string(R"({"request": ")") + kind + "\"}")["ok"], true) << kind;
  EXPECT_EQ(Ask(R"({"request": "feed", "percent": 42.5})")["ok"], true);
  EXPECT_EQ(desk_.feed_percent(), 42.5);
  EXPECT_EQ(desk_.asked(), (std::vector<std::string>{"pause", "resume", "zero", "feed"}));
  for (const char* wrong : {R"({"request": "feed"})", R"({"request": "feed", "percent": "50"})"})
    EXPECT_EQ(Ask(wrong)["ok"], false) << wrong;
  EXPECT_EQ(desk_.asked().size(), 4u);
}

TEST_F(RequestHandlerTest, RunUploadsTheProgram) {
  const json reply =
      Ask(R"({"request": "run", "name": "a.yaml", "format": "yaml", "text": "shape: circle\n"})");
  EXPECT_EQ(reply["ok"], true);
  EXPECT_EQ(reply["program_id"], 7);
  EXPECT_EQ(reply["start_m"], json::array({0.1, -0.3}));
  EXPECT_EQ(desk_.upload().name, "a.yaml");
  EXPECT_EQ(desk_.upload().text, "shape: circle\n");
  EXPECT_EQ(desk_.upload().controller, "");
  EXPECT_FALSE(desk_.upload().forget);
  EXPECT_EQ(reply["learnt_passes"], 0);
  EXPECT_EQ(
      Ask(R"({"request": "run", "name": "a.yaml", "format": "yaml", "text": "", "forget": true})")["ok"],
      true);
  EXPECT_TRUE(desk_.upload().forget);
  EXPECT_FALSE(desk_.upload().from_here);
  EXPECT_EQ(
      Ask(R"({"request": "run", "name": "a.yaml", "format": "yaml", "text": "", "from_here": true})")["ok"],
      true);
  EXPECT_TRUE(desk_.upload().from_here);
}

TEST_F(RequestHandlerTest, WhatMakesNoSenseIsAnsweredWithAnErrorAndNeverReachesTheDesk) {
  for (const char* line : {"",
                           "{",
                           "enable",
                           "[]",
                           "42",
                           "null",
                           "\"status\"",
                           "{}",
                           R"({"request": 5})",
                           R"({"request": "fly"})",
                           R"({"request": "run"})",
                           R"({"request": "run", "name": "a", "format": "pdf", "text": ""})",
                           R"({"request": "run", "name": 1, "format": "yaml", "text": ""})",
                           R"({"request": "run", "name": "a", "format": "yaml", "text": "", "forget": 1})",
                           R"({"request": "torque_mode"})",
                           R"({"request": "torque_mode", "loops": []})",
                           R"({"request": "torque_mode", "loops": {"x": 5}})",
                           R"({"request": "torque_mode", "loops": {}, "models": 1})",
                           R"({"request": "rows"})",
                           R"({"request": "rows", "on": "yes"})",
                           R"({"request": "watch", "period_ms": 1})",
                           R"({"request": "watch", "period_ms": 1e300})",
                           R"({"request": "watch", "period_ms": null})"}) {
    const json reply = Ask(line);
    EXPECT_EQ(reply["ok"], false) << line;
    EXPECT_TRUE(reply["error"].is_string()) << line;
  }
  EXPECT_TRUE(desk_.asked().empty());
  EXPECT_FALSE(subscriptions_.rows);
  EXPECT_FALSE(subscriptions_.watch_period_ms);
}

TEST_F(RequestHandlerTest, AKeyThatIsUnknownOrThereTwiceIsRefused) {
  EXPECT_NE(
      Ask(R"({"request": "run", "name": "a", "format": "yaml", "text": "", "form_here": true})")["error"]
          .get<std::string>()
          .find("unknown key \"form_here\""),
      std::string::npos);
  EXPECT_EQ(Ask(R"({"request": "enable", "foo": 1})")["ok"], false);
  EXPECT_EQ(Ask(R"({"request": "status", "request": "enable"})")["error"],
            "\"request\" is there more than once");
  EXPECT_TRUE(desk_.asked().empty());
  // Nothing keeps anybody from stopping.
  EXPECT_EQ(Ask(R"({"request": "stop", "foo": 1})")["ok"], true);
  EXPECT_EQ(Ask(R"({"request": "disable", "foo": 1})")["ok"], true);
  EXPECT_EQ(Ask(R"({"request": "stop", "id": 1, "id": 2})")["ok"], true);
  // The same name in two of its objects is none of the request's own.
  EXPECT_EQ(Ask(R"({"request": "torque_mode", "loops": {"x": "a: 1"}, "models": {"x": "b: 2"}})")["ok"],
            true);
}

TEST_F(RequestHandlerTest, AModelIsItsKeysAndNoNameOfAFile) {
  EXPECT_EQ(Ask(R"({"request": "load_model", "axis": "x", "model": "/etc/passwd"})")["ok"], false);
  EXPECT_TRUE(desk_.asked().empty());
  EXPECT_EQ(Ask(R"({"request": "load_model", "axis": "x", "model": "lead_mm: 5"})")["ok"], true);
  EXPECT_EQ(Ask(R"({"request": "load_model", "axis": "x", "model": ""})")["ok"], true);
  EXPECT_EQ(Ask(R"({"request": "load_model", "axis": "x", "model": "{\"lead_mm\":5}"})")["ok"], true);
}

TEST_F(RequestHandlerTest, TorqueModeHasALoopForEachAxisAndModelsWhereTheyAreOthers) {
  EXPECT_EQ(Ask(R"({"request": "torque_mode", "loops": {"x": "a: 1", "y": "a: 2"}, "models": {"y": "b: 3"}})")
                ["ok"],
            true);
  EXPECT_EQ(desk_.torque_loops, (std::map<std::string, std::string>{{"x", "a: 1"}, {"y", "a: 2"}}));
  EXPECT_EQ(desk_.torque_models, (std::map<std::string, std::string>{{"y", "b: 3"}}));
  EXPECT_EQ(Ask(R"({"request": "torque_mode", "loops": {}})")["ok"], true);
  EXPECT_TRUE(desk_.torque_loops.empty());
  EXPECT_TRUE(desk_.torque_models.empty());
}

TEST_F(RequestHandlerTest, CspNeedsNothingElse) {
  EXPECT_EQ(Ask(R"({"request": "csp_mode"})")["ok"], true);
  EXPECT_EQ(Ask(R"({"request": "csp_mode", "loops": {}})")["ok"], false);
  EXPECT_EQ(desk_.asked(), (std::vector<std::string>{"csp_mode"}));
}

TEST_F(RequestHandlerTest, SurvivesNoise) {
  std::mt19937 random(1);
  const std::string seed = R"({"id": 1, "request": "run", "name": "a", "format": "yaml", "text": "b"})";
  for (int i = 0; i < 20000; ++i) {
    std::string line = seed;
    for (auto n = random() % 6 + 1; n > 0; --n) line[random() % line.size()] = static_cast<char>(random());
    EXPECT_TRUE(Ask(line).contains("ok"));
  }
  EXPECT_EQ(Ask(std::string(100000, '['))["ok"], false);
}

TEST_F(RequestHandlerTest, ALineOfManyLevelsIsRefusedBeforeItIsParsed) {
  // Within a text brackets are letters.
  EXPECT_EQ(Ask(R"({"request": "stop", "x": "[[[[[[[[[[\\\"[[[[[[[[[["})")["ok"], true);
  EXPECT_EQ(Ask(R"({"request": "stop", "x": [[[[[[[]]]]]]]})")["ok"], true);
  for (const std::string& line : {std::string(R"({"request": "stop", "x": [[[[[[[[]]]]]]]]})"),
                                  std::string(60'000, '['), "{\"a\":" + std::string(60'000, '{')}) {
    const json reply = Ask(line);
    EXPECT_EQ(reply["ok"], false);
    EXPECT_EQ(reply["error"], "a request has 8 levels at most");
    EXPECT_EQ(HeadOf(line).kind, RequestClass::kAtOnce);
  }
}

TEST_F(RequestHandlerTest, ALineSaysWhoAnswersIt) {
  const auto kind = [](const char* request) { return HeadOf(json{{"request", request}}.dump()).kind; };
  for (const char* at_once : {"status", "watch", "rows", "fly"})
    EXPECT_EQ(kind(at_once), std::string(at_once) == "fly" ? RequestClass::kWaits : RequestClass::kAtOnce);
  for (const char* at_once : {"pause", "resume", "feed", "zero"})
    EXPECT_EQ(HeadOf(std::string(R"({"request": ")") + at_once + "\"}").kind, RequestClass::kAtOnce)
        << at_once;
  for (const char* waits :
       {"enable", "reset", "reload", "run", "machine_file", "load_model", "torque_mode", "csp_mode"})
    EXPECT_EQ(kind(waits), RequestClass::kWaits) << waits;
  EXPECT_EQ(kind("stop"), RequestClass::kStop);
  EXPECT_EQ(kind("disable"), RequestClass::kDisable);
  EXPECT_EQ(kind("upload"), RequestClass::kUpload);
  EXPECT_TRUE(HeadOf(R"({"request": "enable"})").leads_to_motion);
  EXPECT_TRUE(HeadOf(R"({"request": "run"})").leads_to_motion);
  EXPECT_FALSE(HeadOf(R"({"request": "reset"})").leads_to_motion);
  EXPECT_EQ(HeadOf(R"({"request": 5})").kind, RequestClass::kAtOnce);
}

TEST_F(RequestHandlerTest, SubscriptionsCanBeTakenAndGivenBack) {
  Ask(R"({"request": "rows", "on": true})");
  Ask(R"({"request": "watch", "period_ms": 100})");
  EXPECT_TRUE(subscriptions_.rows);
  EXPECT_EQ(subscriptions_.watch_period_ms, 100);
  Ask(R"({"request": "rows", "on": false})");
  Ask(R"({"request": "watch"})");
  EXPECT_FALSE(subscriptions_.rows);
  EXPECT_FALSE(subscriptions_.watch_period_ms);
}

TEST_F(RequestHandlerTest, StatusTellsStateReasonAxesAndCounters) {
  MachineStatus s;
  s.machine = "xy";
  s.axis_names = {"x", "y"};
  s.record.state = MachineState::kFaulted;
  s.record.reason = Reason::kEmergencyStop;
  s.reason_text = "the emergency-stop circuit is open";
  s.record.axes.resize(2);
  s.record.axes[1].feedback.drive_state = DriveState::kFault;
  s.record.axes[1].position_m = 0.125;
  s.record.axes[0].estimate.friction_N = std::numeric_limits<double>::quiet_NaN();
  s.record.stale_cycles = 3;
  s.dropped_entries = 4;
  s.axis_facts.resize(2);
  s.axis_facts[1].limits.position_max_m = 0.2;
  s.buses.push_back({"main", "vcan0", {}});
  s.io.configured = true;
  desk_.SetStatus(s);
  const json status = Ask(R"({"request": "status"})")["status"];
  EXPECT_EQ(status["state"], "Faulted");
  EXPECT_EQ(status["reason"], "emergency_stop");
  EXPECT_EQ(status["reason_is_fault"], true);
  EXPECT_EQ(status["reason_text"], "the emergency-stop circuit is open");
  EXPECT_EQ(status["axes"][1]["drive_state"], "Fault");
  EXPECT_EQ(status["axes"][1]["position_m"], 0.125);
  EXPECT_TRUE(status["axes"][0]["friction_N"].is_null()) << "JSON has no NaN";
  EXPECT_EQ(status["axes"][1]["facts"]["position_max_m"], 0.2);
  EXPECT_EQ(status["stale_cycles"], 3);
  EXPECT_EQ(status["dropped_telemetry"], 4);
  EXPECT_TRUE(status["late_cycles"].is_null());
  EXPECT_EQ(status["buses"][0]["interface"], "vcan0");
  EXPECT_TRUE(status["io"].is_object());
  EXPECT_TRUE(status["log"].is_null());
}

}  // namespace
}  // namespace contour
