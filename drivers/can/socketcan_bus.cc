#include "drivers/can/socketcan_bus.h"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "drivers/can/clock_ns.h"
#include "drivers/can/error_frame.h"

namespace contour {
namespace {

constexpr std::size_t kBatch = 64;
constexpr int kReceiveBuffer_bytes = 1 << 20;     // thousands of frames: some seconds of a busy bus
constexpr std::uint32_t kCallsBetweenBinds = 64;  // a vanished interface is looked for this rarely
constexpr std::size_t kMaxWaitDescriptors = 8;
constexpr int kMostReceiveCalls = 8;
constexpr std::uint16_t kSync = 0x080;  // CiA 301

std::int64_t RealtimeToMonotonic_ns() noexcept { return ClockNow_ns() - ClockNow_ns(CLOCK_REALTIME); }

template <class T>
bool SetOption(int fd, int level, int option, const T& value) noexcept {
  return setsockopt(fd, level, option, &value, sizeof value) == 0;
}

}  // namespace

struct SocketCanBus::Batch {
  // Room for SCM_TIMESTAMPNS and SO_RXQ_OVFL.
  struct Control {
    alignas(cmsghdr)
        std::array<std::uint8_t, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))> bytes;
  };
  std::array<can_frame, kBatch> frames{};
  std::array<iovec, kBatch> vectors{};
  std::array<mmsghdr, kBatch> messages{};
  std::array<Control, kBatch> control{};

  Batch() {
    for (std::size_t i = 0; i < kBatch; ++i) {
      vectors[i] = {&frames[i], sizeof(can_frame)};
      messages[i].msg_hdr.msg_iov = &vectors[i];
      messages[i].msg_hdr.msg_iovlen = 1;
    }
  }
};

SocketCanBus::SocketCanBus(const std::string& interface, std::span<const int> nodes)
    : interface_(interface), batch_(std::make_unique<Batch>()) {
  if (interface.empty() || interface.size() >= IFNAMSIZ) {
    throw BusUnavailable("CAN interface \"" + interface + "\": not a possible name of an interface");
  }
  try {
    Open(nodes);
  } catch (...) {
    if (fd_ >= 0) close(fd_);
    throw;
  }
}

SocketCanBus::~SocketCanBus() { close(fd_); }

void SocketCanBus::Open(std::span<const int> nodes) {
  fd_ = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (fd_ < 0) {
    const int error = errno;
    std::string why =
        "CAN interface " + interface_ + ": cannot open a CAN socket (" + std::strerror(error) + "). ";
    if (error == EAFNOSUPPORT || error == EPROTONOSUPPORT) {
      why +=
          "The running kernel has no SocketCAN: load the modules can and can_raw (modprobe can_raw) or use a "
          "kernel "
          "that has them; the bus \"loopback\" needs neither";
    } else {
      why += "Check the permissions of this process";
    }
    throw BusUnavailable(why);
  }
  if (if_nametoindex(interface_.c_str()) == 0) {
    const bool is_virtual = interface_.starts_with("vcan");
    throw BusUnavailable("CAN interface " + interface_ + ": no such interface. " +
                         (is_virtual ? "Create it: ip link add dev " + interface_ +
                                           " type vcan; ip link set " + interface_ + " up"
                                     : "See `ip -details link show type can`; set it up: ip link set " +
                                           interface_ + " up type can bitrate 1000000"));
  }
  // Before the socket is bound, or strangers' frames would lie in its queue already.
  SetFilters(nodes);
  if (!Bind()) {
    const int error = errno;
    throw BusUnavailable("CAN interface " + interface_ + ": cannot be bound (" + std::strerror(error) +
                         "). Is it a CAN interface?");
  }

  const can_err_mask_t errors = CAN_ERR_TX_TIMEOUT | CAN_ERR_CRTL | CAN_ERR_BUSOFF | CAN_ERR_RESTARTED;
  const int on = 1;
  if (!SetOption(fd_, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, errors) ||
      !SetOption(fd_, SOL_SOCKET, SO_TIMESTAMPNS, on) || !SetOption(fd_, SOL_SOCKET, SO_RXQ_OVFL, on)) {
    throw BusUnavailable("CAN interface " + interface_ + ": cannot set up the socket (" +
                         std::strerror(errno) + ")");
  }
  SetOption(fd_, SOL_SOCKET, SO_RCVBUF,
            kReceiveBuffer_bytes);  // the kernel may cut it; overflows are counted

  ifreq request{};
  std::copy(interface_.begin(), interface_.end(), request.ifr_name);
  state_.up = ioctl(fd_, SIOCGIFFLAGS, &request) == 0 && (request.ifr_flags & IFF_UP) != 0;
}

void SocketCanBus::SetFilters(std::span<const int> nodes) {
  if (nodes.empty()) return;
  constexpr canid_t kNodeBits = 0x07F;
  constexpr canid_t kFunctionBits = 0x780;
  constexpr canid_t kDataFrame = CAN_EFF_FLAG | CAN_RTR_FLAG;  // both must be clear
  std::vector<can_filter> filters{{0x000, CAN_SFF_MASK | kDataFrame},
                                  {kSync, CAN_SFF_MASK | kDataFrame},
                                  {0x700, kFunctionBits | kDataFrame}};
  for (const int node : nodes) filters.push_back({static_cast<canid_t>(node), kNodeBits | kDataFrame});
  if (setsockopt(fd_, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                 static_cast<socklen_t>(filters.size() * sizeof(can_filter))) != 0)
    throw BusUnavailable("CAN interface " + interface_ + ": cannot set the receive filters (" +
                         std::strerror(errno) + ")");
  // A kernel that does not want to leaves the time of the answers to go by.
  const int on = 1;
  tells_own_ = SetOption(fd_, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, on);
}

bool SocketCanBus::Bind() noexcept {
  ifreq request{};
  std::copy(interface_.begin(), interface_.end(), request.ifr_name);
  if (ioctl(fd_, SIOCGIFINDEX, &request) != 0) return false;
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = request.ifr_ifindex;
  bound_ = bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  return bound_;
}

std::size_t SocketCanBus::Receive(std::int64_t /*now_ns*/, std::span<StampedFrame> frames) noexcept {
  // A bus-off of an earlier call has been seen; data that arrives now says that it is over.
  const bool bus_off_was_seen = state_.bus_off;
  bus_off_is_new_ = false;
  const std::uint64_t received_before = state_.frames_received;
  const std::int64_t to_monotonic_ns = RealtimeToMonotonic_ns();

  std::size_t taken = 0;
  // What is not passed on takes time, too: a bound on the calls bounds it.
  for (int calls = 0; taken < frames.size() && calls < kMostReceiveCalls; ++calls) {
    const std::size_t room = std::min(kBatch, frames.size() - taken);
    for (std::size_t i = 0; i < room; ++i) {
      msghdr& m = batch_->messages[i].msg_hdr;
      m.msg_control = batch_->control[i].bytes.data();
      m.msg_controllen = batch_->control[i].bytes.size();
      m.msg_flags = 0;
    }
    const int count =
        recvmmsg(fd_, batch_->messages.data(), static_cast<unsigned>(room), MSG_DONTWAIT, nullptr);
    if (count < 0) {
      if (errno == EINTR) continue;
      if (errno == EAGAIN || errno == EWOULDBLOCK) break;
      OnFailure(errno);  // ENETDOWN is reported once, then reading goes on
      break;
    }
    taken += TakeBatch(static_cast<std::size_t>(count), to_monotonic_ns, frames.subspan(taken));
    if (static_cast<std::size_t>(count) < room) break;
  }
  const bool data = state_.frames_received != received_before;
  if (data && bus_off_was_seen && !bus_off_is_new_) state_.bus_off = false;
  return taken;
}

std::size_t SocketCanBus::TakeBatch(std::size_t count, std::int64_t to_monotonic_ns,
                                    std::span<StampedFrame> frames) noexcept {
  std::size_t taken = 0;
  for (std::size_t i = 0; i < count; ++i) {
    std::int64_t stamp_ns = 0;
    msghdr& m = batch_->messages[i].msg_hdr;
    for (cmsghdr* c = CMSG_FIRSTHDR(&m); c != nullptr; c = CMSG_NXTHDR(&m, c)) {
      if (c->cmsg_level != SOL_SOCKET) continue;
      if (c->cmsg_type == SCM_TIMESTAMPNS) {
        timespec t{};
        std::memcpy(&t, CMSG_DATA(c), sizeof t);
        stamp_ns = static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec + to_monotonic_ns;
      } else if (c->cmsg_type == SO_RXQ_OVFL) {
        std::uint32_t dropped = 0;
        std::memcpy(&dropped, CMSG_DATA(c), sizeof dropped);
        state_.receive_overflows += dropped - overflows_seen_;  // the kernel's counter wraps at 32 bits
        overflows_seen_ = dropped;
      }
    }
    const can_frame& raw = batch_->frames[i];
    if (batch_->messages[i].msg_len != sizeof(can_frame)) continue;
    if ((raw.can_id & CAN_ERR_FLAG) != 0) {
      // What was waiting when the interface was set down is of a controller that has been stopped since.
      if (!state_.up && stamp_ns <= down_ns_) {
        ++state_.error_frames;
        continue;
      }
      CountAsUp();
      if (TakeErrorFrame(raw.can_id, raw.data, bus_off_is_new_, state_)) bus_off_is_new_ = true;
      continue;
    }
    if ((raw.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG)) != 0) continue;
    // The kernel marks what this socket sent itself.
    const bool own = tells_own_ && (m.msg_flags & MSG_CONFIRM) != 0;
    const auto id = static_cast<std::uint16_t>(raw.can_id & CAN_SFF_MASK);
    if (own && id != kSync) continue;
    StampedFrame& out = frames[taken++];
    out.stamp_ns = stamp_ns;
    out.frame.id = own ? static_cast<std::uint16_t>(kOwnFrame | id) : id;
    out.frame.length = std::min<std::uint8_t>(raw.len, 8);
    std::copy_n(raw.data, 8, out.frame.data.begin());
    if (own) continue;
    ++state_.frames_received;
    CountAsUp();
  }
  return taken;
}

std::size_t SocketCanBus::Send(std::int64_t /*now_ns*/, std::span<const CanFrame> frames) noexcept {
  if (!bound_) TryBindAgain();
  std::size_t sent = 0;
  while (sent < frames.size()) {
    const std::size_t count = std::min(kBatch, frames.size() - sent);
    for (std::size_t i = 0; i < count; ++i) {
      const CanFrame& f = frames[sent + i];
      can_frame& raw = batch_->frames[i];
      raw = {};
      raw.can_id = f.id;
      raw.len = f.length;
      std::copy(f.data.begin(), f.data.end(), raw.data);
      batch_->messages[i].msg_hdr.msg_control = nullptr;
      batch_->messages[i].msg_hdr.msg_controllen = 0;
    }
    const int done = sendmmsg(fd_, batch_->messages.data(), static_cast<unsigned>(count), MSG_DONTWAIT);
    if (done < 0) {
      if (errno == EINTR) continue;
      OnFailure(errno);
      break;
    }
    sent += static_cast<std::size_t>(done);
    if (done > 0) CountAsUp();
    // Fewer than asked for: the next call fails at once and says why.
  }
  state_.frames_sent += sent;
  state_.send_failures += frames.size() - sent;
  return sent;
}

void SocketCanBus::OnFailure(int error) noexcept {
  last_error_ = error;
  const bool gone = error == ENODEV || error == ENXIO;
  if (gone) bound_ = false;
  if (!gone && error != ENETDOWN) return;
  state_.up = false;
  down_ns_ = ClockNow_ns();
}

void SocketCanBus::CountAsUp() noexcept {
  if (!state_.up) BeginsAnew(bus_off_is_new_, state_);
  state_.up = true;
}

// Interfaces are found again by name: a USB adapter that was pulled comes back under a new index.
void SocketCanBus::TryBindAgain() noexcept {
  if (calls_unbound_++ % kCallsBetweenBinds == 0 && Bind()) calls_unbound_ = 0;
}

bool WaitReadable(std::span<const int> fds, std::int64_t deadline_monotonic_ns) noexcept {
  std::array<pollfd, kMaxWaitDescriptors> polled{};
  const std::size_t count = std::min(fds.size(), polled.size());
  for (std::size_t i = 0; i < count; ++i) polled[i] = {fds[i], POLLIN, 0};
  while (true) {
    const std::int64_t left_ns = std::max<std::int64_t>(0, deadline_monotonic_ns - ClockNow_ns());
    const timespec timeout{static_cast<std::time_t>(left_ns / 1'000'000'000),
                           static_cast<long>(left_ns % 1'000'000'000)};
    const int ready = ppoll(polled.data(), static_cast<nfds_t>(count), &timeout, nullptr);
    if (ready > 0) return true;
    if (ready == 0 || errno != EINTR) return false;
  }
}

}  // namespace contour
