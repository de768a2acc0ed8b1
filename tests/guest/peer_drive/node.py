"""One drive on the bus: a Servo behind a canopen.LocalNode. The library serves SDO, NMT, PDO maps and EMCY; what it leaves to a device
is here: boot-up after a reset, heartbeats and the watch over the master's, what SYNC does, what a lost master does."""
import struct
from dataclasses import dataclass, field

import canopen

from . import object_dictionary
from .servo import CSP, CST, Servo, ServoParameters

NMT_START, NMT_STOP, NMT_PRE_OPERATIONAL, NMT_RESET_NODE, NMT_RESET_COMMUNICATION = 0x01, 0x02, 0x80, 0x81, 0x82
BOOTING, STOPPED, OPERATIONAL, PRE_OPERATIONAL = 0, 4, 5, 127
HEARTBEAT_LOST_CODE, RPDO_SHORT_CODE = 0x8130, 0x8210
COMMUNICATION_ERROR = 1 << 4
TEMPERATURE_ERROR = 1 << 3
ERROR_REGISTERS = {0x2: 1 << 1, 0x3: 1 << 2, 0x4: TEMPERATURE_ERROR, 0x8: COMMUNICATION_ERROR}


@dataclass
class NodeParameters:
    node_id: int = 1
    name: str = "x"
    boot_ms: int = 30
    read_only: dict = field(default_factory=dict)  # {object: value it holds and cannot be given another}
    fixed_pdos: bool = False
    fixed_mode: int = CST
    cycle_us: int = 1000
    master_node_id: int = 127
    servo: dict = field(default_factory=dict)


class DriveNode:

    def __init__(self, parameters, network, seed):
        p = self.parameters = parameters
        self.name = p.name
        self.servo = Servo(ServoParameters(**p.servo), seed)
        dictionary = object_dictionary.build(p.node_id, self.servo.parameters, p.read_only, p.fixed_pdos, p.fixed_mode)
        self.node = canopen.LocalNode(p.node_id, dictionary)
        self.network = network
        self.node.add_read_callback(self._on_read)
        self.node.add_write_callback(self._on_write)
        self.network.add_node(self.node)
        network.unsubscribe(0, self.node.nmt.on_command)
        network.subscribe(0, self._on_nmt)
        self._sdo_request = self.node.sdo.on_request
        network.unsubscribe(self.node.sdo.rx_cobid, self.node.sdo.on_request)
        network.subscribe(self.node.sdo.rx_cobid, self._on_sdo)
        self.errors = []
        self.error_register = 0
        self.watched_node = None
        self._watch(0)
        self._boot_left_ms = None
        self._rpdo = self._tpdo = None
        self._pending_rpdo = None
        self.boot(p.boot_ms)

    # Life -------------------------------------------------------------------------------------------------------

    @property
    def nmt_state(self):
        return self.node.nmt._state

    def boot(self, boot_ms, power=True):
        """Falls silent for that long, then sends its boot-up message; after a loss of power everything begins anew."""
        self._leave_operational()
        self.node.data_store.clear()
        self._watch(0)
        self.node.nmt.stop_heartbeat()
        self._lost_power = power
        if power:
            self.servo.power_up()
            self.errors = []
            self.error_register = 0
        self.node.nmt._state = BOOTING
        self._boot_left_ms = boot_ms
        if boot_ms <= 0:
            self._booted()

    def _booted(self):
        self._boot_left_ms = None
        if self._lost_power:
            self.servo.start_counting()
        self.node.nmt.send_command(0)
        self._set_nmt(PRE_OPERATIONAL)

    def _set_nmt(self, state):
        self.node.nmt._state = state
        self.node.nmt.update_heartbeat()

    def is_silent(self):
        return self._boot_left_ms is not None

    def _on_nmt(self, _cob_id, data, _time):
        command, node = struct.unpack_from("BB", data)
        if node not in (0, self.parameters.node_id) or self.is_silent():
            return
        if command == NMT_START:
            self._set_nmt(OPERATIONAL)
            self._enter_operational()
        elif command == NMT_STOP:
            self._lose_the_master()
            self._set_nmt(STOPPED)
        elif command == NMT_PRE_OPERATIONAL:
            if self.nmt_state == OPERATIONAL:
                self._lose_the_master()
            self._set_nmt(PRE_OPERATIONAL)
            self._leave_operational()
        elif command in (NMT_RESET_NODE, NMT_RESET_COMMUNICATION):
            if self.nmt_state == OPERATIONAL:
                self._lose_the_master()
            self.boot(self.parameters.boot_ms, power=command == NMT_RESET_NODE)

    def _lose_the_master(self):
        """0x6007: what becomes of the axis when nobody leads it any more."""
        option = self._value(0x6007)
        if option == 3:
            self.servo.quick_stop()
        elif option == 2:
            self.servo.command(0)
        elif option == 1:
            self.servo.fail()

    def _leave_operational(self):
        for pdo in (self._rpdo,):
            if pdo is not None and pdo.enabled:
                self.network.unsubscribe(pdo.cob_id, pdo.on_message)
        self._rpdo = self._tpdo = None
        self._pending_rpdo = None

    def _enter_operational(self):
        self._leave_operational()
        rpdo, tpdo = self.node.rpdo[1], self.node.tpdo[1]
        rpdo.callbacks = [self._on_rpdo]
        rpdo.read()
        tpdo.read()
        if tpdo.enabled:  # read() listens to what is its own to send
            self.network.unsubscribe(tpdo.cob_id, tpdo.on_message)
        self._rpdo, self._tpdo = rpdo, tpdo

    # The wire ---------------------------------------------------------------------------------------------------

    def _on_sdo(self, cob_id, data, time):
        if not self.is_silent() and self.nmt_state != STOPPED:
            self._sdo_request(cob_id, data, time)

    def _on_read(self, index, subindex, od):
        del od
        servo = self.servo
        if index == 0x1003:
            return len(self.errors) if subindex == 0 else self.errors[subindex - 1] if subindex <= len(self.errors) else 0
        simple = {0x1001: lambda: self.error_register, 0x603F: lambda: self.errors[0] & 0xFFFF if self.errors else 0,
                  0x6041: lambda: servo.statusword, 0x6061: lambda: servo.mode, 0x6064: lambda: self._position(),
                  0x6077: lambda: servo.actual_torque_per_mille}
        return simple[index]() if index in simple else None

    def _on_write(self, index, subindex, od, data):
        value = od.decode_raw(data)
        servo = self.servo
        if index == 0x1003 and value != 0:
            raise canopen.SdoAbortedError(0x06090030)
        if index == 0x1003:
            self.errors = []
        elif index == 0x1016:
            self._watch(value)
        elif 0x1600 <= index <= 0x1603 and self._pdo_valid(index - 0x200):
            raise canopen.SdoAbortedError(0x08000022)  # only while the PDO is switched off
        elif 0x1A00 <= index <= 0x1A03 and self._pdo_valid(index - 0x200):
            raise canopen.SdoAbortedError(0x08000022)
        elif index == 0x6040:
            servo.command(value)
        elif index == 0x605A:
            servo.quick_stop_option = value
        elif index == 0x605E:
            servo.fault_reaction_option = value
        elif index == 0x6060:
            if value not in (CSP, CST):
                raise canopen.SdoAbortedError(0x06090030)
            servo.mode = value
        elif index == 0x6072:
            servo.torque_limit_per_mille = value
        elif index == 0x6085:
            servo.quick_stop_deceleration_rad_s2 = value * servo.rad_per_count
        del subindex

    def _pdo_valid(self, communication):
        return self.node.sdo[communication][1].raw & object_dictionary.PDO_INVALID == 0

    def _value(self, index):
        return self.node.sdo[index].raw

    def _position(self):
        """As it goes onto the wire: 32 bits that wrap."""
        return (self.servo.position_counts + 2**31) % 2**32 - 2**31

    def _watch(self, value):
        node, time_ms = value >> 16 & 0xFF, value & 0xFFFF
        if self.watched_node is not None:
            self.network.unsubscribe(0x700 + self.watched_node, self._on_masters_heartbeat)
        self.watched_node = node if node and time_ms else None
        self.watch_ms = time_ms
        self._watch_left_ms = None  # begins with the first heartbeat
        if self.watched_node is not None:
            self.network.subscribe(0x700 + self.watched_node, self._on_masters_heartbeat)

    def _on_masters_heartbeat(self, _cob_id, _data, _time):
        self._watch_left_ms = self.watch_ms

    def _on_rpdo(self, pdo):
        if len(pdo.data) * 8 < pdo.length:
            self.emergency(RPDO_SHORT_CODE)
            return
        if pdo.trans_type >= 254:
            self._apply(pdo)
        else:
            self._pending_rpdo = pdo

    def _apply(self, pdo):
        controlword = None
        for variable in pdo.map:
            if variable.index == 0x6040:
                controlword = variable.raw
            elif variable.index == 0x6071:
                self.servo.target_torque_per_mille = variable.raw
            elif variable.index == 0x607A:
                # The nearest of the counts that look like this one.
                wire = variable.raw
                self.servo.target_position_counts = wire + round((self.servo.position_counts - wire) / 2**32) * 2**32
            elif variable.index == 0x60B2:
                self.servo.torque_offset_per_mille = variable.raw
        if controlword is not None:
            self.servo.command(controlword)

    def emergency(self, code, register=None, vendor=b""):
        """Sends it and remembers it; whether the drive also stops is another matter."""
        if code == 0:
            self.error_register = 0
            self.errors = []
        else:
            bit = ERROR_REGISTERS.get(code >> 12, 1 << 7) if register is None else register
            self.error_register |= 1 | bit
            self.errors = ([code] + self.errors)[:object_dictionary.ERROR_HISTORY]
        if self.nmt_state in (OPERATIONAL, PRE_OPERATIONAL):
            self.node.emcy.send(code, self.error_register, vendor)

    # Time -------------------------------------------------------------------------------------------------------

    def latch_and_apply(self):
        """At a SYNC: the feedback of this instant goes out, the set-point that came before it acts."""
        if self.nmt_state != OPERATIONAL:
            return
        tpdo = self._tpdo
        if tpdo.enabled and tpdo.trans_type <= 240:
            values = {0x6041: self.servo.statusword, 0x6064: self._position(), 0x6077: self.servo.actual_torque_per_mille}
            for variable in tpdo.map:
                variable.raw = values[variable.index]
            tpdo.transmit()
        if self._pending_rpdo is not None:
            self._apply(self._pending_rpdo)
            self._pending_rpdo = None

    def advance(self, period_us):
        """The axis, the drive and its watches, one period on."""
        self.servo.advance(period_us)
        if self._watch_left_ms is not None:
            self._watch_left_ms -= period_us / 1000.0
            if self._watch_left_ms < 0.0:
                self._watch_left_ms = None
                self.emergency(HEARTBEAT_LOST_CODE)
                if self.nmt_state == OPERATIONAL:
                    self._lose_the_master()
                    self._set_nmt(PRE_OPERATIONAL)
                    self._leave_operational()

    def boot_on(self, elapsed_ms):
        """Booting goes on while the axis's time stands still, too."""
        if self._boot_left_ms is not None:
            self._boot_left_ms -= elapsed_ms
            if self._boot_left_ms <= 0:
                self._booted()
