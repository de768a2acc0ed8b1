#include "tools/plant_emulator/sdo_server.h"

#include <algorithm>

namespace contour::plant {
namespace {

std::uint16_t Index(const CanFrame& f) noexcept {
  return static_cast<std::uint16_t>(f.data[1] | static_cast<unsigned>(f.data[2]) << 8U);
}
std::uint32_t Load32(const CanFrame& f, std::size_t at, std::size_t bytes) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value |= static_cast<std::uint32_t>(f.data[at + i]) << (8U * i);
  return value;
}
void Store32(CanFrame& f, std::size_t at, std::uint32_t value) noexcept {
  for (std::size_t i = 0; i < 4; ++i) f.data[at + i] = static_cast<std::uint8_t>(value >> (8U * i));
}

}  // namespace

bool SdoServer::Answer(const CanFrame& request, CanFrame& reply) noexcept {
  if (request.length != 8) return false;
  reply = {};
  reply.id = static_cast<std::uint16_t>(0x580 + node_id_);
  reply.length = 8;
  for (std::size_t i = 1; i < 4; ++i) reply.data[i] = request.data[i];
  switch (request.data[0] >> 5U) {
    case 1:
      text_ = nullptr;
      Download(request, reply);
      return true;
    case 2:
      text_ = nullptr;
      Upload(request, reply);
      return true;
    case 3:
      UploadSegment(request, reply);
      return true;
    case 4:  // the client aborts: no answer
      text_ = nullptr;
      return false;
    default:
      text_ = nullptr;
      Abort(request, reply, abort_code::kUnknownCommand);
      return true;
  }
}

void SdoServer::Abort(const CanFrame& request, CanFrame& reply, std::uint32_t code) noexcept {
  for (std::size_t i = 1; i < 4; ++i) reply.data[i] = request.data[i];
  reply.data[0] = 0x80;
  Store32(reply, 4, code);
}

void SdoServer::Download(const CanFrame& request, CanFrame& reply) noexcept {
  ObjectEntry* e = objects_.Find(Index(request), request.data[3]);
  if (e == nullptr)
    return Abort(request, reply,
                 objects_.HasIndex(Index(request)) ? abort_code::kNoSubIndex : abort_code::kNoObject);
  if (e->access == ObjectAccess::kReadOnly) return Abort(request, reply, abort_code::kReadOnly);
  const std::uint8_t command = request.data[0];
  if ((command & 0x02U) == 0) return Abort(request, reply, abort_code::kLength);  // segmented
  const std::size_t size = SizeOf(e->type);
  const std::size_t given = (command & 0x01U) != 0 ? 4U - ((command >> 2U) & 0x03U) : size;
  if (given != size) return Abort(request, reply, abort_code::kLength);
  const std::int64_t value = FromWire(e->type, Load32(request, 4, size));
  std::uint32_t code = CheckRange(*e, value);
  if (code == abort_code::kNone) code = rules_.CheckWrite(*e, value);
  if (code != abort_code::kNone) return Abort(request, reply, code);
  e->value = value;
  rules_.OnWritten(*e);
  reply.data[0] = 0x60;
}

void SdoServer::Upload(const CanFrame& request, CanFrame& reply) noexcept {
  const ObjectEntry* e = objects_.Find(Index(request), request.data[3]);
  if (e == nullptr)
    return Abort(request, reply,
                 objects_.HasIndex(Index(request)) ? abort_code::kNoSubIndex : abort_code::kNoObject);
  if (e->access == ObjectAccess::kWriteOnly) return Abort(request, reply, abort_code::kWriteOnly);
  if (e->type == ObjectType::kText && e->text.size() > 4) {
    text_ = e;
    text_sent_ = 0;
    toggle_ = false;
    reply.data[0] = 0x41;
    Store32(reply, 4, static_cast<std::uint32_t>(e->text.size()));
    return;
  }
  std::size_t size = SizeOf(e->type);
  std::uint32_t value = WireValue(*e);
  if (e->type == ObjectType::kText) {
    size = std::max<std::size_t>(1, e->text.size());
    value = 0;
    for (std::size_t i = 0; i < e->text.size(); ++i)
      value |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(e->text[i])) << (8U * i);
  }
  reply.data[0] = static_cast<std::uint8_t>(0x43U | (4U - size) << 2U);
  for (std::size_t i = 0; i < size; ++i) reply.data[4 + i] = static_cast<std::uint8_t>(value >> (8U * i));
}

void SdoServer::UploadSegment(const CanFrame& request, CanFrame& reply) noexcept {
  if (text_ == nullptr) return Abort(request, reply, abort_code::kUnknownCommand);
  if (((request.data[0] & 0x10U) != 0) != toggle_) {
    Abort(request, reply, abort_code::kToggleBit);
    text_ = nullptr;
    return;
  }
  const std::size_t n = std::min<std::size_t>(7, text_->text.size() - text_sent_);
  const bool last = text_sent_ + n == text_->text.size();
  reply.data[0] = static_cast<std::uint8_t>((toggle_ ? 0x10U : 0U) | (7U - n) << 1U | (last ? 1U : 0U));
  for (std::size_t i = 0; i < 7; ++i)
    reply.data[1 + i] = i < n ? static_cast<std::uint8_t>(text_->text[text_sent_ + i]) : std::uint8_t{0};
  text_sent_ += n;
  toggle_ = !toggle_;
  if (last) text_ = nullptr;
}

}  // namespace contour::plant
