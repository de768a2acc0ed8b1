"""The canopen library's network without its threads and its clock: whoever runs the machine hands frames in and says how much time has
passed."""
import socket
import struct

import canopen

FRAME = struct.Struct("<IB3x8s")


class Periodic:
    """A frame that the library wants to be sent again and again: the heartbeat."""

    def __init__(self, network, cob_id, data, period_s):
        self.network, self.cob_id, self.data, self.period_ms = network, cob_id, data, period_s * 1000.0
        self.left_ms = self.period_ms

    def update(self, data):
        self.data = data

    def stop(self):
        self.network.periodic.discard(self)


class TimedNetwork(canopen.Network):
    """What is sent periodically (heartbeats) is sent in the time that elapse() is told."""

    def __init__(self):
        super().__init__()
        self.periodic = set()

    def send_message(self, can_id, data, remote=False):
        raise NotImplementedError

    def send_periodic(self, can_id, data, period, remote=False):
        del remote
        task = Periodic(self, can_id, data, period)
        self.periodic.add(task)
        return task

    def elapse(self, time_ms):
        for task in list(self.periodic):
            task.left_ms -= time_ms
            if task.left_ms <= 0.0:
                task.left_ms = task.period_ms
                self.send_message(task.cob_id, task.data)


class SocketNetwork(TimedNetwork):
    """On SocketCAN by a socket of our own: on a guest's processor each call into the kernel costs as much as an axis's whole period, and
    python-can makes several for a frame."""

    def __init__(self, bus):
        super().__init__()
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind((bus,))
        self.socket.setblocking(False)

    def receive(self):
        """The next frame: identifier and data; None when there is none."""
        try:
            frame = self.socket.recv(FRAME.size)
        except BlockingIOError:
            return None
        identifier, length, data = FRAME.unpack(frame)
        return identifier, data[:length]

    def send_message(self, can_id, data, remote=False):
        del remote
        self.socket.send(FRAME.pack(can_id, len(data), bytes(data)))
