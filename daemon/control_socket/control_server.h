#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "daemon/control_socket/operator_desk.h"
#include "daemon/control_socket/request_handler.h"
#include "daemon/control_socket/request_worker.h"
#include "daemon/control_socket/unix_listener.h"

namespace contour {

/// Serves the operator's desk on a local Unix stream socket, lines of JSON both ways, in a thread of its own.
/// Who may open the socket may move the machine: its permissions are the access control, and nothing listens
/// on a network. Requests that wait for the cycle are carried out by a worker, in the order of their arrival,
/// and stops by another: a stop never waits behind an unanswered request, whoever made it. Sizes are bounded:
/// a client that sends an endless line or does not read its answers is dropped; rows wait in their feed,
/// which counts what it loses.
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
    std::uint64_t number = 0;
    Descriptor socket;
    std::string received;            ///< the line under way
    bool waits = false;              ///< a worker has a request of this client
    std::deque<std::string> behind;  ///< its requests after that one
    std::size_t behind_bytes = 0;
    std::size_t stops = 0;  ///< under way
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
  void CarryOut(Client& client, std::string_view line);
  void TakeReplies();
  void OnReply(std::uint64_t client, RequestClass kind, const nlohmann::json& reply);
  void Wake();
  void SendSubscribed(Client& client);
  void Send(Client& client, const nlohmann::json& message);
  void SendLine(Client& client, std::string_view line);
  void Flush(Client& client);
  void DropGoneClients();

  const Options options_;
  OperatorDesk& desk_;
  UnixListener listener_;
  Descriptor wake_;
  std::list<Client> clients_;
  std::uint64_t next_number_ = 1;
  struct Reply {
    std::uint64_t client;
    RequestClass kind;
    std::string line;
  };
  std::mutex replies_mutex_;
  std::vector<Reply> replies_;  ///< of the workers, not yet with their clients
  std::atomic<bool> ending_{false};
  RequestWorker requests_;
  RequestWorker stops_;
  std::thread thread_;
};

}  // namespace contour
