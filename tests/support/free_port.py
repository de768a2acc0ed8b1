"""A TCP port that nobody listens on: other tests, and a contourd of the host, may run beside a test."""
import socket


def free_port():
    with socket.socket() as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]
