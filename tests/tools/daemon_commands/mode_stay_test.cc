#include "tools/contour/mode_stay.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <stop_token>
#include <thread>

#include "config/load_machine.h"
#include "config/yaml_writer.h"
#include "daemon/control_socket/unix_listener.h"
#include "tests/support/scratch_directory.h"

namespace contour {
namespace {

using nlohmann::json;

/// A daemon that ends and begins anew when it is asked for a mode: with `machine`, whatever was asked for.
class FakeDaemon {
 public:
  FakeDaemon(const std::filesystem::path& path, const MachineConfig& machine)
      : listener_(path, 0600), machine_(WriteYaml(machine)), thread_([this](const std::stop_token& stop) {
          while (!stop.stop_requested()) Serve(stop);
        }) {}

  [[nodiscard]] bool attended() const { return attended_; }

 private:
  static bool Readable(int fd) {
    pollfd one{fd, POLLIN, 0};
    return ::poll(&one, 1, 10) > 0;
  }

  void Serve(const std::stop_token& stop) {
    if (!Readable(listener_.get())) return;
    const Descriptor client = listener_.Accept();
    std::string text;
    while (client.get() >= 0 && !stop.stop_requested()) {
      if (!Readable(client.get())) continue;
      std::array<char, 4096> piece{};
      const ssize_t size = ::recv(client.get(), piece.data(), piece.size(), 0);
      if (size <= 0) return;
      text.append(piece.data(), static_cast<std::size_t>(size));
      for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n')) {
        const json request = json::parse(text.substr(0, end));
        text.erase(0, end + 1);
        if (request.at("request") == "attend") attended_ = request.at("on").get<bool>();
        const std::string answer = Answer(request).dump() + "\n";
        ::send(client.get(), answer.data(), answer.size(), MSG_NOSIGNAL);
        if (request.at("request") == "torque_mode" || request.at("request") == "csp_mode") return;
      }
    }
  }

  [[nodiscard]] json Answer(const json& request) const {
    json answer{{"id", request.at("id")}, {"ok", true}};
    if (request.at("request") == "status") answer["status"] = {{"state", "Idle"}, {"reason_text", ""}};
    if (request.at("request") == "machine_file") answer["yaml"] = machine_;
    return answer;
  }

  UnixListener listener_;
  std::string machine_;
  std::atomic<bool> attended_ = false;
  std::jthread thread_;
};

class ModeStayTest : public ::testing::Test {
 protected:
  /// Whether torque mode with these loops is entered where contourd then runs `machine`.
  bool TorqueMode(const MachineConfig& machine, const std::map<std::string, LoopTuning>& loops) {
    const FakeDaemon daemon(path_, machine);
    auto client = std::make_unique<ControlClient>(path_);
    const bool entered = ModeStay(client, path_).EnterTorqueMode(loops, {});
    EXPECT_EQ(daemon.attended(), entered) << "in no other mode its end is nobody's loss";
    return entered;
  }
  bool Csp(const MachineConfig& machine) {
    const FakeDaemon daemon(path_, machine);
    auto client = std::make_unique<ControlClient>(path_);
    const bool entered = ModeStay(client, path_).EnterCsp();
    EXPECT_EQ(daemon.attended(), entered);
    return entered;
  }

  test::ScratchDirectory scratch_;
  const std::filesystem::path path_ = scratch_.path() / "control.sock";
  MachineConfig machine_ = LoadMachine(std::string(CONTOUR_CONFIG_DIR) + "/single_axis.yaml");
};

// Drives that did not come up at once, and then in the machine file's own torque mode: its loop is not the
// one that the axis was to be shaken with.
TEST_F(ModeStayTest, TheMachineFilesOwnTorqueModeIsNotTheOneThatWasAskedFor) {
  ASSERT_EQ(machine_.axes.at("x").drive.mode, DriveMode::kCst);
  LoopTuning slower = machine_.axes.at("x").loop.value();
  slower.regulator_Hz *= 0.99;
  EXPECT_FALSE(TorqueMode(machine_, {{"x", slower}}));
  machine_.axes.at("x").loop = slower;
  EXPECT_TRUE(TorqueMode(machine_, {{"x", slower}}));
  machine_.axes.at("x").drive.mode = DriveMode::kCsp;
  EXPECT_FALSE(TorqueMode(machine_, {{"x", slower}}));
}

TEST_F(ModeStayTest, CspIsThereWhereAllDrivesHaveIt) {
  EXPECT_FALSE(Csp(machine_));
  machine_.axes.at("x").drive.mode = DriveMode::kCsp;
  EXPECT_TRUE(Csp(machine_));
}

}  // namespace
}  // namespace contour
