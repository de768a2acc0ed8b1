"""Does a recorded start-up read as CANopen to someone who knows it?"""
import canopen_trace as trace

COB_ID_INVALID = 1 << 31
WALK_UP = ["Switch On Disabled", "Ready To Switch On", "Switched On", "Operation Enabled"]


def _first(items, condition):
    return next((item for item in items if condition(item)), None)


def _network_management(frames, node):
    for position, frame in enumerate(frames):
        if frame.id == 0x000 and len(frame.data) == 2 and frame.data[1] in (0, node):
            yield position, frame.data[0]


def _check_identity(transfers, node):
    identity = [t for t in transfers if t.index == 0x1018 and not t.write and not t.aborted]
    first_write = _first(transfers, lambda t: t.write)
    for sub_index in (1, 2):
        if not any(t.sub_index == sub_index and t.position < first_write.position for t in identity):
            yield f"node {node}: identity 0x1018:{sub_index:02X} was not read before anything was written"


def _check_pdo(transfers, node, communication, mapping):
    """The order of CiA 301: PDO off, mapping off, entries, count, transmission type, PDO on; then read back."""
    name = f"node {node}: PDO 0x{communication:04X}"
    writes = [t for t in transfers if t.write and t.index in (communication, mapping) and not t.aborted]
    cob_ids = [t for t in writes if t.index == communication and t.sub_index == 1]
    counts = [t for t in writes if t.index == mapping and t.sub_index == 0]
    entries = [t for t in writes if t.index == mapping and t.sub_index > 0]
    types = [t for t in writes if t.index == communication and t.sub_index == 2]
    if len(cob_ids) < 2 or len(counts) < 2 or not entries or not types:
        yield f"{name} is not configured whole: {[f'{t.index:04X}:{t.sub_index:02X}' for t in writes]}"
        return
    if not cob_ids[0].value & COB_ID_INVALID or cob_ids[-1].value & COB_ID_INVALID:
        yield f"{name}: COB-ID is not switched off before and on after the configuration"
    if counts[0].value != 0 or counts[-1].value != len(entries):
        yield f"{name}: number of mapped objects does not go to 0 and then to {len(entries)}"
    order = [cob_ids[0], counts[0], *entries, counts[-1], types[-1], cob_ids[-1]]
    if [t.position for t in order] != sorted(t.position for t in order):
        yield f"{name}: not in the order COB-ID off, count 0, entries, count n, type, COB-ID on"
    if not 0 <= types[-1].value <= 240:
        yield f"{name}: transmission type {types[-1].value} does not follow SYNC"
    for written in [*entries, counts[-1], types[-1], cob_ids[-1]]:
        read_back = _first(transfers, lambda t: not t.write and t.position > written.position
                           and (t.index, t.sub_index) == (written.index, written.sub_index))
        if read_back is None:
            yield f"{name}: 0x{written.index:04X}:{written.sub_index:02X} was not read back"
        elif read_back.value != written.value:
            yield (f"{name}: 0x{written.index:04X}:{written.sub_index:02X} was written as 0x{written.value:X}"
                   f" and read back as 0x{read_back.value:X}")


def _check_heartbeats(transfers, node):
    for index, what in ((0x1016, "consumer"), (0x1017, "producer")):
        if not any(t.write and t.index == index and t.value and not t.aborted for t in transfers):
            yield f"node {node}: heartbeat {what} 0x{index:04X} was not set"


def _check_network_management(frames, transfers, node):
    commands = list(_network_management(frames, node))
    reset = _first(commands, lambda c: c[1] in (trace.NMT_RESET_COMMUNICATION, trace.NMT_PRE_OPERATIONAL))
    if reset is None or reset[0] > transfers[0].position:
        yield f"node {node}: neither reset nor taken to Pre-operational before SDO"
    start = _first(commands, lambda c: c[1] == trace.NMT_START)
    if start is None:
        yield f"node {node}: never started"
        return
    if start[0] < max(t.position for t in transfers if t.write):
        yield f"node {node}: started before it was configured"
    operational = _operational_position(frames, node, start[0])
    if operational is None:
        yield f"node {node}: no heartbeat says Operational after the start"
        return
    sync = _first(range(len(frames)), lambda i: frames[i].id == trace.SYNC)
    if sync is None:
        yield "there is no SYNC"
    elif sync < operational:
        yield f"SYNC came before node {node} was Operational"


def _operational_position(frames, node, after):
    return _first(range(after, len(frames)), lambda i: frames[i].id == 0x700 + node
                  and frames[i].data[0] & 0x7F == trace.HEARTBEAT_OPERATIONAL)


def _check_cycles(frames, nodes):
    """Between two SYNCs there is one TPDO and one RPDO of every node."""
    for number, cycle in enumerate(trace.cycles(frames), start=1):
        for node in nodes:
            for base, name in ((0x180, "TPDO"), (0x200, "RPDO")):
                count = sum(1 for frame in cycle if frame.id == base + node)
                if count != 1:
                    yield f"{count} {name}s of node {node} after SYNC {number}"
                    return


def _check_walk(frames, transfers, node):
    """One transition at a time up to Operation Enabled, and no torque before."""
    status = trace.pdo_layout(transfers, node, 0x1A00).get(0x6041)
    command = trace.pdo_layout(transfers, node, 0x1600)
    if status is None or 0x6040 not in command or 0x6071 not in command:
        yield f"node {node}: statusword, controlword or target torque is not mapped"
        return
    states, words = [], []
    for frame in frames:
        if frame.id == 0x180 + node:
            state = trace.drive_state(status.of(frame.data))
            if states[-1:] != [state]:
                states.append(state)
        elif frame.id == 0x200 + node:
            word = command[0x6040].of(frame.data)
            if words[-1:] != [word]:
                words.append(word)
            if command[0x6071].of(frame.data) != 0 and "Operation Enabled" not in states:
                yield f"node {node}: torque was sent before Operation Enabled"
                return
    if "Operation Enabled" not in states:
        yield f"node {node}: never reached Operation Enabled: {states}"
        return
    walked = states[:states.index("Operation Enabled") + 1]
    if walked[-len(WALK_UP):] != WALK_UP[-len(walked):]:
        yield f"node {node}: walked {walked}"
    low = [word & 0x0F for word in words]
    if [word for word in low if word in (0x06, 0x07, 0x0F)][:3] != [0x06, 0x07, 0x0F]:
        yield f"node {node}: controlwords {[hex(word) for word in words]}"


def problems(frames, nodes):
    """What is wrong with a trace from power-up to Operation Enabled, as sentences; empty when nothing is."""
    transfers = trace.sdo_transfers(frames)
    found = []
    for node in nodes:
        own = [t for t in transfers if t.node == node]
        if not any(t.write for t in own):
            found.append(f"node {node}: nothing was written over SDO")
            continue
        found += _check_identity(own, node)
        found += _check_pdo(own, node, 0x1400, 0x1600)
        found += _check_pdo(own, node, 0x1800, 0x1A00)
        found += _check_heartbeats(own, node)
        found += _check_network_management(frames, own, node)
        found += _check_walk(frames, own, node)
    return found + list(_check_cycles(frames, nodes))
