"""CANopen as seen on the wire: reads what `candump -L` wrote and names what each frame says."""
import struct
from typing import NamedTuple

SYNC = 0x080
NMT_START, NMT_STOP, NMT_PRE_OPERATIONAL, NMT_RESET_NODE, NMT_RESET_COMMUNICATION = 0x01, 0x02, 0x80, 0x81, 0x82
HEARTBEAT_BOOT_UP, HEARTBEAT_OPERATIONAL = 0x00, 0x05

# CiA 402: statusword & mask == value
DRIVE_STATES = [
    (0x4F, 0x00, "Not Ready To Switch On"), (0x4F, 0x40, "Switch On Disabled"), (0x6F, 0x21, "Ready To Switch On"),
    (0x6F, 0x23, "Switched On"), (0x6F, 0x27, "Operation Enabled"), (0x6F, 0x07, "Quick Stop Active"),
    (0x4F, 0x0F, "Fault Reaction Active"), (0x4F, 0x08, "Fault"),
]


class Frame(NamedTuple):
    time_s: float
    id: int
    data: bytes


class Sdo(NamedTuple):
    """One SDO transfer, request and reply together."""
    node: int
    write: bool
    index: int
    sub_index: int
    value: int  # what was written or read; the abort code when aborted
    aborted: bool
    position: int  # of the request in the trace


def read(path):
    """Frames of a candump log, oldest first; lines that are no whole frame (the last one may be cut) are left out."""
    frames = []
    with open(path, encoding="ascii", errors="replace") as file:
        for line in file:
            words = line.split()
            if len(words) < 3 or not line.endswith("\n") or "#" not in words[2]:
                continue
            identifier, _, data = words[2].partition("#")
            if len(identifier) == 3 and not data.startswith("R"):
                frames.append(Frame(float(words[0].strip("()")), int(identifier, 16), bytes.fromhex(data)))
    return frames


def drive_state(statusword):
    return next((name for mask, value, name in DRIVE_STATES if statusword & mask == value), "unknown")


def sdo_transfers(frames):
    """All finished expedited SDO transfers, in the order of their requests."""
    found, open_requests = [], {}
    for position, frame in enumerate(frames):
        if len(frame.data) != 8:
            continue
        if 0x601 <= frame.id <= 0x67F:
            open_requests[frame.id - 0x600] = (position, frame.data)
        elif 0x581 <= frame.id <= 0x5FF and frame.id - 0x580 in open_requests:
            node = frame.id - 0x580
            start, request = open_requests.pop(node)
            index, sub_index = struct.unpack_from("<HB", request, 1)
            write, aborted = request[0] >> 5 == 1, frame.data[0] == 0x80
            source = request if write and not aborted else frame.data
            size = 4 if aborted else 4 - (source[0] >> 2 & 3)
            value = int.from_bytes(source[4:4 + size], "little")
            found.append(Sdo(node, write, index, sub_index, value, aborted, start))
    return sorted(found, key=lambda transfer: transfer.position)


class PdoField(NamedTuple):
    offset: int
    size: int
    signed: bool

    def of(self, data):
        return int.from_bytes(data[self.offset:self.offset + self.size], "little", signed=self.signed)


SIGNED_OBJECTS = {0x6064, 0x6071, 0x6077, 0x607A, 0x60B2, 0x60E4}


def pdo_layout(transfers, node, mapping_index):
    """Fields of a PDO as the master mapped them: {object index: PdoField}."""
    entries = {}
    for transfer in transfers:
        if transfer.node == node and transfer.write and transfer.index == mapping_index and not transfer.aborted:
            if transfer.sub_index == 0:
                count = transfer.value
            else:
                entries[transfer.sub_index] = transfer.value
    layout, offset = {}, 0
    for sub_index in range(1, (count if entries else 0) + 1):
        index, size = entries[sub_index] >> 16, (entries[sub_index] & 0xFF) // 8
        layout[index] = PdoField(offset, size, index in SIGNED_OBJECTS)
        offset += size
    return layout


def cycles(frames):
    """Frames between one SYNC and the next, a list for each SYNC but the last, the SYNC itself left out."""
    found = None
    for frame in frames:
        if frame.id == SYNC:
            if found is not None:
                yield found
            found = []
        elif found is not None:
            found.append(frame)
