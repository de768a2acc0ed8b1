#pragma once

#include <pthread.h>

#include <atomic>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "config/realtime_config.h"
#include "daemon/rt/loop.h"
#include "daemon/rt/thread_setup.h"

namespace contour {

/// Real time as the machine file asks for it, or why not. Lock-step needs none.
class RealtimeThread {
 public:
  RealtimeThread(Loop& loop, const RealtimeConfig& config, bool lockstep) : loop_(loop), lockstep_(lockstep) {
    request_ = {config.priority, config.cpu, config.lock_memory};
  }
  ~RealtimeThread() {
    if (thread_.joinable() && !gone_) Go(false);
    Join();
  }

  /// What was refused.
  std::vector<std::string> Start() {
    std::future<std::vector<std::string>> refused = refused_.get_future();
    thread_ = std::thread([this] { Work(); });
    return refused.get();
  }
  /// Let the loop run, or give it up.
  void Go(bool go) {
    gone_ = true;
    go_.set_value(go);
  }
  [[nodiscard]] bool ended() const { return ended_; }
  void Join() {
    if (thread_.joinable()) thread_.join();
  }

 private:
  void Work() {
    pthread_setname_np(pthread_self(), "contour-rt");
    refused_.set_value(lockstep_ ? std::vector<std::string>() : ApplyThreadRequest(request_));
    if (go_.get_future().get()) {
      if (lockstep_) {
        loop_.RunLockstep();
      } else {
        loop_.RunWall();
      }
    }
    ended_ = true;
  }

  Loop& loop_;
  bool lockstep_;
  ThreadRequest request_;
  std::promise<std::vector<std::string>> refused_;
  std::promise<bool> go_;
  bool gone_ = false;  ///< the thread has been told
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace contour
