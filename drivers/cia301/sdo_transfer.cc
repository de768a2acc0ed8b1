#include "drivers/cia301/sdo_transfer.h"

#include <array>

#include "drivers/cia301/messages.h"

namespace contour {
namespace {

struct AbortText {
  std::uint32_t code;
  std::string_view text;
};

// CiA 301, table of SDO abort codes.
constexpr std::array kAbortTexts{
    AbortText{0x05030000, "toggle bit not alternated"},
    AbortText{0x05040000, "SDO protocol timed out"},
    AbortText{0x05040001, "client/server command specifier not valid or unknown"},
    AbortText{0x05040002, "invalid block size"},
    AbortText{0x05040003, "invalid sequence number"},
    AbortText{0x05040004, "CRC error"},
    AbortText{0x05040005, "out of memory"},
    AbortText{0x06010000, "unsupported access to an object"},
    AbortText{0x06010001, "attempt to read a write-only object"},
    AbortText{0x06010002, "attempt to write a read-only object"},
    AbortText{0x06020000, "object does not exist in the object dictionary"},
    AbortText{0x06040041, "object cannot be mapped to the PDO"},
    AbortText{0x06040042, "number and length of the objects to be mapped would exceed PDO length"},
    AbortText{0x06040043, "general parameter incompatibility"},
    AbortText{0x06040047, "general internal incompatibility in the device"},
    AbortText{0x06060000, "access failed due to a hardware error"},
    AbortText{0x06070010, "data type does not match, length of service parameter does not match"},
    AbortText{0x06070012, "data type does not match, length of service parameter too high"},
    AbortText{0x06070013, "data type does not match, length of service parameter too low"},
    AbortText{0x06090011, "sub-index does not exist"},
    AbortText{0x06090030, "invalid value for parameter"},
    AbortText{0x06090031, "value of parameter written too high"},
    AbortText{0x06090032, "value of parameter written too low"},
    AbortText{0x06090036, "maximum value is less than minimum value"},
    AbortText{0x060A0023, "resource not available: SDO connection"},
    AbortText{0x08000000, "general error"},
    AbortText{0x08000020, "data cannot be transferred or stored to the application"},
    AbortText{0x08000021, "data cannot be transferred or stored because of local control"},
    AbortText{0x08000022, "data cannot be transferred or stored because of the present device state"},
    AbortText{0x08000023, "no object dictionary present"},
    AbortText{0x08000024, "no data available"},
};

// Command specifiers in the top three bits of the first byte (CiA 301, SDO protocols).
constexpr std::uint8_t kDownloadRequest = 0x20;
constexpr std::uint8_t kUploadRequest = 0x40;
constexpr std::uint8_t kAbort = 0x80;
constexpr std::uint8_t kDownloadReply = 0x60;
constexpr std::uint8_t kUploadReply = 0x40;
constexpr std::uint8_t kExpedited = 0x02;
constexpr std::uint8_t kSizeGiven = 0x01;

CanFrame Frame(std::uint8_t command, std::uint8_t node_id, std::uint16_t index, std::uint8_t sub,
               std::uint32_t value) noexcept {
  CanFrame f{static_cast<std::uint16_t>(cob::kSdoRequest + node_id), 8, {}};
  f.data[0] = command;
  PutU16(f, 1, index);
  f.data[3] = sub;
  PutU32(f, 4, value);
  return f;
}

}  // namespace

std::string_view SdoAbortText(std::uint32_t code) noexcept {
  for (const AbortText& t : kAbortTexts) {
    if (t.code == code) return t.text;
  }
  return "unknown abort code";
}

CanFrame SdoReadFrame(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub) noexcept {
  return Frame(kUploadRequest, node_id, index, sub, 0);
}

CanFrame SdoWriteFrame(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub, std::uint8_t size,
                       std::uint32_t value) noexcept {
  const auto unused = static_cast<std::uint8_t>((4 - size) << 2);
  const std::uint32_t mask = size >= 4 ? 0xFFFFFFFFu : (1u << (8 * size)) - 1u;
  return Frame(static_cast<std::uint8_t>(kDownloadRequest | unused | kExpedited | kSizeGiven), node_id, index,
               sub, value & mask);
}

CanFrame SdoAbortFrame(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub,
                       std::uint32_t code) noexcept {
  return Frame(kAbort, node_id, index, sub, code);
}

void SdoTransfer::Start(const CanFrame& request, bool write, std::uint64_t deadline_cycles) noexcept {
  request_ = request;
  write_ = write;
  deadline_ = deadline_cycles;
  waited_ = 0;
  value_ = 0;
  abort_code_ = 0;
  state_ = State::kWaiting;
}

void SdoTransfer::StartRead(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub,
                            std::uint64_t deadline_cycles) noexcept {
  Start(SdoReadFrame(node_id, index, sub), false, deadline_cycles);
}

void SdoTransfer::StartWrite(std::uint8_t node_id, std::uint16_t index, std::uint8_t sub, std::uint8_t size,
                             std::uint32_t value, std::uint64_t deadline_cycles) noexcept {
  Start(SdoWriteFrame(node_id, index, sub, size, value), true, deadline_cycles);
}

void SdoTransfer::End(State state, std::uint32_t value, std::uint32_t abort_code) noexcept {
  state_ = state;
  value_ = value;
  abort_code_ = abort_code;
}

bool SdoTransfer::OnFrame(const CanFrame& frame) noexcept {
  if (state_ != State::kWaiting || frame.length != 8) return false;
  if (frame.id != request_.id - cob::kSdoRequest + cob::kSdoReply) return false;
  if (GetU16(frame, 1) != GetU16(request_, 1) || frame.data[3] != request_.data[3]) return false;

  const auto command = static_cast<std::uint8_t>(frame.data[0] & 0xE0);
  if (command == kAbort) {
    End(State::kAborted, 0, GetU32(frame, 4));
  } else if (write_ && command == kDownloadReply) {
    state_ = State::kDone;
  } else if (!write_ && command == kUploadReply && (frame.data[0] & kExpedited) != 0) {
    const unsigned size = (frame.data[0] & kSizeGiven) != 0 ? 4u - ((frame.data[0] >> 2) & 3u) : 4u;
    value_ = GetU32(frame, 4) & (size >= 4 ? 0xFFFFFFFFu : (1u << (8 * size)) - 1u);
    state_ = State::kDone;
  } else if (!write_ && command == kUploadReply) {
    const std::uint32_t size = (frame.data[0] & kSizeGiven) != 0 ? GetU32(frame, 4) : 0;
    End(State::kSegmented, size, sdo_abort::kLengthTooHigh);
  } else {
    End(State::kUnexpected, frame.data[0], sdo_abort::kCommandUnknown);
  }
  return true;
}

void SdoTransfer::Elapse(std::uint64_t cycles) noexcept {
  if (state_ != State::kWaiting) return;
  waited_ += cycles;
  if (waited_ >= deadline_) state_ = State::kTimedOut;
}

}  // namespace contour
