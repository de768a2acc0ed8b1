#include "daemon/control_socket/control_server.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <contour_lcm/cycle_entry.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "core/exit_status.h"
#include "daemon/control_socket/base64.h"
#include "daemon/control_socket/control_client.h"
#include "drivers/lcm/cycle_messages.h"
#include "tests/daemon/control_socket/fake_desk.h"
#include "tests/support/eventually.h"
#include "tests/support/random_cycle_entry.h"
#include "tests/support/same_cycle_entry.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

using test::Eventually;

class ControlServerTest : public ::testing::Test {
 protected:
  void SetUp() override { options_.socket = directory_ / "run" / "control.sock"; }
  void TearDown() override { server_.reset(); }
  void Serve() {
    server_ = std::make_unique<ControlServer>(options_, desk_);
    server_->Start();
  }
  mode_t Mode() const {
    struct stat found {};
    EXPECT_EQ(::stat(options_.socket.c_str(), &found), 0);
    return found.st_mode & 07777;
  }

  test::ScratchDirectory scratch_;
  const fs::path directory_ = scratch_.path();
  test::FakeDesk desk_;
  ControlServer::Options options_;
  std::unique_ptr<ControlServer> server_;
};

/// A client that says what it likes.
class RawClient {
 public:
  explicit RawClient(const fs::path& path) : socket_(ConnectUnix(path)) {}
  /// As much of it as the server takes.
  void Send(std::string_view text) {
    while (!text.empty()) {
      const ssize_t n = ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL);
      if (n <= 0) return;
      text.remove_prefix(static_cast<std::size_t>(n));
    }
  }
  void EndOfInput() { ::shutdown(socket_.get(), SHUT_WR); }
  /// One line; empty at the end of the connection.
  std::string Line() {
    std::string line;
    char c = 0;
    while (::recv(socket_.get(), &c, 1, 0) == 1) {
      if (c == '\n') return line;
      line += c;
    }
    return {};
  }

 private:
  Descriptor socket_;
};

TEST_F(ControlServerTest, TheSocketHasExactlyThePermissionsAskedFor) {
  const mode_t before = ::umask(0);
  for (const mode_t umask : {0u, 022u, 077u}) {
    ::umask(umask);
    options_.mode = 0660;
    Serve();
    EXPECT_EQ(Mode(), 0660u);
    server_.reset();
    options_.mode = 0600;
    Serve();
    EXPECT_EQ(Mode(), 0600u);
    server_.reset();
  }
  ::umask(before);
  EXPECT_FALSE(fs::exists(options_.socket)) << "it goes with its daemon";
}

TEST_F(ControlServerTest, ASecondDaemonIsRefusedAndALeftOverSocketReplaced) {
  Serve();
  EXPECT_THROW(ControlServer(options_, desk_), EnvironmentError);
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "status"}})["ok"], true);
  // What a killed daemon leaves behind: a bound socket that nobody listens on.
  const fs::path left = directory_ / "run" / "left.sock";
  fs::rename(options_.socket, left);
  server_.reset();
  options_.socket = left;
  ASSERT_TRUE(fs::exists(left));
  Serve();
  EXPECT_EQ(ControlClient(left).Ask({{"request", "status"}})["ok"], true);
}

TEST_F(ControlServerTest, AFileThatIsNoSocketIsLeftAlone) {
  fs::create_directories(options_.socket.parent_path());
  std::ofstream(options_.socket) << "precious";
  EXPECT_THROW(ControlServer(options_, desk_), EnvironmentError);
  EXPECT_TRUE(fs::is_regular_file(options_.socket));
}

TEST_F(ControlServerTest, PathsThatCannotBeAreNamed) {
  options_.socket = directory_ / std::string(200, 'a');
  try {
    ControlServer server(options_, desk_);
    FAIL();
  } catch (const EnvironmentError& e) {
    EXPECT_NE(std::string(e.what()).find("longer than"), std::string::npos);
  }
  EXPECT_THROW(ControlClient(directory_ / "nobody.sock"), EnvironmentError);
}

TEST_F(ControlServerTest, AStopWaitsBehindNoUnansweredRequest) {
  Serve();
  desk_.Hold(true);
  RawClient first(options_.socket);
  first.Send("{\"request\": \"enable\", \"id\": 1}\n{\"request\": \"reset\", \"id\": 2}\n");
  ASSERT_TRUE(Eventually([this] { return !desk_.asked().empty(); }));
  // The enabling is held until this very test lets it go: whoever waited for it would wait for ever.
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "stop"}})["ok"], true) << "of a second client";
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "status"}})["ok"], true);
  first.Send("{\"request\": \"stop\", \"id\": 3}\n");
  EXPECT_EQ(json::parse(first.Line())["id"], 3) << "of the same client";
  EXPECT_EQ(desk_.asked(), (std::vector<std::string>{"enable", "stop", "stop"}))
      << "the rest keeps its order";
  desk_.Hold(false);
  EXPECT_EQ(json::parse(first.Line())["id"], 1);
  EXPECT_EQ(json::parse(first.Line())["id"], 2);
  EXPECT_EQ(desk_.asked().back(), "reset");
}

TEST_F(ControlServerTest, WhoeverIsBeingAnsweredAtTheEndGetsTheAnswer) {
  Serve();
  desk_.Hold(true);
  RawClient client(options_.socket);
  client.Send("{\"request\": \"enable\"}\n");
  ASSERT_TRUE(Eventually([this] { return !desk_.asked().empty(); }));
  std::thread ending([this] { server_->Stop(); });
  desk_.Hold(false);
  EXPECT_EQ(json::parse(client.Line())["ok"], true);
  ending.join();
}

TEST_F(ControlServerTest, ServesSeveralClientsAtOnce) {
  Serve();
  ControlClient a(options_.socket);
  ControlClient b(options_.socket);
  EXPECT_EQ(a.Ask({{"request", "enable"}})["ok"], true);
  EXPECT_EQ(b.Ask({{"request", "stop"}})["ok"], true);
  EXPECT_EQ(a.Ask({{"request", "status"}})["ok"], true);
  EXPECT_EQ(desk_.asked(), (std::vector<std::string>{"enable", "stop"}));
}

TEST_F(ControlServerTest, AnswersNonsenseAndGoesOn) {
  Serve();
  RawClient raw(options_.socket);
  raw.Send("\x01\xFF\xFE garbage\n\r\n{\"request\": \"fly\"}\n{\"request\": \"status\"}\n");
  EXPECT_EQ(json::parse(raw.Line())["ok"], false);
  EXPECT_EQ(json::parse(raw.Line())["ok"], false);
  EXPECT_EQ(json::parse(raw.Line())["ok"], true);
}

TEST_F(ControlServerTest, TakesARequestByteByByteAndManyInOnePiece) {
  Serve();
  RawClient raw(options_.socket);
  for (const char c : std::string("{\"request\": \"status\"}\n")) raw.Send(std::string(1, c));
  EXPECT_EQ(json::parse(raw.Line())["ok"], true);
  std::string many;
  for (int i = 0; i < 500; ++i) many += "{\"id\": " + std::to_string(i) + ", \"request\": \"status\"}\n";
  std::thread sender([&] { raw.Send(many); });
  for (int i = 0; i < 500; ++i) ASSERT_EQ(json::parse(raw.Line())["id"], i);
  sender.join();
}

TEST_F(ControlServerTest, AnEndlessLineIsRefusedAndItsClientDropped) {
  options_.max_line_bytes = 100'000;
  Serve();
  RawClient raw(options_.socket);
  std::thread sender([&] { raw.Send(std::string(4'000'000, 'x')); });
  const std::string line = raw.Line();
  ASSERT_FALSE(line.empty());
  EXPECT_NE(json::parse(line)["error"].get<std::string>().find("100000"), std::string::npos);
  EXPECT_EQ(raw.Line(), "");
  sender.join();
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "status"}})["ok"], true);
}

TEST_F(ControlServerTest, AClientThatNeverReadsIsNotListenedToAndHoldsNobodyUp) {
  Serve();
  RawClient deaf(options_.socket);
  constexpr int kAsked = 100'000;
  std::thread sender([&] {
    std::string requests;
    for (int i = 0; i < kAsked; ++i) requests += "{\"request\": \"status\"}\n";
    deaf.Send(requests);  // ends when the server is gone: it is not listened to, and not waited for
  });
  // Under its flood.
  ASSERT_TRUE(Eventually([this] { return desk_.statuses() > 10; }));
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "stop"}})["ok"], true);
  // As many answers as may wait for it here and in the kernel; each is more than 500 bytes long.
  const int most = static_cast<int>((options_.max_unread_bytes + (4u << 20)) / 500);
  ASSERT_LT(most, kAsked);
  EXPECT_LT(desk_.statuses(), most);
  server_.reset();
  sender.join();
  EXPECT_LT(desk_.statuses(), most);
}

TEST_F(ControlServerTest, AClientThatReadsNothingForLongIsDropped) {
  options_.deaf_after = std::chrono::milliseconds(1);
  options_.max_unread_bytes = 100'000;
  Serve();
  RawClient deaf(options_.socket);
  std::string requests;
  for (int i = 0; i < 20'000; ++i) requests += "{\"request\": \"status\"}\n";
  deaf.Send(requests);  // returns when the server has hung up
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "stop"}})["ok"], true);
}

TEST_F(ControlServerTest, WhenAllPlacesAreTakenAStopADisableAndTheStatusAreStillToBeHad) {
  options_.max_clients = 2;
  options_.reserved_clients = 1;
  Serve();
  ControlClient a(options_.socket);
  ControlClient b(options_.socket);
  EXPECT_EQ(a.Ask({{"request", "status"}})["ok"], true);
  EXPECT_EQ(b.Ask({{"request", "status"}})["ok"], true);
  {
    ControlClient c(options_.socket);
    const json refused = c.Ask({{"request", "enable"}});
    EXPECT_EQ(refused["ok"], false);
    EXPECT_NE(refused["error"].get<std::string>().find("2 clients already"), std::string::npos);
    for (const char* request : {"status", "stop", "disable"})
      EXPECT_EQ(c.Ask({{"request", request}})["ok"], true) << request;
  }
  // Idle clients in the reserved places do not keep others out of them.
  RawClient idle(options_.socket);
  RawClient idle_too(options_.socket);
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "stop"}})["ok"], true);
  EXPECT_EQ(a.Ask({{"request", "status"}})["ok"], true) << "nobody lost a place";
  EXPECT_EQ(desk_.asked(), (std::vector<std::string>{"stop", "disable", "stop"}));
}

TEST_F(ControlServerTest, APlaceThatHasBecomeFreeGoesToWhoeverWaitsForIt) {
  options_.max_clients = 1;
  Serve();
  auto a = std::make_unique<ControlClient>(options_.socket);
  EXPECT_EQ(a->Ask({{"request", "status"}})["ok"], true);
  ControlClient b(options_.socket);
  EXPECT_EQ(b.Ask({{"request", "enable"}})["ok"], false);
  a.reset();
  EXPECT_TRUE(Eventually([&] { return b.Ask({{"request", "enable"}})["ok"] == true; }));
}

// What follows holds an enabling until the test lets it go, and has a client collect rows so that the test
// sees when the server has noticed its end.

TEST_F(ControlServerTest, WhatTheCycleHasNotBeenHandedIsDroppedWithItsClient) {
  Serve();
  desk_.Hold(true);
  RawClient first(options_.socket);
  first.Send("{\"request\": \"enable\", \"id\": 1}\n");
  ASSERT_TRUE(Eventually([this] { return !desk_.asked().empty(); }));
  {
    RawClient second(options_.socket);
    second.Send(
        "{\"request\": \"rows\", \"on\": true}\n{\"request\": \"enable\"}\n{\"request\": \"reset\"}\n");
    ASSERT_TRUE(Eventually([this] { return desk_.feeds() == 1; }));
  }
  ASSERT_TRUE(Eventually([this] { return desk_.feeds() == 0; }));
  desk_.Hold(false);
  EXPECT_EQ(json::parse(first.Line())["id"], 1);
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "reload"}})["ok"], true) << "behind all others";
  EXPECT_EQ(desk_.asked(), (std::vector<std::string>{"enable", "reload"}));
}

TEST_F(ControlServerTest, TheDeskIsToldThatWhoeverAskedIsGone) {
  Serve();
  desk_.Hold(true);
  {
    RawClient client(options_.socket);
    client.Send("{\"request\": \"rows\", \"on\": true}\n{\"request\": \"enable\"}\n");
    ASSERT_TRUE(Eventually([this] { return !desk_.asked().empty(); }));
  }
  ASSERT_TRUE(Eventually([this] { return desk_.feeds() == 0; }));
  desk_.Hold(false);
  EXPECT_TRUE(Eventually([this] { return desk_.asked().back() == "enable was unwanted"; }));
}

TEST_F(ControlServerTest, AStopOrDisableIsCarriedOutAlthoughItsClientIsGone) {
  Serve();
  desk_.Hold(true);
  for (const char* request : {"stop", "disable"}) {
    // Behind an enabling that has no answer and never gets one.
    RawClient client(options_.socket);
    client.Send("{\"request\": \"enable\"}\n{\"request\": \"" + std::string(request) + "\"}\n");
  }
  const auto asked = [this](const char* what) {
    const std::vector<std::string> all = desk_.asked();
    return std::find(all.begin(), all.end(), what) != all.end();
  };
  EXPECT_TRUE(Eventually([&] { return asked("stop") && asked("disable"); }));
  desk_.Hold(false);
}

TEST_F(ControlServerTest, AMachineThatIsAttendedDoesNotGoOnWithoutItsClient) {
  Serve();
  {
    ControlClient seen(options_.socket), over(options_.socket);
    ASSERT_EQ(seen.Ask({{"request", "status"}})["ok"], true);
    for (const bool on : {true, false}) ASSERT_EQ(over.Ask({{"request", "attend"}, {"on", on}})["ok"], true);
  }
  {
    ControlClient attends(options_.socket);
    ASSERT_EQ(attends.Ask({{"request", "attend"}, {"on", true}})["ok"], true);
    ASSERT_EQ(attends.Ask({{"request", "enable"}})["ok"], true);
  }
  const auto both = [](const std::vector<std::string>& asked) {
    return std::ranges::count(asked, "disable") == 1 && std::ranges::count(asked, "abandoned") == 1;
  };
  EXPECT_TRUE(Eventually([&] { return both(desk_.asked()); }));
  EXPECT_EQ(desk_.asked().size(), 3u) << "and of the others nothing comes";
  EXPECT_EQ(desk_.asked().front(), "enable");
}

// The daemon's own end is no end of a client.
TEST_F(ControlServerTest, AnEndOfTheServerAsksForNothing) {
  Serve();
  ControlClient attends(options_.socket);
  ASSERT_EQ(attends.Ask({{"request", "attend"}, {"on", true}})["ok"], true);
  server_.reset();
  EXPECT_TRUE(desk_.asked().empty());
}

TEST_F(ControlServerTest, AStopMakesVoidWhatWouldLeadToMotionAndHasNotBeenHandedOver) {
  Serve();
  desk_.Hold(true);
  RawClient first(options_.socket);
  RawClient second(options_.socket);
  first.Send("{\"request\": \"enable\", \"id\": 1}\n{\"request\": \"enable\", \"id\": 2}\n");
  ASSERT_TRUE(Eventually([this] { return !desk_.asked().empty(); }));
  second.Send("{\"request\": \"enable\", \"id\": 3}\n");
  // The socket's thread takes one request of each in a turn: with this answer the one before has had its
  // turn.
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "status"}})["ok"], true);
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "stop"}})["ok"], true);
  const json refused = json::parse(second.Line());
  EXPECT_EQ(refused["id"], 3);
  EXPECT_EQ(refused["ok"], false);
  EXPECT_NE(refused["error"].get<std::string>().find("a stop came first"), std::string::npos);
  first.Send("{\"request\": \"stop\", \"id\": 4}\n");
  EXPECT_EQ(json::parse(first.Line())["id"], 2) << "behind the one under way, before the stop";
  EXPECT_EQ(json::parse(first.Line())["id"], 4);
  desk_.Hold(false);
  EXPECT_EQ(json::parse(first.Line())["id"], 1);
  EXPECT_EQ(desk_.asked(), (std::vector<std::string>{"enable", "stop", "stop", "enable was unwanted"}));
}

TEST_F(ControlServerTest, AClientThatSendsNothingMoreStillGetsItsAnswers) {
  Serve();
  RawClient client(options_.socket);
  client.Send("{\"request\": \"status\"}\n{\"request\": \"enable\"}\n");
  client.EndOfInput();
  EXPECT_TRUE(json::parse(client.Line()).contains("status"));
  EXPECT_EQ(json::parse(client.Line())["sequence"], 1);
  EXPECT_EQ(client.Line(), "") << "and is then dropped";
}

TEST_F(ControlServerTest, AProgramOfAnySizeComesInPieces) {
  Serve();
  ControlClient client(options_.socket);
  std::string program;
  for (int line = 0; program.size() < 3'000'000; ++line) program += "G1 X" + std::to_string(line) + "\n";
  const auto upload = [&](const std::string& text) {
    bool first = true;
    json reply;
    for (std::size_t at = 0; at < text.size(); at += 8000, first = false)
      reply = client.Ask({{"request", "upload"}, {"text", text.substr(at, 8000)}, {"first", first}});
    return reply;
  };
  const json run{{"request", "run"}, {"name", "long.ngc"}, {"format", "ngc"}, {"uploaded", true}};
  EXPECT_EQ(client.Ask(run)["ok"], false) << "nothing has been uploaded";
  upload("something else");
  EXPECT_EQ(upload(program)["bytes"], program.size());
  EXPECT_EQ(client.Ask(run)["ok"], true);
  EXPECT_EQ(desk_.upload().text, program);
  EXPECT_EQ(desk_.upload().name, "long.ngc");
  EXPECT_EQ(client.Ask(run)["ok"], false) << "it has been used";
}

TEST_F(ControlServerTest, ProgramsInPiecesAreBoundedForAllClientsTogether) {
  options_.max_upload_bytes = 100'000;
  Serve();
  ControlClient a(options_.socket);
  auto b = std::make_unique<ControlClient>(options_.socket);
  const json piece{{"request", "upload"}, {"text", std::string(40'000, 'x')}};
  EXPECT_EQ(a.Ask(piece)["ok"], true);
  EXPECT_EQ(b->Ask(piece)["ok"], true);
  const json refused = a.Ask(piece);
  EXPECT_EQ(refused["ok"], false);
  EXPECT_NE(refused["error"].get<std::string>().find("100000 bytes"), std::string::npos) << refused;
  EXPECT_EQ(a.Ask(piece)["bytes"], 40'000) << "what had come before is given up";
  b.reset();
  EXPECT_TRUE(Eventually([&] { return a.Ask(piece)["bytes"] == 80'000; }));
}

TEST_F(ControlServerTest, SomeClientsMayCollectRowsAndNotAll) {
  options_.max_row_clients = 1;
  Serve();
  ControlClient a(options_.socket);
  ControlClient b(options_.socket);
  EXPECT_EQ(a.Ask({{"request", "rows"}, {"on", true}})["ok"], true);
  EXPECT_EQ(b.Ask({{"request", "rows"}, {"on", true}})["ok"], false);
  EXPECT_EQ(a.Ask({{"request", "rows"}, {"on", false}})["ok"], true);
  EXPECT_EQ(b.Ask({{"request", "rows"}, {"on", true}})["ok"], true);
}

TEST_F(ControlServerTest, StreamsRowsBitForBitToThoseWhoAsk) {
  Serve();
  ControlClient client(options_.socket);
  std::vector<CycleEntry> got;
  client.OnMessage([&](const json& message) {
    for (const json& row : message.at("rows")) {
      contour_lcm::cycle_entry m{};
      ASSERT_TRUE(Decode(FromBase64(row.get<std::string>()).value(), m));
      ASSERT_TRUE(FromMessage(m, got.emplace_back()));
    }
    EXPECT_EQ(message.at("lost"), 0);
  });
  client.Ask({{"request", "rows"}, {"on", true}});
  ASSERT_TRUE(Eventually([&] { return desk_.feeds() == 1; }));
  test::RandomCycleEntry random(9);
  std::vector<CycleEntry> sent;
  for (std::uint64_t cycle = 1; cycle <= 300; ++cycle) {
    sent.push_back(random.Next(cycle, 2));
    desk_.Push(sent.back());
  }
  for (int i = 0; i < 300 && got.size() < sent.size(); ++i) client.Listen(std::chrono::seconds(10));
  ASSERT_EQ(got.size(), sent.size());
  for (std::size_t i = 0; i < sent.size(); ++i) {
    test::ExpectSame(sent[i].output.record, got[i].output.record);
    test::ExpectSame(sent[i].timing, got[i].timing);
    if (HasFailure()) FAIL() << "row " << i;
  }
  client.Ask({{"request", "rows"}, {"on", false}});
  EXPECT_TRUE(Eventually([&] { return desk_.feeds() == 0; }));
}

TEST_F(ControlServerTest, AClientThatHangsUpLeavesNoFeedBehind) {
  Serve();
  {
    ControlClient client(options_.socket);
    client.Ask({{"request", "rows"}, {"on", true}});
    ASSERT_TRUE(Eventually([&] { return desk_.feeds() == 1; }));
  }
  EXPECT_TRUE(Eventually([&] { return desk_.feeds() == 0; }));
}

TEST_F(ControlServerTest, AClientTooSlowForItsRowsLosesTheNewestAndIsTold) {
  RowFeed feed(10);
  test::RandomCycleEntry random(3);
  for (std::uint64_t cycle = 1; cycle <= 25; ++cycle) feed.Push(random.Next(cycle, 1));
  EXPECT_EQ(feed.size(), 10u);
  EXPECT_EQ(feed.lost(), 15u);
  contour_lcm::cycle_entry m{};
  ASSERT_TRUE(Decode(feed.Pop().value(), m));
  EXPECT_EQ(m.status.cycle, 1);
  EXPECT_TRUE(m.input.frames.empty());
}

TEST_F(ControlServerTest, WatchSendsTheStatusAgainAndAgain) {
  MachineStatus status;
  status.machine = "watched";
  desk_.SetStatus(status);
  Serve();
  ControlClient client(options_.socket);
  int seen = 0;
  client.OnMessage([&](const json& message) {
    EXPECT_EQ(message.at("watch").at("machine"), "watched");
    ++seen;
  });
  client.Ask({{"request", "watch"}, {"period_ms", 20}});
  for (int i = 0; i < 3; ++i) client.Listen(std::chrono::seconds(30));
  EXPECT_EQ(seen, 3);
}

TEST_F(ControlServerTest, ClientsNoticeThatTheDaemonIsGone) {
  Serve();
  ControlClient client(options_.socket);
  EXPECT_EQ(client.Ask({{"request", "status"}})["ok"], true);
  server_.reset();
  EXPECT_THROW(client.Ask({{"request", "status"}}), ConnectionLost);
}

}  // namespace
}  // namespace contour
