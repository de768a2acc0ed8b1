#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <stop_token>
#include <string>
#include <thread>

#include "daemon/control_socket/operator_desk.h"
#include "daemon/control_socket/program_upload.h"

namespace contour {

/// Carries out requests that wait for the cycle, one after the other, in a thread of its own, so that the
/// thread that serves the socket never waits.
class RequestWorker {
 public:
  struct Request {
    std::uint64_t client = 0;
    std::string line;
    bool leads_to_motion = false;             ///< a stop makes it void
    std::shared_ptr<UploadedText> program{};  ///< of a run whose program came in pieces
    bool abandoned = false;                   ///< no line: the client attended the machine, and is gone
  };
  /// Called with the number that the request came with, in the worker's thread or that of StopCame().
  using Done = std::function<void(std::uint64_t client, const nlohmann::json& reply)>;

  RequestWorker(OperatorDesk& desk, Done done);
  ~RequestWorker();
  RequestWorker(const RequestWorker&) = delete;
  RequestWorker& operator=(const RequestWorker&) = delete;

  void Start();
  /// Ends when the request under way has its answer; those behind it get none.
  void Stop();
  void Take(Request request);
  /// The client has gone: what the cycle has not been handed yet is dropped.
  void Drop(std::uint64_t client);
  /// What was to lead to motion and the cycle has not been handed yet is refused.
  void StopCame();

 private:
  void Work();

  OperatorDesk& desk_;
  const Done done_;
  std::mutex mutex_;  // guards all below
  std::condition_variable wake_;
  std::deque<Request> requests_;
  std::uint64_t client_ = 0;  ///< of the request under way; 0 none
  bool motion_ = false;       ///< it leads there
  std::stop_source unwanted_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace contour
