#!/usr/bin/env python3
"""A machine of python drives on a CAN bus: an independent peer for the daemon's master (python-canopen, own plant, own friction).

    machine.py --bus vcan0 --config peer.yaml --truth truth.csv --control peer.sock

The axes' time is SYNC: each SYNC latches, applies and advances everything by one period, so that a master in lock-step gets the same
answers whatever the host does. When no SYNC and no heartbeat of a master came for --silence-ms, time runs by the clock, so that the
drives can notice and stop by themselves. Faults come through the control socket (fault_control.py says how), at once or when a SYNC or
a place is reached. The truth is written for each SYNC: where motor and table really were when it came, and the torque that really
acted from it to the next.
"""
import argparse
import select
import sys
import time
from pathlib import Path

import can
import canopen
import yaml

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from peer_drive.fault_control import FaultControl  # noqa: E402
from peer_drive.node import DriveNode, NodeParameters  # noqa: E402

SYNC = 0x080
COLUMNS = ("motor_m", "table_m", "table_velocity_m_s", "torque_Nm", "demand_Nm", "counts", "statusword", "nmt")


class Periodic:
    """A frame that the library wants to be sent again and again: the heartbeat."""

    def __init__(self, network, cob_id, data, period_s):
        self.network, self.cob_id, self.data, self.period_ms = network, cob_id, data, period_s * 1000.0
        self.left_ms = self.period_ms

    def update(self, data):
        self.data = data

    def stop(self):
        self.network.periodic.discard(self)


class OurNetwork(canopen.Network):
    """No threads and no clock: the machine's loop reads the bus, hands frames in and says how much of its time has passed."""

    def __init__(self, channel, interface):
        super().__init__(can.Bus(channel=channel, interface=interface))
        self.periodic = set()

    def send_periodic(self, can_id, data, period, remote=False):
        del remote
        task = Periodic(self, can_id, data, period)
        self.periodic.add(task)
        return task

    def elapse(self, time_ms):
        for task in self.periodic:
            task.left_ms -= time_ms
            if task.left_ms <= 0.0:
                task.left_ms = task.period_ms
                self.send_message(task.cob_id, task.data)


class Machine:
    def __init__(self, config, bus, interface, truth_path, silence_ms):
        self.period_us = config["cycle_us"]
        self.network = OurNetwork(bus, interface)
        common = config.get("common", {})
        self.drives = []
        for number, (name, own) in enumerate(config["axes"].items()):
            servo = {**common.get("servo", {}), **own.pop("servo", {})}
            servo["plant"] = {**common.get("plant", {}), **own.pop("plant", {})}
            parameters = NodeParameters(**{**common.get("node", {}), **own, "name": name, "servo": servo,
                                           "cycle_us": self.period_us})
            self.drives.append(DriveNode(parameters, self.network, config.get("seed", 1) * 1000 + number))
        self.by_name = {drive.name: drive for drive in self.drives}
        self.network.subscribe(SYNC, self._on_sync)
        self.masters = {drive.parameters.master_node_id for drive in self.drives}
        for master in self.masters:
            self.network.subscribe(0x700 + master, self._on_master)
        self.sync_number = 0
        self.free_running = False
        self.silence_s = silence_ms / 1000.0
        self.faults = FaultControl(self)
        self._last_sign = self._last_beat = time.monotonic()
        self._due = False
        self.truth = open(truth_path, "w", encoding="utf-8", buffering=1 << 16)
        head = ["sync_number", "free_running"] + [f"{d.name}_{column}" for d in self.drives for column in COLUMNS]
        print(",".join(head), file=self.truth)

    def _on_master(self, _cob_id, _data, _time):
        self._last_sign = time.monotonic()

    def _on_sync(self, _cob_id, _data, _time):
        self._due = True

    def period(self):
        """What a SYNC does."""
        self.sync_number += not self.free_running
        self.faults.at_sync()
        before = [self._latched(drive) for drive in self.drives]
        if not self.free_running:
            for drive in self.drives:
                drive.latch_and_apply()
        for drive in self.drives:
            drive.advance(self.period_us)
        self._elapse(self.period_us / 1000.0)
        self._write(before)

    def _elapse(self, time_ms):
        self.network.elapse(time_ms)
        for drive in self.drives:
            drive.boot_on(time_ms)

    @staticmethod
    def _latched(drive):
        servo = drive.servo
        return servo.plant.motor_m, servo.plant.table_m, servo.plant.table_m_s, servo.position_counts

    def _write(self, before):
        words = [str(self.sync_number), str(int(self.free_running))]
        for drive, (motor_m, table_m, table_m_s, counts) in zip(self.drives, before):
            servo = drive.servo
            words += [f"{motor_m:.9f}", f"{table_m:.9f}", f"{table_m_s:.7f}", f"{servo.mean_torque_Nm:.6f}", f"{servo.demand_Nm:.6f}",
                      str(counts), f"0x{servo.statusword:04X}", str(drive.nmt_state)]
        self.truth.write(",".join(words) + "\n")

    def run(self):
        bus, sockets = self.network.bus, [self.network.bus, self.faults]
        while not self.faults.ended:
            ready, _, _ = select.select(sockets, [], [], 0.005)
            if self.faults in ready:
                self.faults.serve()
            if bus in ready:
                self._receive(bus)
            now = time.monotonic()
            if not self._due:
                self._stand_still(now)
        self.truth.close()
        self.network.disconnect()

    def _receive(self, bus):
        while (message := bus.recv(0)) is not None:
            if message.is_error_frame or message.is_extended_id:
                continue
            self.network.notify(message.arbitration_id, message.data, message.timestamp)
            if self._due:
                self._due = False
                self.free_running = False
                self._last_sign = self._last_beat = time.monotonic()
                self.period()
                return

    def _stand_still(self, now):
        """No SYNC: heartbeats and booting go by the clock; so does everything once the master is dead."""
        elapsed_ms = (now - self._last_beat) * 1000.0
        # SYNC that comes in its turn is not silence; the clock takes over where it stops.
        if elapsed_ms < 20.0:
            return
        self._last_beat = now
        if now - self._last_sign > self.silence_s and not all(drive.servo.is_off_and_at_rest() for drive in self.drives):
            self.free_running = True
            for _ in range(min(200, round(elapsed_ms * 1000.0 / self.period_us))):
                self.period()
            return
        self._elapse(elapsed_ms)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bus", default="vcan0")
    parser.add_argument("--interface", default="socketcan", help="of python-can")
    parser.add_argument("--config", required=True)
    parser.add_argument("--truth", required=True)
    parser.add_argument("--control", required=True, help="path of the socket that takes faults")
    parser.add_argument("--silence-ms", type=float, default=4000.0)
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="axes.x.boot_ms=2500")
    arguments = parser.parse_args()
    config = yaml.safe_load(Path(arguments.config).read_text(encoding="utf-8"))
    for setting in arguments.set:
        key, _, value = setting.partition("=")
        place = config
        *path, last = key.split(".")
        for word in path:
            place = place.setdefault(word, {})
        place[last] = yaml.safe_load(value)
    machine = Machine(config, arguments.bus, arguments.interface, arguments.truth, arguments.silence_ms)
    machine.faults.listen(arguments.control)
    machine.run()


if __name__ == "__main__":
    main()
