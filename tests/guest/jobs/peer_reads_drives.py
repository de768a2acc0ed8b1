#!/usr/bin/env python3
"""An independent CANopen master (python-canopen) finds ordinary CiA 402 drives in the emulated machine: NMT, SDO, heartbeat,
PDO configuration, SYNC, and the walk to Operation Enabled.

    peer_reads_drives.py PROGRAMS CONFIG
"""
import struct
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from canopen_trace import drive_state  # noqa: E402
from machine_bench import MachineBench, expect, main  # noqa: E402

try:
    import canopen
except ImportError:
    print("SKIPPED: no python-canopen; tools/setup --all puts it into build/venv")
    sys.exit(77)

NODES = (1, 2)
VENDOR, PRODUCT = 0xC0D, 0x402


class Drive:
    """One drive through raw SDO and PDO: no EDS says beforehand what is where."""

    def __init__(self, network, node_id):
        self.network = network
        self.id = node_id
        self.node = canopen.RemoteNode(node_id, canopen.ObjectDictionary())
        network.add_node(self.node)
        self.node.sdo.RESPONSE_TIMEOUT = 2
        self.statusword = None
        self.boot_ups = 0
        network.subscribe(0x180 + node_id, self._on_tpdo)
        network.subscribe(0x700 + node_id, self._on_heartbeat)

    def _on_tpdo(self, _cob_id, data, _time):
        self.statusword, self.position, self.torque = struct.unpack("<Hih", data)

    def _on_heartbeat(self, _cob_id, data, _time):
        self.boot_ups += data[0] == 0

    def answers(self):
        try:
            return self.read(0x1000, 0) != 0
        except canopen.SdoCommunicationError:
            return False

    def read(self, index, sub_index, form="<I"):
        return struct.unpack(form, self.node.sdo.upload(index, sub_index))[0]

    def write(self, index, sub_index, value, form):
        self.node.sdo.download(index, sub_index, struct.pack(form, value))

    def configure_pdo(self, communication, mapping, cob_id, entries):
        self.write(communication, 1, cob_id | 1 << 31, "<I")
        self.write(mapping, 0, 0, "<B")
        for sub_index, entry in enumerate(entries, start=1):
            self.write(mapping, sub_index, entry, "<I")
        self.write(mapping, 0, len(entries), "<B")
        self.write(communication, 2, 1, "<B")
        self.write(communication, 1, cob_id, "<I")

    def configure(self):
        self.configure_pdo(0x1400, 0x1600, 0x200 + self.id, [0x60400010, 0x60710010])
        self.configure_pdo(0x1800, 0x1A00, 0x180 + self.id, [0x60410010, 0x60640020, 0x60770010])
        self.write(0x6060, 0, 10, "<b")
        self.write(0x1017, 0, 20, "<H")

    def command(self, controlword, torque=0):
        self.network.send_message(0x200 + self.id, struct.pack("<Hh", controlword, torque))


def walk(bench, network, drives):
    """Shutdown, switch on, enable operation; each drive shows the state that follows."""
    for controlword, state in ((0x06, "Ready To Switch On"), (0x07, "Switched On"), (0x0F, "Operation Enabled")):
        def reached(controlword=controlword, state=state):
            for drive in drives:
                drive.command(controlword)
            network.sync.transmit()
            return all(drive.statusword is not None and drive_state(drive.statusword) == state for drive in drives)

        bench.wait_for(f"state {state}", reached, seconds=20, pause_s=0.002)


def test(programs, out):
    with MachineBench(programs, sys.argv[2], out) as bench:
        bench.start_recording()
        bench.start_emulator()
        network = canopen.Network()
        network.connect(channel=bench.bus, interface="socketcan")
        drives = [Drive(network, node) for node in NODES]
        # A drive that answers has sent the boot-up message of its power-up: the next one is that of the reset. What is
        # sent to it in between is rightly lost.
        for drive in drives:
            bench.wait_for("an answer", drive.answers)
            drive.boot_ups = 0
        network.nmt.send_command(0x82)
        for drive in drives:
            bench.wait_for("the boot-up message", lambda drive=drive: drive.boot_ups > 0)
            identity = (drive.read(0x1018, 1), drive.read(0x1018, 2))
            expect(identity == (VENDOR, PRODUCT), f"node {drive.id} says it is {identity}")
            drive.configure()
        try:
            drives[0].node.sdo.download(0x2FFF, 0, b"\x00")
            raise AssertionError("writing an object that does not exist succeeded")
        except canopen.SdoAbortedError as error:
            expect(error.code == 0x06020000, f"an object that does not exist is refused with 0x{error.code:08X}")
        network.nmt.send_command(0x01)
        for drive in drives:
            bench.wait_for("Operational", lambda drive=drive: drive.node.nmt.state == "OPERATIONAL")
        walk(bench, network, drives)
        start = [drive.position for drive in drives]

        def pushed():
            for drive in drives:
                drive.command(0x0F, 300)
            network.sync.transmit()
            return all(drive.position > before + 100000 for drive, before in zip(drives, start))

        # 30 % of the rated torque is well above friction: positive torque moves towards positive position.
        bench.wait_for("the axes to follow a positive torque", pushed, seconds=20, pause_s=0.0005)
        network.disconnect()
    print(f"python-canopen {canopen.__version__} takes the emulated machine for {len(drives)} CiA 402 drives")


main(test)
