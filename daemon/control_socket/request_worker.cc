#include "daemon/control_socket/request_worker.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "daemon/control_socket/request_handler.h"

namespace contour {

RequestWorker::RequestWorker(OperatorDesk& desk, Done done) : desk_(desk), done_(std::move(done)) {}

RequestWorker::~RequestWorker() { Stop(); }

void RequestWorker::Start() {
  if (!thread_.joinable()) thread_ = std::thread(&RequestWorker::Work, this);
}

void RequestWorker::Stop() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  wake_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void RequestWorker::Take(Request request) {
  {
    const std::lock_guard lock(mutex_);
    requests_.push_back(std::move(request));
  }
  wake_.notify_one();
}

void RequestWorker::Drop(std::uint64_t client) {
  const std::lock_guard lock(mutex_);
  std::erase_if(requests_, [&](const Request& r) { return r.client == client; });
  if (client_ == client) unwanted_.request_stop();
}

void RequestWorker::StopCame() {
  std::vector<Request> refused;
  {
    const std::lock_guard lock(mutex_);
    const auto behind = std::stable_partition(requests_.begin(), requests_.end(),
                                              [](const Request& r) { return !r.leads_to_motion; });
    std::move(behind, requests_.end(), std::back_inserter(refused));
    requests_.erase(behind, requests_.end());
    if (client_ != 0 && motion_) unwanted_.request_stop();
  }
  for (const Request& r : refused) done_(r.client, Refuse(r.line, kStopCameFirst));
}

void RequestWorker::Work() {
  Subscriptions none;  // requests that subscribe are answered by the socket's thread
  for (;;) {
    Request request;
    std::stop_token unwanted;
    {
      std::unique_lock lock(mutex_);
      client_ = 0;
      wake_.wait(lock, [this] { return ending_ || !requests_.empty(); });
      if (ending_) return;
      request = std::move(requests_.front());
      requests_.pop_front();
      client_ = request.client;
      motion_ = request.leads_to_motion;
      unwanted_ = std::stop_source();
      unwanted = unwanted_.get_token();
    }
    if (request.abandoned) {
      desk_.Abandoned();
      continue;
    }
    std::string program = request.program ? request.program->Take() : std::string();
    const nlohmann::json reply =
        Handle(request.line, desk_, none, unwanted, request.program ? &program : nullptr);
    request.program.reset();
    done_(request.client, reply);
  }
}

}  // namespace contour
