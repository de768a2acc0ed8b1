"""Faults on command: lines over a local socket, one answer each.

    [at SYNC | in SYNCS | past AXIS MM] FAULT
    freeze AXIS [flickering] | jump AXIS MM | reverse AXIS | lose_torque AXIS true|demand | weaken AXIS SHARE
    ignore AXIS | mode AXIS NUMBER | restart AXIS BOOT_MS | emcy AXIS CODE | fail AXIS CODE | mend AXIS
    status | end

`in` counts SYNCs from now; `past` waits until the table is that far from where it stood when the line came, in the direction of the
sign. "lose_torque demand": 0x6077 goes on showing what was asked for; "true": it shows what is. The answer to a fault that waits
comes at once; status says at which SYNC each was done. "ignore": the drive stands or coasts and takes bit 12 of its statusword back;
"mode": it falls into another mode of operation and shows it in 0x6061 only.
"""
import json
import socket


class FaultControl:
    def __init__(self, machine):
        self.machine = machine
        self.ended = False
        self.waiting = []  # (condition, words)
        self.done = []     # [SYNC, line]
        self._socket = None

    def listen(self, path):
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.bind(path)
        self._socket.setblocking(False)

    def fileno(self):
        return self._socket.fileno()

    def serve(self):
        while True:
            try:
                line, sender = self._socket.recvfrom(4096)
            except BlockingIOError:
                return
            try:
                answer = self._take(line.decode().split())
            except (ValueError, KeyError, IndexError) as error:
                answer = {"error": f"{type(error).__name__}: {error}"}
            self._socket.sendto(json.dumps(answer).encode(), sender)

    def _take(self, words):
        if words == ["status"]:
            return self._status()
        if words == ["end"]:
            self.ended = True
            return {"ok": True}
        machine = self.machine
        if words[0] == "at":
            number, words = int(words[1]), words[2:]
            self._wait(lambda: machine.sync_number >= number, words)
        elif words[0] == "in":
            number, words = machine.sync_number + int(words[1]), words[2:]
            self._wait(lambda: machine.sync_number >= number, words)
        elif words[0] == "past":
            plant, travel_m, words = machine.by_name[words[1]].servo.plant, float(words[2]) * 1e-3, words[3:]
            start_m, sign = plant.table_m, 1.0 if travel_m >= 0.0 else -1.0
            self._wait(lambda: sign * (plant.table_m - start_m) >= abs(travel_m), words)
        else:
            self._act(words)
        return {"ok": True}

    def _wait(self, condition, words):
        if words[0] not in ACTIONS or words[1] not in self.machine.by_name:
            raise ValueError(" ".join(words))
        self.waiting.append((condition, words))

    def at_sync(self):
        """Before the latch of this SYNC."""
        if not self.waiting:
            return
        due = [words for condition, words in self.waiting if condition()]
        self.waiting = [(condition, words) for condition, words in self.waiting if words not in due]
        for words in due:
            self._act(words)

    def _act(self, words):
        ACTIONS[words[0]](self.machine.by_name[words[1]], *words[2:])
        self.done.append([self.machine.sync_number, " ".join(words)])

    def _status(self):
        machine = self.machine
        machine.truth.flush()
        return {"sync_number": machine.sync_number, "free_running": machine.free_running, "done": self.done,
                "waiting": len(self.waiting),
                "axes": {d.name: {"state": d.servo.state, "nmt": d.nmt_state, "table_m": d.servo.plant.table_m,
                                  "table_velocity_m_s": d.servo.plant.table_m_s, "torque_Nm": d.servo.mean_torque_Nm,
                                  "off_and_at_rest": d.servo.is_off_and_at_rest()} for d in machine.drives}}


def _lose_torque(drive, how):
    if how not in ("true", "demand"):
        raise ValueError(how)
    drive.servo.gives_torque = False
    drive.servo.reports_demand = how == "demand"


def _jump(drive, mm):
    servo = drive.servo
    servo.encoder.jump(round(float(mm) * 1e-3 / servo.plant.m_per_rad / servo.rad_per_count))


def _weaken(drive, share):
    drive.servo.parameters.torque_constant_rel = float(share)


def _ignore(drive):
    drive.servo.ignores_target = True


def _mode(drive, number):
    drive.servo.mode = int(number)
    drive.servo.target_position_counts = drive.servo.position_counts


def _fail(drive, code):
    drive.emergency(int(code, 0))
    drive.servo.fail()


def _mend(drive):
    drive.servo.gives_torque = True
    drive.servo.reports_demand = False
    drive.servo.ignores_target = False
    if drive.servo.mode:
        drive.servo.mode = drive.node.sdo[0x6060].raw
    drive.servo.encoder.mend()


ACTIONS = {
    "freeze": lambda drive, how="": drive.servo.encoder.freeze(how == "flickering"),
    "jump": _jump,
    "reverse": lambda drive: drive.servo.encoder.reverse(drive.servo.plant.angle_rad),
    "lose_torque": _lose_torque,
    "weaken": _weaken,
    "ignore": _ignore,
    "mode": _mode,
    "restart": lambda drive, boot_ms: drive.boot(float(boot_ms)),
    "emcy": lambda drive, code: drive.emergency(int(code, 0)),
    "fail": _fail,
    "mend": _mend,
}
