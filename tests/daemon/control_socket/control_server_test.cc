#include "daemon/control_socket/control_server.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <contour_lcm/cycle_entry.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
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
#include "tests/support/random_cycle_entry.h"
#include "tests/support/same_cycle_entry.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

bool Eventually(const std::function<bool()>& so) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (!so()) {
    if (std::chrono::steady_clock::now() > limit) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

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

TEST_F(ControlServerTest, AClientThatNeverReadsIsDroppedAndHoldsNobodyUp) {
  options_.max_unread_bytes = 200'000;
  Serve();
  RawClient deaf(options_.socket);
  std::thread sender([&] {
    std::string requests;
    for (int i = 0; i < 20'000; ++i) requests += "{\"request\": \"status\"}\n";
    deaf.Send(requests);
  });
  sender.join();  // it ends: the server reads on or hangs up
  EXPECT_EQ(ControlClient(options_.socket).Ask({{"request", "stop"}})["ok"], true);
}

TEST_F(ControlServerTest, TooManyClientsAreTurnedAway) {
  options_.max_clients = 2;
  Serve();
  ControlClient a(options_.socket);
  ControlClient b(options_.socket);
  EXPECT_EQ(a.Ask({{"request", "status"}})["ok"], true);
  EXPECT_EQ(b.Ask({{"request", "status"}})["ok"], true);
  RawClient c(options_.socket);
  EXPECT_EQ(json::parse(c.Line())["ok"], false);
  EXPECT_EQ(c.Line(), "");
  EXPECT_EQ(a.Ask({{"request", "status"}})["ok"], true);
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
