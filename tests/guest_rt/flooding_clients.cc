// Sixteen clients of the control socket that ask for the status as fast as they can and never read an answer.
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <string>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::string requests;
  for (int i = 0; i < 500; ++i) requests += "{\"id\": 1, \"request\": \"status\"}\n";
  std::array<pollfd, 16> clients{};
  for (pollfd& client : clients) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, argv[1], sizeof address.sun_path - 1);
    client = {socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0), POLLOUT, 0};
    if (connect(client.fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      std::perror("connect");
      return 1;
    }
  }
  std::puts("flooding");
  std::fflush(stdout);
  for (;;) {
    if (poll(clients.data(), clients.size(), -1) < 0) return 1;
    for (pollfd& client : clients) {
      if ((client.revents & (POLLERR | POLLHUP)) != 0) client.fd = -1;
      if ((client.revents & POLLOUT) != 0 &&
          send(client.fd, requests.data(), requests.size(), MSG_NOSIGNAL) < 0)
        continue;
    }
  }
}
