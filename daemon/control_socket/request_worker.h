#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <thread>
#include <utility>

#include "daemon/control_socket/operator_desk.h"

namespace contour {

/// Carries out requests that wait for the cycle, one after the other, in a thread of its own, so that the
/// thread that serves the socket never waits.
class RequestWorker {
 public:
  /// Called in the worker's thread, with the number that the request came with.
  using Done = std::function<void(std::uint64_t client, const nlohmann::json& reply)>;

  RequestWorker(OperatorDesk& desk, Done done);
  ~RequestWorker();
  RequestWorker(const RequestWorker&) = delete;
  RequestWorker& operator=(const RequestWorker&) = delete;

  void Start();
  /// Ends when the request under way has its answer; those behind it get none.
  void Stop();
  void Take(std::uint64_t client, std::string line);

 private:
  void Work();

  OperatorDesk& desk_;
  const Done done_;
  std::mutex mutex_;  // guards all below
  std::condition_variable wake_;
  std::deque<std::pair<std::uint64_t, std::string>> requests_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace contour
