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
/// Rows are held back while a client has this much unread.
constexpr std::size_t kRowsHighWater_bytes = 1u << 20;
/// Stops of one client under way; more of them wait as other requests do.
constexpr std::size_t kStopsUnderWay = 8;

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
      requests_(desk,
                [this](std::uint64_t c, const json& reply) { OnReply(c, RequestClass::kWaits, reply); }),
      stops_(desk, [this](std::uint64_t c, const json& reply) { OnReply(c, RequestClass::kStop, reply); }) {}

ControlServer::~ControlServer() { Stop(); }

void ControlServer::Start() {
  if (thread_.joinable()) return;
  requests_.Start();
  stops_.Start();
  thread_ = std::thread(&ControlServer::Serve, this);
}

void ControlServer::Stop() {
  if (!thread_.joinable()) return;
  // Whoever is being answered gets the answer still.
  requests_.Stop();
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
      const bool wants_out = !client.unsent.empty();
      polled.push_back({client.socket.get(), static_cast<short>(wants_out ? POLLIN | POLLOUT : POLLIN), 0});
    }
    if (::poll(polled.data(), polled.size(), PollTimeout_ms()) < 0 && errno != EINTR) break;
    if (polled[0].revents != 0) {
      TakeReplies();
      if (ending_) break;
    }
    std::size_t i = 2;
    for (Client& client : clients_) {
      const short events = polled[i++].revents;
      if ((events & (POLLIN | POLLHUP | POLLERR)) != 0) Receive(client);
    }
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
  const bool streaming = std::any_of(clients_.begin(), clients_.end(), [](const Client& c) {
    return c.feed != nullptr || c.subscriptions.watch_period_ms;
  });
  return streaming ? kStreamPeriod_ms : -1;
}

void ControlServer::AcceptClients() {
  for (;;) {
    Descriptor socket = listener_.Accept();
    if (socket.get() < 0) return;
    Client& client = clients_.emplace_back();
    client.number = next_number_++;
    client.socket = std::move(socket);
    if (clients_.size() <= options_.max_clients) continue;
    Send(client, {{"ok", false},
                  {"error", "there are " + std::to_string(options_.max_clients) + " clients already"}});
    client.closing = true;
    Flush(client);
    // Whether or not it could be told: what it does not read now is not waited for.
    client.gone = true;
    DropGoneClients();
  }
}

void ControlServer::Receive(Client& client) {
  std::array<char, 65536> buffer;
  for (;;) {
    const ssize_t n = ::recv(client.socket.get(), buffer.data(), buffer.size(), 0);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (n <= 0) {
      client.gone = true;
      return;
    }
    if (client.closing) continue;  // read and forget, so that the refusal arrives and not a reset
    client.received.append(buffer.data(), static_cast<std::size_t>(n));
    TakeLines(client);
  }
}

void ControlServer::TakeLines(Client& client) {
  std::size_t begin = 0;
  for (std::size_t end = client.received.find('\n'); end != std::string::npos && !client.closing;
       end = client.received.find('\n', begin)) {
    OnLine(client, std::string_view(client.received).substr(begin, end - begin));
    begin = end + 1;
  }
  client.received.erase(0, begin);
  if (client.received.size() > options_.max_line_bytes) {
    Send(client,
         {{"ok", false},
          {"error", "a line may have " + std::to_string(options_.max_line_bytes) + " bytes at most"}});
    client.received.clear();
    client.closing = true;
  }
}

void ControlServer::OnLine(Client& client, std::string_view line) {
  if (line.find_first_not_of(" \t\r") == std::string_view::npos) return;
  const RequestClass kind = ClassOf(line);
  if (kind == RequestClass::kStop && client.stops < kStopsUnderWay) {
    ++client.stops;
    stops_.Take(client.number, std::string(line));
  } else if (client.waits) {
    client.behind.emplace_back(line);
    client.behind_bytes += line.size();
    if (client.behind_bytes > options_.max_line_bytes) client.gone = true;
  } else {
    CarryOut(client, line);
  }
}

// A client's requests are answered in their order, stops apart.
void ControlServer::CarryOut(Client& client, std::string_view line) {
  if (ClassOf(line) != RequestClass::kAtOnce) {
    client.waits = true;
    requests_.Take(client.number, std::string(line));
    return;
  }
  const bool had_rows = client.subscriptions.rows;
  const json reply = Handle(line, desk_, client.subscriptions);
  Send(client, reply);
  if (client.subscriptions.rows && !had_rows) {
    client.feed = std::make_shared<RowFeed>();
    desk_.Attach(client.feed);
  } else if (!client.subscriptions.rows && had_rows) {
    desk_.Detach(client.feed);
    client.feed.reset();
  }
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
    SendLine(*client, reply.line);
    if (reply.kind == RequestClass::kStop) {
      --client->stops;
      continue;
    }
    client->waits = false;
    while (!client->waits && !client->behind.empty()) {
      const std::string line = std::move(client->behind.front());
      client->behind.pop_front();
      client->behind_bytes -= line.size();
      CarryOut(*client, line);
    }
  }
}

void ControlServer::SendSubscribed(Client& client) {
  while (client.feed != nullptr && client.unsent.size() < kRowsHighWater_bytes && !client.gone) {
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

void ControlServer::Send(Client& client, const nlohmann::json& message) { SendLine(client, Text(message)); }

void ControlServer::SendLine(Client& client, std::string_view line) {
  client.unsent += line;
  if (client.unsent.size() > options_.max_unread_bytes) client.gone = true;
}

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
  // Our end is closed first; the client's end of file then drops it.
  if (client.closing && client.unsent.empty()) ::shutdown(client.socket.get(), SHUT_WR);
}

void ControlServer::DropGoneClients() {
  clients_.remove_if([this](const Client& client) {
    if (client.gone && client.feed != nullptr) desk_.Detach(client.feed);
    return client.gone;
  });
}

}  // namespace contour
