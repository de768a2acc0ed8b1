"""The drive's object dictionary, made in code: what a small CiA 402 drive with its own vendor's defaults has."""
import canopen
from canopen.objectdictionary import datatypes as types
from canopen.objectdictionary import ODRecord, ODVariable

VENDOR_ID, PRODUCT_CODE, REVISION = 0x5EE4, 0x17B, 0x10002

PDO_INVALID, NO_RTR = 1 << 31, 1 << 30
PDOS = 4
MAPPED_AT_MOST = 4
ERROR_HISTORY = 8
# As the master of this project maps them; a drive with fixed mapping has just these.
FIXED_RPDO = {10: [0x60400010, 0x60710010], 8: [0x60400010, 0x607A0020, 0x60B20010]}
FIXED_TPDO = [0x60410010, 0x60640020, 0x60770010]


class _Builder:
    def __init__(self):
        self.dictionary = canopen.ObjectDictionary()

    @staticmethod
    def _variable(name, index, sub_index, data_type, access, default):
        variable = ODVariable(name, index, sub_index)
        variable.data_type = data_type
        variable.access_type = access
        variable.default = default
        return variable

    def variable(self, index, name, data_type, default, access="rw"):
        self.dictionary.add_object(self._variable(name, index, 0, data_type, access, default))

    def record(self, index, name, members):
        """members: (sub-index, data type, access, default)"""
        record = ODRecord(name, index)
        record.add_member(self._variable("highest sub-index", index, 0, types.UNSIGNED8, "ro", members[-1][0]))
        for sub_index, data_type, access, default in members:
            record.add_member(self._variable(f"{name} {sub_index}", index, sub_index, data_type, access, default))
        self.dictionary.add_object(record)

    def pdo(self, communication, name, cob_id, transmission_type, mapping, fixed):
        access = "ro" if fixed else "rw"
        self.record(communication, f"{name} communication", [(1, types.UNSIGNED32, access, cob_id),
                                                             (2, types.UNSIGNED8, access, transmission_type)])
        record = ODRecord(f"{name} mapping", communication + 0x200)
        record.add_member(self._variable("entries", communication + 0x200, 0, types.UNSIGNED8, access, len(mapping)))
        for i in range(MAPPED_AT_MOST):
            value = mapping[i] if i < len(mapping) else 0
            record.add_member(self._variable(f"entry {i + 1}", communication + 0x200, i + 1, types.UNSIGNED32, access, value))
        self.dictionary.add_object(record)


def build(node_id, servo, read_only, fixed_pdos, mode):
    """The dictionary of one node.

    read_only: {index: value} of settings that cannot be written (of 0x60C2 and 0x1016 it is the value of sub-index 1);
    fixed_pdos: the first PDO each way cannot be changed and is right for that mode, the others do not exist.
    """
    b = _Builder()

    def access(index):
        return "ro" if index in read_only else "rw"

    def setting(index, name, data_type, default):
        b.variable(index, name, data_type, read_only.get(index, default), access(index))

    b.variable(0x1000, "device type", types.UNSIGNED32, 0x00020192, "ro")
    b.variable(0x1001, "error register", types.UNSIGNED8, 0, "ro")
    b.record(0x1003, "error history", [(i + 1, types.UNSIGNED32, "ro", 0) for i in range(ERROR_HISTORY)])
    b.dictionary[0x1003][0].access_type = "rw"
    b.dictionary[0x1003][0].default = 0
    setting(0x1006, "communication cycle period", types.UNSIGNED32, 0)
    b.variable(0x1015, "emergency inhibit time", types.UNSIGNED16, 0)
    b.record(0x1016, "heartbeat consumer", [(1, types.UNSIGNED32, access(0x1016), read_only.get(0x1016, 0))])
    b.variable(0x1017, "heartbeat producer", types.UNSIGNED16, 0)
    b.record(0x1018, "identity", [(1, types.UNSIGNED32, "ro", VENDOR_ID), (2, types.UNSIGNED32, "ro", PRODUCT_CODE),
                                  (3, types.UNSIGNED32, "ro", REVISION), (4, types.UNSIGNED32, "ro", 0x4711 + node_id)])
    b.record(0x1029, "error behaviour", [(1, types.UNSIGNED8, "rw", 0)])
    if fixed_pdos:
        b.pdo(0x1400, "RPDO1", 0x200 + node_id, 1, FIXED_RPDO[mode], True)
        b.pdo(0x1800, "TPDO1", NO_RTR | (0x180 + node_id), 1, FIXED_TPDO, True)
    else:
        # Defaults of a vendor: event-driven, another mapping, so that a master that relies on them fails.
        for i in range(PDOS):
            b.pdo(0x1400 + i, f"RPDO{i + 1}", (0x200 + 0x100 * i + node_id) | (PDO_INVALID if i > 1 else 0), 255, [0x60400010], False)
            b.pdo(0x1800 + i, f"TPDO{i + 1}", NO_RTR | (0x180 + 0x100 * i + node_id) | (PDO_INVALID if i > 1 else 0), 254,
                  [0x60410010], False)
    setting(0x6007, "abort connection option", types.INTEGER16, 1)
    b.variable(0x603F, "error code", types.UNSIGNED16, 0, "ro")
    b.variable(0x6040, "controlword", types.UNSIGNED16, 0)
    b.variable(0x6041, "statusword", types.UNSIGNED16, 0, "ro")
    setting(0x605A, "quick stop option", types.INTEGER16, 1)
    b.variable(0x605C, "disable operation option", types.INTEGER16, 1)
    b.variable(0x605E, "fault reaction option", types.INTEGER16, 2)
    b.variable(0x6060, "modes of operation", types.INTEGER8, 0)
    b.variable(0x6061, "modes of operation display", types.INTEGER8, 0, "ro")
    b.variable(0x6064, "position actual value", types.INTEGER32, 0, "ro")
    b.variable(0x6065, "following error window", types.UNSIGNED32, 0xFFFFFFFF)
    b.variable(0x606C, "velocity actual value", types.INTEGER32, 0, "ro")
    b.variable(0x6071, "target torque", types.INTEGER16, 0)
    setting(0x6072, "max torque", types.UNSIGNED16, round(1000 * servo.peak_torque_Nm / servo.rated_torque_Nm))
    b.variable(0x6076, "motor rated torque", types.UNSIGNED32, round(1000 * servo.rated_torque_Nm), "ro")
    b.variable(0x6077, "torque actual value", types.INTEGER16, 0, "ro")
    b.variable(0x607A, "target position", types.INTEGER32, 0)
    b.variable(0x607E, "polarity", types.UNSIGNED8, 0)
    setting(0x6085, "quick stop deceleration", types.UNSIGNED32,
               round(servo.quick_stop_deceleration_rad_s2 / 6.283185307179586 * servo.encoder_counts_per_rev))
    b.record(0x608F, "position encoder resolution",
             [(1, types.UNSIGNED32, "ro", servo.encoder_counts_per_rev), (2, types.UNSIGNED32, "ro", 1)])
    b.record(0x6091, "gear ratio", [(1, types.UNSIGNED32, "ro", 1), (2, types.UNSIGNED32, "ro", 1)])
    b.variable(0x60B2, "torque offset", types.INTEGER16, 0)
    b.record(0x60C2, "interpolation time", [(1, types.UNSIGNED8, access(0x60C2), read_only.get(0x60C2, 2)),
                                            (2, types.INTEGER8, access(0x60C2), -3)])
    b.variable(0x6502, "supported drive modes", types.UNSIGNED32, 1 << 9 | 1 << 7, "ro")
    return b.dictionary
