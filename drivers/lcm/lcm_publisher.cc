#include "drivers/lcm/lcm_publisher.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <lcm/lcm-cpp.hpp>
#include <utility>

namespace contour {
namespace {

// Ever longer, because LCM itself prints half a page to stderr each time.
constexpr std::chrono::seconds kFirstReopen{5};
constexpr std::chrono::seconds kLastReopen{600};

}  // namespace

LcmPublisher::LcmPublisher(std::string url) : url_(std::move(url)) { stats_.enabled = true; }

LcmPublisher::~LcmPublisher() = default;

void LcmPublisher::OnEvent(const TelemetryEvent& event) noexcept {
  try {
    if (!Open()) return Fail("LCM cannot use " + url_);
    errno = 0;
    // LCM wants a terminated name; the views of an event need not be.
    const std::string channel(event.channel);
    if (lcm_->publish(channel, event.bytes.data(), static_cast<unsigned int>(event.bytes.size())) != 0) {
      return Fail("LCM cannot send to " + url_ +
                  (errno != 0 ? std::string(": ") + std::strerror(errno) : ""));
    }
    const std::lock_guard lock(mutex_);
    ++stats_.messages;
  } catch (const std::exception&) {
    // Out of memory: this message is lost like one the network refused.
    const std::lock_guard lock(mutex_);
    ++stats_.failures;
  }
}

bool LcmPublisher::Open() {
  if (lcm_ != nullptr && lcm_->good()) return true;
  const auto now = std::chrono::steady_clock::now();
  if (now < next_attempt_) return false;
  reopen_after_ = std::clamp(2 * reopen_after_, kFirstReopen, kLastReopen);
  next_attempt_ = now + reopen_after_;
  lcm_ = std::make_unique<lcm::LCM>(url_);
  return lcm_->good();
}

void LcmPublisher::Fail(const std::string& what) {
  const std::lock_guard lock(mutex_);
  ++stats_.failures;
  stats_.last_error = what;
}

PublisherStats LcmPublisher::stats() const {
  const std::lock_guard lock(mutex_);
  return stats_;
}

}  // namespace contour
