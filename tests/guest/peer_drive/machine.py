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
import os
import select
import sys
import time
from pathlib import Path

import yaml

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from peer_drive.fault_control import FaultControl  # noqa: E402
from peer_drive.network import SocketNetwork  # noqa: E402
from peer_drive.node import DriveNode, NodeParameters  # noqa: E402

SYNC = 0x080
COLUMNS = ("motor_m", "table_m", "table_velocity_m_s", "torque_Nm", "demand_Nm", "counts", "statusword", "nmt")


class Machine:
    def __init__(self, config, network, truth_path, silence_ms):
        self.period_us = config["cycle_us"]
        self.network = network
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
        self.truth = open(truth_path, "w", encoding="utf-8", buffering=1 << 16)  # closed where the loop ends
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
        sockets = [self.network.socket, self.faults]
        while not self.faults.ended:
            ready, _, _ = select.select(sockets, [], [], 0.02)
            if self.faults in ready:
                self.faults.serve()
            # A master's heartbeats keep the socket busy while no SYNC comes.
            if self.network.socket not in ready or not self._receive():
                self._stand_still(time.monotonic())
        self.truth.close()

    def _receive(self):
        """Frames up to a SYNC, and its period; whether there was one."""
        while (frame := self.network.receive()) is not None:
            self.network.notify(*frame, 0.0)
            if self._due:
                self._due = False
                self.free_running = False
                self.period()
                self._last_sign = self._last_beat = time.monotonic()
                return True
        return False

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
    parser.add_argument("--config", required=True)
    parser.add_argument("--truth", required=True)
    parser.add_argument("--control", required=True, help="path of the socket that takes faults")
    parser.add_argument("--silence-ms", type=float, default=4000.0)
    parser.add_argument("--priority", type=int, help="of SCHED_FIFO: above the daemon's, where both share a processor")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="axes.x.boot_ms=2500")
    arguments = parser.parse_args()
    if arguments.priority:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(arguments.priority))
    config = yaml.safe_load(Path(arguments.config).read_text(encoding="utf-8"))
    for setting in arguments.set:
        key, _, value = setting.partition("=")
        place = config
        *path, last = key.split(".")
        for word in path:
            place = place.setdefault(word, {})
        place[last] = yaml.safe_load(value)
    machine = Machine(config, SocketNetwork(arguments.bus), arguments.truth, arguments.silence_ms)
    machine.faults.listen(arguments.control)
    machine.run()


if __name__ == "__main__":
    main()
