#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "daemon/control_socket/operator_desk.h"
#include "daemon/control_socket/request_handler.h"
#include "daemon/control_socket/unix_listener.h"

namespace contour {

/// Serves the operator's desk on a local Unix stream socket, lines of JSON both ways, in a thread of its own.
/// Who may open the socket may move the machine: its permissions are the access control, and nothing listens
/// on a network. Sizes are bounded: a client that sends an endless line or does not read its answers is
/// dropped; rows wait in their feed, which counts what it loses.
class ControlServer {
 public:
  struct Options {
    std::filesystem::path socket;
    mode_t mode = 0660;
    std::size_t max_clients = 16;
    std::size_t max_line_bytes = 8u << 20;
    std::size_t max_unread_bytes = 16u << 20;
  };

  /// Makes the socket; throws EnvironmentError. Clients are served from Start() on.
  ControlServer(Options options, OperatorDesk& desk);
  ~ControlServer();
  ControlServer(const ControlServer&) = delete;
  ControlServer& operator=(const ControlServer&) = delete;

  void Start();
  void Stop();

 private:
  struct Client {
    Descriptor socket;
    std::string received;  ///< the line under way
    std::string unsent;
    Subscriptions subscriptions;
    std::shared_ptr<RowFeed> feed;
    std::chrono::steady_clock::time_point next_watch{};
    bool closing = false;  ///< once unsent is sent
    bool gone = false;
  };

  void Serve();
  [[nodiscard]] int PollTimeout_ms() const;
  void AcceptClients();
  void Receive(Client& client);
  void TakeLines(Client& client);
  void OnLine(Client& client, std::string_view line);
  void SendSubscribed(Client& client);
  void Send(Client& client, const nlohmann::json& message);
  void Flush(Client& client);
  void DropGoneClients();

  const Options options_;
  OperatorDesk& desk_;
  UnixListener listener_;
  Descriptor wake_;
  std::list<Client> clients_;
  std::thread thread_;
};

}  // namespace contour
