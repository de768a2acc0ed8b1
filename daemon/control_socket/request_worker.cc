#include "daemon/control_socket/request_worker.h"

#include <nlohmann/json.hpp>

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

void RequestWorker::Take(std::uint64_t client, std::string line) {
  {
    const std::lock_guard lock(mutex_);
    requests_.emplace_back(client, std::move(line));
  }
  wake_.notify_one();
}

void RequestWorker::Work() {
  Subscriptions none;  // requests that subscribe are answered by the socket's thread
  for (;;) {
    std::pair<std::uint64_t, std::string> request;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return ending_ || !requests_.empty(); });
      if (ending_) return;
      request = std::move(requests_.front());
      requests_.pop_front();
    }
    done_(request.first, Handle(request.second, desk_, none));
  }
}

}  // namespace contour
