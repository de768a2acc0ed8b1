#pragma once

#include "daemon/rt/io_source.h"
#include "drivers/modbus/io_client.h"

namespace contour {

/// The Modbus client as the loop sees it.
class IoAdapter final : public IoSource {
 public:
  explicit IoAdapter(const IoClient& client) : client_(client) {}
  IoInput Read(std::int64_t now_ns) noexcept override { return client_.Read(now_ns); }

 private:
  const IoClient& client_;
};

}  // namespace contour
