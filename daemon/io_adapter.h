#pragma once

#include "daemon/rt/io_source.h"
#include "drivers/modbus/io_client.h"

namespace contour {

/// The Modbus client as the loop sees it.
class IoAdapter final : public IoSource {
 public:
  IoAdapter(const IoClient& client, bool lockstep) : client_(client), lockstep_(lockstep) {}
  IoInput Read(std::int64_t now_ns) noexcept override {
    return lockstep_ ? client_.ReadInLockstep() : client_.Read(now_ns);
  }

 private:
  const IoClient& client_;
  bool lockstep_;
};

}  // namespace contour
