#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "daemon/control_socket/operator_desk.h"
#include "daemon/control_socket/program_upload.h"
#include "daemon/control_socket/request_handler.h"
#include "daemon/control_socket/request_worker.h"
#include "daemon/control_socket/unix_listener.h"

namespace contour {

/// Serves the operator's desk on a local Unix stream socket, lines of JSON both ways, in a thread of its own.
/// Who may open the socket may move the machine: its permissions are the access control, and nothing listens
/// on a network.
///
/// Each turn of the thread takes at most one request of each client, stops of all of them first. Requests
/// that wait for the cycle are carried out by a worker, in the order of their arrival, disables by another
/// and stops by a third: a stop never waits behind an unanswered request, whoever made it, and makes void
/// what was to lead to motion and has not been handed to the cycle. So does the end of its client; a stop or
/// disable is carried out whatever becomes of the client. Where a client that attends the machine ends, its
/// torque is taken off, after a stop on the path. Everything is bounded, for each client and for all
/// together: who does not read is not listened to, and dropped when that does not end; beyond the last place
/// there are some where only the status, a stop and a disable are to be had.
class ControlServer {
 public:
  struct Options {
    std::filesystem::path socket;
    mode_t mode = 0660;
    std::size_t max_clients = 16;
    std::size_t reserved_clients = 4;  ///< beyond those, for who wants a stop
    std::size_t max_row_clients = 4;   ///< of the clients, those that collect rows
    std::size_t max_line_bytes = 64u << 10;
    std::size_t max_unread_bytes = 256u << 10;  ///< a client with more than this unread gets no more answers
    std::size_t max_upload_bytes = 64u << 20;   ///< of programs in pieces, all clients together
    std::chrono::milliseconds deaf_after{30'000};  ///< who reads nothing for so long is dropped
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
    bool reserved = false;   ///< in a place for who wants a stop
    std::string received;    ///< requests that have not had their turn, and the one under way
    std::size_t looked = 0;  ///< whole lines up to here hold no stop that could be carried out at once
    bool no_more = false;    ///< it sends nothing more, but may read
    bool waits = false;      ///< a worker has a request of this client
    std::size_t stops = 0;   ///< under way, disables as well
    std::shared_ptr<UploadedText> program;
    std::string unsent;
    std::chrono::steady_clock::time_point heard{};  ///< when it last sent something
    std::chrono::steady_clock::time_point read{};   ///< when it last read, or had nothing to read
    Subscriptions subscriptions;
    std::shared_ptr<RowFeed> feed;
    std::chrono::steady_clock::time_point next_watch{};
    bool closing = false;  ///< once unsent is sent
    bool gone = false;
  };

  void Serve();
  [[nodiscard]] int PollTimeout_ms() const;
  [[nodiscard]] bool MayHaveTurn(const Client& client) const;
  [[nodiscard]] bool HasRoom(const Client& client) const;
  void AcceptClients();
  bool MakeRoom();
  void GivePlaces();
  void Receive(Client& client);
  void HangUp(Client& client);
  void LookForStops(Client& client);
  void OnStop(Client& client, RequestClass kind, std::string line);
  void RefuseMotionBefore(Client& client, std::size_t end);
  void TakeTurn(Client& client);
  void CarryOut(Client& client, const RequestHead& head, std::string line);
  void OnPiece(Client& client, std::string_view line);
  void AnswerAtOnce(Client& client, std::string_view line);
  void TakeReplies();
  void OnReply(std::uint64_t client, RequestClass kind, const nlohmann::json& reply);
  void Wake();
  void SendSubscribed(Client& client);
  void Send(Client& client, const nlohmann::json& message);
  void Flush(Client& client);
  void DropGoneClients();
  void TakeTorqueOff(std::uint64_t client);

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
  std::shared_ptr<UploadBudget> uploads_;
  RequestWorker requests_;
  RequestWorker disables_;
  RequestWorker stops_;
  std::thread thread_;
};

}  // namespace contour
