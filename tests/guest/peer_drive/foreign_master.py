#!/usr/bin/env python3
"""Frames that only a master sends, from a process that is not ours: one kind, once or periodically.

    foreign_master.py --bus vcan0 --node 5 KIND [--times N] [--period-ms T]
"""
import argparse
import socket
import struct
import time

KINDS = {
    "sync": lambda node, master: (0x080, b""),
    # Harmless to a drive that runs, so that what follows is the daemon's doing.
    "nmt": lambda node, master: (0x000, bytes([0x01, node])),
    "rpdo": lambda node, master: (0x200 + node, struct.pack("<Hh", 0x0F, 200)),
    "heartbeat": lambda node, master: (0x700 + master, b"\x05"),
    "sdo": lambda node, master: (0x600 + node, bytes([0x40, 0x00, 0x10, 0, 0, 0, 0, 0])),
}


class ForeignMaster:
    def __init__(self, bus):
        self.socket = socket.socket(socket.AF_CAN, socket.SOCK_RAW, socket.CAN_RAW)
        self.socket.bind((bus,))

    def send(self, kind, node, master=127):
        identifier, data = KINDS[kind](node, master)
        self.socket.send(struct.pack("<IB3x8s", identifier, len(data), data))

    def close(self):
        self.socket.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kind", choices=KINDS)
    parser.add_argument("--bus", default="vcan0")
    parser.add_argument("--node", type=int, default=5)
    parser.add_argument("--master", type=int, default=127, help="node number that its heartbeat claims")
    parser.add_argument("--times", type=int, default=1)
    parser.add_argument("--period-ms", type=float, default=10.0)
    arguments = parser.parse_args()
    foreign = ForeignMaster(arguments.bus)
    for _ in range(arguments.times):
        foreign.send(arguments.kind, arguments.node, arguments.master)
        time.sleep(arguments.period_ms / 1000.0)


if __name__ == "__main__":
    main()
