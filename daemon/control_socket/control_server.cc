#include "daemon/control_socket/control_server.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "daemon/control_socket/base64.h"

namespace contour {
namespace {

using nlohmann::json;

/// How often subscriptions are looked after.
constexpr int kStreamPeriod_ms = 20;
/// Rows in one message; at 1 kHz a message every stream period carries about 20.
constexpr std::size_t kRowsPerMessage = 64;
/// Stops of one client under way; more of them wait for their turn.
constexpr std::size_t kStopsUnderWay = 8;
/// What is read of one client in a turn.
constexpr std::size_t kRead_bytes = 16u << 10;
/// What a client that has hung up may still have in the socket; the kernel holds less.
constexpr std::size_t kLeftBehind_bytes = 1u << 20;

/// Cheap, for lines that say nothing of the kind.
bool MayBeStop(std::string_view line) {
  return line.find("stop") != std::string_view::npos || line.find("disable") != std::string_view::npos;
}

bool IsBlank(std::string_view line) { return line.find_first_not_of(" \t\r") == std::string_view::npos; }

/// Text from programs and file names need not be UTF-8; it must not cost anybody the connection.
std::string Text(const json& message) {
  return message.dump(-1, ' ', false, json::error_handler_t::replace) + '\n';
}

}  // namespace

ControlServer::ControlServer(Options options, OperatorDesk& desk)
    : options_(std::move(options)),
      desk_(desk),
      listener_(options_.socket, options_.mode),
      wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
      uploads_(std::make_shared<UploadBudget>(options_.max_upload_bytes)),
      requests_(desk,
                [this](std::uint64_t c, const json& reply) { OnReply(c, RequestClass::kWaits, reply); }),
      disables_(desk,
                [this](std::uint64_t c, const json& reply) { OnReply(c, RequestClass::kDisable, reply); }),
      stops_(desk, [this](std::uint64_t c, const json& reply) { OnReply(c, RequestClass::kStop, reply); }) {}

ControlServer::~ControlServer() { Stop(); }

void ControlServer::Start() {
  if (thread_.joinable()) return;
  requests_.Start();
  disables_.Start();
  stops_.Start();
  thread_ = std::thread(&ControlServer::Serve, this);
}

void ControlServer::Stop() {
  if (!thread_.joinable()) return;
  // Whoever is being answered gets the answer still.
  requests_.Stop();
  disables_.Stop();
  stops_.Stop();
  ending_ = true;
  Wake();
  thread_.join();
}

void ControlServer::Wake() {
  const std::uint64_t one = 1;
  // The counter of an eventfd takes this write always.
  [[maybe_unused]] const ssize_t written = ::write(wake_.get(), &one, sizeof one);
}

void ControlServer::Serve() {
  std::vector<pollfd> polled;
  for (;;) {
    polled.assign({{wake_.get(), POLLIN, 0}, {listener_.get(), POLLIN, 0}});
    for (const Client& client : clients_) {
      const int in = HasRoom(client) ? POLLIN : 0;
      const int out = client.unsent.empty() ? 0 : POLLOUT;
      polled.push_back({client.socket.get(), static_cast<short>(in | out), 0});
    }
    if (::poll(polled.data(), polled.size(), PollTimeout_ms()) < 0 && errno != EINTR) break;
    if (polled[0].revents != 0) {
      TakeReplies();
      if (ending_) break;
    }
    std::size_t i = 2;
    for (Client& client : clients_) {
      const short events = polled[i++].revents;
      if ((events & (POLLHUP | POLLERR)) != 0) {
        HangUp(client);
      } else if ((events & POLLIN) != 0) {
        Receive(client);
      }
      LookForStops(client);
    }
    // Not before all have been looked through for stops.
    for (Client& client : clients_) TakeTurn(client);
    for (Client& client : clients_) {
      SendSubscribed(client);
      Flush(client);
    }
    DropGoneClients();
    if (polled[1].revents != 0) AcceptClients();
  }
  for (Client& client : clients_) {
    Flush(client);
    client.gone = true;
  }
  DropGoneClients();
}

int ControlServer::PollTimeout_ms() const {
  int timeout_ms = -1;
  for (const Client& client : clients_) {
    const bool rows = client.feed != nullptr && client.unsent.empty() && client.feed->size() != 0;
    if (rows || MayHaveTurn(client)) return 0;
    if (client.feed != nullptr || client.subscriptions.watch_period_ms) timeout_ms = kStreamPeriod_ms;
    if ((!client.unsent.empty() || client.closing) && timeout_ms < 0)
      timeout_ms = static_cast<int>(std::min<std::int64_t>(options_.deaf_after.count(), 1000));
  }
  return timeout_ms;
}

/// A request is there and may be carried out.
bool ControlServer::MayHaveTurn(const Client& client) const {
  return !client.waits && !client.closing && !client.gone && client.stops < kStopsUnderWay &&
         client.unsent.size() < options_.max_unread_bytes && client.received.find('\n') != std::string::npos;
}

/// What has been received and not had its turn stays within a line's length.
bool ControlServer::HasRoom(const Client& client) const {
  return !client.no_more && (client.closing || client.received.size() <= options_.max_line_bytes);
}

void ControlServer::AcceptClients() {
  // So many in a turn; whoever is left waits in the kernel for the next one.
  for (std::size_t i = 0; i < options_.max_clients + options_.reserved_clients; ++i) {
    Descriptor socket = listener_.Accept();
    if (socket.get() < 0) return;
    if (clients_.size() >= options_.max_clients + options_.reserved_clients && !MakeRoom()) continue;
    Client& client = clients_.emplace_back();
    client.number = next_number_++;
    client.socket = std::move(socket);
    client.heard = client.read = std::chrono::steady_clock::now();
    client.reserved = true;
    GivePlaces();
  }
}

/// Of those in the reserved places the one that has been silent for longest goes, unless all of them have a
/// stop under way.
bool ControlServer::MakeRoom() {
  Client* silent = nullptr;
  for (Client& client : clients_)
    if (client.reserved && client.stops == 0 && (silent == nullptr || client.heard < silent->heard))
      silent = &client;
  if (silent == nullptr) return false;
  silent->gone = true;
  DropGoneClients();
  return true;
}

/// A place that has become free goes to whoever has waited for longest.
void ControlServer::GivePlaces() {
  auto taken = static_cast<std::size_t>(
      std::count_if(clients_.begin(), clients_.end(), [](const Client& c) { return !c.reserved; }));
  for (Client& client : clients_) {
    if (taken >= options_.max_clients) return;
    if (!client.reserved) continue;
    client.reserved = false;
    ++taken;
  }
}

void ControlServer::Receive(Client& client) {
  std::array<char, kRead_bytes> buffer;
  const ssize_t n = ::recv(client.socket.get(), buffer.data(), buffer.size(), 0);
  if (n < 0 && (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK)) return;
  if (n < 0) client.gone = true;
  if (n == 0) client.no_more = true;
  if (n <= 0) return;
  client.heard = std::chrono::steady_clock::now();
  if (client.closing) return;  // read and forget, so that the refusal arrives and not a reset
  client.received.append(buffer.data(), static_cast<std::size_t>(n));
}

/// The client has gone. A stop or disable that it left behind is carried out, nothing else is.
void ControlServer::HangUp(Client& client) {
  std::array<char, kRead_bytes> buffer;
  for (std::size_t read = 0; read < kLeftBehind_bytes && !client.closing;) {
    const ssize_t n = ::recv(client.socket.get(), buffer.data(), buffer.size(), MSG_DONTWAIT);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    client.received.append(buffer.data(), static_cast<std::size_t>(n));
    read += static_cast<std::size_t>(n);
  }
  LookForStops(client);
  client.gone = true;
}

/// Stops of this client that wait behind its other requests.
void ControlServer::LookForStops(Client& client) {
  if (client.closing || client.gone) return;
  std::size_t begin = client.looked;
  for (;;) {
    const std::size_t end = client.received.find('\n', begin);
    if (end == std::string::npos || client.stops >= kStopsUnderWay) break;
    const std::string_view line = std::string_view(client.received).substr(begin, end - begin);
    const RequestHead head =
        MayBeStop(line) && line.size() <= options_.max_line_bytes ? HeadOf(line) : RequestHead();
    if (head.kind == RequestClass::kStop || head.kind == RequestClass::kDisable) {
      std::string stop(line);
      client.received.erase(begin, end + 1 - begin);
      const std::size_t before = client.received.size();
      RefuseMotionBefore(client, begin);
      begin -= before - client.received.size();
      OnStop(client, head.kind, std::move(stop));
    } else {
      begin = end + 1;
    }
  }
  client.looked = begin;
}

void ControlServer::OnStop(Client& client, RequestClass kind, std::string line) {
  ++client.stops;
  // Before the stop: nothing that was asked for earlier may set the axes in motion after it.
  requests_.StopCame();
  (kind == RequestClass::kStop ? stops_ : disables_).Take({client.number, std::move(line)});
}

void ControlServer::RefuseMotionBefore(Client& client, std::size_t end) {
  for (std::size_t begin = 0; begin < end;) {
    const std::size_t next = client.received.find('\n', begin) + 1;
    const std::string_view line = std::string_view(client.received).substr(begin, next - 1 - begin);
    if (HeadOf(line).leads_to_motion) {
      Send(client, Refuse(line, kStopCameFirst));
      client.received.erase(begin, next - begin);
      end -= next - begin;
    } else {
      begin = next;
    }
  }
}

/// One request of this client, if there is one and it may be carried out.
void ControlServer::TakeTurn(Client& client) {
  const std::size_t end = client.received.find('\n');
  const std::size_t length = end == std::string::npos ? client.received.size() : end;
  if (length > options_.max_line_bytes && !client.closing) {
    Send(client, {{"ok", false},
                  {"error", "a line may have " + std::to_string(options_.max_line_bytes) +
                                " bytes at most; longer programs are sent in pieces (\"upload\")"}});
    client.received.clear();
    client.looked = 0;
    client.closing = true;
  }
  if (!MayHaveTurn(client)) return;
  std::string line = client.received.substr(0, end);
  client.received.erase(0, end + 1);
  client.looked -= std::min(client.looked, end + 1);
  if (IsBlank(line)) return;
  const RequestHead head = HeadOf(line);
  const bool for_all = head.status || head.kind == RequestClass::kStop || head.kind == RequestClass::kDisable;
  if (client.reserved && !for_all) {
    Send(client,
         Refuse(line, "there are " + std::to_string(options_.max_clients) +
                          " clients already; until one of them leaves there is the status, a stop and a "
                          "disable for others"));
    return;
  }
  CarryOut(client, head, std::move(line));
}

// A client's requests are answered in their order, stops and disables apart.
void ControlServer::CarryOut(Client& client, const RequestHead& head, std::string line) {
  switch (head.kind) {
    case RequestClass::kStop:
    case RequestClass::kDisable:
      return OnStop(client, head.kind, std::move(line));
    case RequestClass::kUpload:
      return OnPiece(client, line);
    case RequestClass::kWaits:
      client.waits = true;
      return requests_.Take({client.number, std::move(line), head.leads_to_motion,
                             head.uploaded ? std::exchange(client.program, nullptr) : nullptr});
    case RequestClass::kAtOnce:
      return AnswerAtOnce(client, line);
  }
}

void ControlServer::OnPiece(Client& client, std::string_view line) {
  const std::optional<UploadPiece> piece = PieceIn(line);
  if (!piece) return Send(client, Refuse(line, "a piece of a program has \"text\", a string"));
  if (piece->first || client.program == nullptr) client.program = std::make_shared<UploadedText>(uploads_);
  if (client.program->Append(piece->text)) return Send(client, AcceptPiece(line, client.program->bytes()));
  client.program.reset();
  Send(client, Refuse(line, "there is no room: all programs that are being sent have " +
                                std::to_string(uploads_->max_bytes()) + " bytes at most together"));
}

void ControlServer::AnswerAtOnce(Client& client, std::string_view line) {
  const bool had_rows = client.subscriptions.rows;
  const json reply = Handle(line, desk_, client.subscriptions);
  if (client.subscriptions.rows && !had_rows) {
    const auto collecting =
        std::count_if(clients_.begin(), clients_.end(), [](const Client& c) { return c.feed != nullptr; });
    if (static_cast<std::size_t>(collecting) >= options_.max_row_clients) {
      client.subscriptions.rows = false;
      return Send(client, Refuse(line, std::to_string(collecting) + " clients collect rows already"));
    }
    client.feed = std::make_shared<RowFeed>();
    desk_.Attach(client.feed);
  } else if (!client.subscriptions.rows && had_rows) {
    desk_.Detach(client.feed);
    client.feed.reset();
  }
  Send(client, reply);
}

void ControlServer::OnReply(std::uint64_t client, RequestClass kind, const json& reply) {
  {
    const std::lock_guard lock(replies_mutex_);
    replies_.push_back({client, kind, Text(reply)});
  }
  Wake();
}

void ControlServer::TakeReplies() {
  std::uint64_t count = 0;
  [[maybe_unused]] const ssize_t taken = ::read(wake_.get(), &count, sizeof count);
  std::vector<Reply> replies;
  {
    const std::lock_guard lock(replies_mutex_);
    replies.swap(replies_);
  }
  for (const Reply& reply : replies) {
    const auto client = std::find_if(clients_.begin(), clients_.end(),
                                     [&](const Client& c) { return c.number == reply.client; });
    if (client == clients_.end()) continue;
    client->unsent += reply.line;
    if (reply.kind == RequestClass::kWaits) {
      client->waits = false;
    } else {
      --client->stops;
    }
  }
}

void ControlServer::SendSubscribed(Client& client) {
  while (client.feed != nullptr && client.unsent.size() < options_.max_unread_bytes && !client.gone) {
    json rows = json::array();
    while (rows.size() < kRowsPerMessage) {
      const auto row = client.feed->Pop();
      if (!row) break;
      rows.push_back(ToBase64(*row));
    }
    if (rows.empty()) break;
    Send(client, {{"rows", std::move(rows)}, {"lost", client.feed->lost()}});
  }
  const auto now = std::chrono::steady_clock::now();
  if (client.subscriptions.watch_period_ms && now >= client.next_watch && client.unsent.empty()) {
    client.next_watch = now + std::chrono::milliseconds(*client.subscriptions.watch_period_ms);
    Send(client, {{"watch", ToJson(desk_.Status())}});
  }
}

void ControlServer::Send(Client& client, const nlohmann::json& message) { client.unsent += Text(message); }

void ControlServer::Flush(Client& client) {
  std::size_t done = 0;
  while (done < client.unsent.size() && !client.gone) {
    const ssize_t n = ::send(client.socket.get(), client.unsent.data() + done, client.unsent.size() - done,
                             MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) break;
    if (n <= 0) {
      client.gone = true;
      break;
    }
    done += static_cast<std::size_t>(n);
  }
  client.unsent.erase(0, done);
  const auto now = std::chrono::steady_clock::now();
  if (done != 0 || (client.unsent.empty() && !client.closing)) client.read = now;
  if (now - client.read > options_.deaf_after) client.gone = true;
  if (!client.unsent.empty()) return;
  // Our end is closed first; the client's end of file then drops it.
  if (client.closing) ::shutdown(client.socket.get(), SHUT_WR);
  const bool more = client.waits || client.stops != 0 || MayHaveTurn(client) || client.feed != nullptr ||
                    client.subscriptions.watch_period_ms.has_value();
  if (client.no_more && (client.closing || !more)) client.gone = true;
}

void ControlServer::DropGoneClients() {
  for (const Client& client : clients_) {
    if (!client.gone) continue;
    requests_.Drop(client.number);
    if (client.subscriptions.attends && !ending_) TakeTorqueOff(client.number);
    if (client.feed != nullptr) desk_.Detach(client.feed);
  }
  clients_.remove_if([](const Client& client) { return client.gone; });
  GivePlaces();
}

/// As if it had asked for a disable itself, last of all.
void ControlServer::TakeTorqueOff(std::uint64_t client) {
  requests_.StopCame();
  disables_.Take({client, R"({"request": "disable"})"});
  requests_.Take({client, {}, false, {}, true});
}

}  // namespace contour
