"""Codecs: the makers' own example frames, and what is left of frames that are damaged."""

import random
import struct
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tarsus import hardware
from tarsus.errors import BusError, InputError
from tarsus.hardware.codec import (
    dynamixel1,
    dynamixel2,
    feetech,
    lines,
    lx16a,
    maestro,
    packet,
    pca9685,
    servo2040,
    ssc32,
)
from tarsus.hardware.codec.dynamixel2_fast import fast_status, split_fast
from tarsus.hardware.codec.registers import Register, load_registers

IDS = (1, 2, 3)


def frame(text):
    return bytes.fromhex(text)


# Examples from the makers' documents.


@pytest.mark.parametrize(
    ("ours", "example"),
    [
        # ROBOTIS e-Manual, Protocol 1.0, "Ping", "Read".
        (dynamixel1.ping(1), "FF FF 01 02 01 FB"),
        (dynamixel1.read(1, 0x2B, 1), "FF FF 01 04 02 2B 01 CC"),
        # ROBOTIS e-Manual, Protocol 2.0, "Write", "Sync Read", "Sync Write", "Fast Sync Read".
        (dynamixel2.write(1, 116, struct.pack("<i", 512)), "FF FF FD 00 01 09 00 03 74 00 00 02 00 00 CA 89"),
        (dynamixel2.sync_read((1, 2), 132, 4), "FF FF FD 00 FE 09 00 82 84 00 04 00 01 02 CE FA"),
        (
            dynamixel2.sync_write(116, {1: struct.pack("<i", 150), 2: struct.pack("<i", 170)}),
            "FF FF FD 00 FE 11 00 83 74 00 04 00 01 96 00 00 00 02 AA 00 00 00 82 87",
        ),
        (dynamixel2.sync_read((3, 7, 4), 132, 4, fast=True), "FF FF FD 00 FE 0A 00 8A 84 00 04 00 03 07 04 20 F2"),
        # Pololu Maestro user's guide, 5.c, 5.d and 5.e.
        (maestro.set_targets(2, [6000]), "84 02 70 2E"),
        (maestro.set_targets(0, [6000], device=12), "AA 0C 04 00 70 2E"),
        (maestro.command(0x83, b"\x01", checked=True), "83 01 17"),
        # NXP PCA9685 data sheet, 7.3.5: 200 Hz from 25 MHz.
        (pca9685.set_prescale(pca9685.prescale(200)), "FE 1E"),
    ],
)
def test_frames_are_those_of_the_makers_documents(ours, example):
    assert ours == frame(example)


def test_answers_of_the_makers_documents_are_read():
    (one,) = packet.scan(frame("FF FF 01 03 00 20 DB")).frames
    assert (one.id, one.code, one.data) == (1, 0, b"\x20")
    two = dynamixel2.scan(
        frame("FF FF FD 00 01 08 00 55 00 A6 00 00 00 8C C0 FF FF FD 00 02 08 00 55 00 1F 08 00 00 BA BE")
    ).frames
    assert [(one.id, one.code, struct.unpack("<i", one.data)[0]) for one in two] == [(1, 0, 166), (2, 0, 2079)]
    # "Fast Sync Read": three servos in one packet, each CRC covers all that is before it.
    parts = ["FF FF FD 00 FE 19 00 55 00 03 A6 00 00 00 84 08", "00 07 1F 08 00 00 16 CA", "00 04 FF 03 00 00 D1 9E"]
    values = ((3, 166), (7, 2079), (4, 1023))
    ours = fast_status([(id, 0, struct.pack("<i", value)) for id, value in values])
    assert ours == tuple(frame(part) for part in parts)
    (whole,) = dynamixel2.scan(b"".join(ours)).frames
    split = split_fast(whole, 4)
    assert [(one.id, struct.unpack("<i", one.data)[0]) for one in split] == list(values)
    assert split_fast(whole, 3) == ()


def test_lines_of_an_ssc32_are_those_of_its_guide():
    assert ssc32.move({5: 1600, 10: 750}) == b"#5P1600#10P750\r"
    assert ssc32.move({5: 1500}, speeds={5: 750, 6: 100}) == b"#5P1500S750\r"
    assert ssc32.move({5: 0}, speeds={5: 750}) == b"#5P0\r"
    assert ssc32.query_pulses(3, 4) == b"QP3QP4\r"
    assert ssc32.read_pulses(b"\x96\x64") == (1500, 1000)


def test_a_servo2040_counts_as_its_firmware_does():
    assert servo2040.set_pins(2, [1500]) == frame("D3 02 01 5C 0B")
    (one,) = servo2040.scan(frame("C7 18 02 00 04 5D 11")).frames
    assert servo2040.values_in(one) == (512, 2269)
    assert servo2040.current(512) == 0
    assert servo2040.voltage(2269) == pytest.approx(7.31, abs=0.01)


def test_a_line_of_pulse_widths_has_a_checksum():
    line = lines.pulses([1500, 0])
    assert line == b"1500 0*14\n"
    assert lines.content(line) == "1500 0"
    assert lines.content(b"1501 0*14\n") is None
    assert lines.content(b"1500 0\n") is None
    assert lines.content(b"\xff*FF\n") is None
    assert lines.identity("tarsus 18") == 18
    assert lines.identity("tarsus x") is lines.identity("other 18") is None


def test_pulse_widths_survive_a_pca9685():
    rate = pca9685.frequency(pca9685.prescale(50))
    for width in (0, 500, 1500, 2500):
        steps = pca9685.counts(width, rate)
        assert pca9685.pulse_width(steps, rate) == pytest.approx(width, abs=2.5)
        assert pca9685.read_pulse(pca9685.pulses(0, [steps])[1:]) == steps
    assert pca9685.counts(1e9, rate) == 4095
    assert pca9685.pulses(3, [1])[0] == 6 + 12


def test_errors_in_answers_have_names():
    assert feetech.errors_in(0b100101) == ("voltage", "temperature", "overload")
    assert dynamixel1.errors_in(0b10000100) == ("temperature", "bit 7")
    assert dynamixel2.errors_in(0x87) == ("hardware", "register can't be written now")
    assert dynamixel2.errors_in(0x20) == ("error 32",)
    assert maestro.errors_in(0b100001) == ("serial signal", "serial timeout")


def test_a_maestro_takes_14_bits():
    with pytest.raises(InputError, match="0 to 16383, not 16384"):
        maestro.set_targets(0, [16384])


# Registers.


@pytest.mark.parametrize(
    ("sign", "size", "value", "content"),
    [
        ("", 2, 1000, "E8 03"),
        ("15", 2, -1000, "E8 83"),
        ("11", 2, -5, "05 08"),
        ("two", 2, -2, "FE FF"),
        ("two", 1, -1, "FF"),
        ("two", 4, 2079, "1F 08 00 00"),
    ],
)
def test_registers_are_encoded_both_ways(sign, size, value, content):
    one = Register("x", 0, size, "rw", sign, 1.0, "", "")
    assert one.encode(value) == frame(content)
    assert one.decode(frame(content)) == value
    assert one.decode(one.encode(value, byteorder="big"), byteorder="big") == value


@pytest.mark.parametrize(("sign", "value"), [("", -1), ("", 256), ("7", 128), ("two", -129), ("7", -129), ("7", -128)])
def test_what_a_register_cannot_hold_is_refused(sign, value):
    with pytest.raises(InputError, match="register x can't hold"):
        Register("x", 0, 1, "rw", sign, 1.0, "", "").encode(value)


@pytest.mark.parametrize(
    "name", ["feetech-sts", "feetech-scs", "dynamixel-x", "dynamixel-mx", "dynamixel-ax", "pca9685"]
)
def test_registers_have_a_source_and_do_not_overlap(name):
    table = sorted(load_registers(name).values(), key=lambda one: one.address)
    assert all(one.source for one in table)
    assert all(one.address + one.size <= other.address for one, other in pairwise(table))


# Damaged frames.

CODECS = {
    "packet": (packet.scan, packet.packet),
    "dynamixel2": (dynamixel2.scan, dynamixel2.status),
    "lx16a": (lx16a.scan, lx16a.frame),
    "servo2040": (servo2040.scan, lambda id, code, data: bytes((0xC7, id, len(data) // 2)) + data),
}
NAMES = sorted(CODECS)
some_data = st.binary(min_size=2, max_size=4).map(
    lambda data: bytes(byte & 0x7F for byte in data[: len(data) // 2 * 2])
)
some_frames = st.lists(st.tuples(st.integers(0, 20), st.integers(0, 2), some_data), min_size=1, max_size=5)


@given(st.sampled_from(NAMES), st.binary(max_size=60), st.booleans())
def test_any_bytes_are_frames_noise_or_a_rest(name, received, ended):
    scanned = CODECS[name][0](received, ended=ended)
    parts = [part if isinstance(part, bytes) else part.raw for part in scanned.parts]
    assert b"".join(parts) + scanned.rest == received
    assert not (ended and scanned.rest)


@given(st.sampled_from(NAMES), some_frames, st.lists(st.integers(0, 80), max_size=6))
def test_frames_are_found_however_they_arrive(name, contents, cuts):
    scan, build = CODECS[name]
    whole = b"".join(build(*content) for content in contents)
    found, rest = [], b""
    bounds = [0, *sorted(cut for cut in cuts if cut < len(whole)), len(whole)]
    for begin, end in pairwise(bounds):
        scanned = scan(rest + whole[begin:end])
        assert not scanned.damaged
        found += scanned.frames
        rest = scanned.rest
    assert not rest
    assert [(one.id, one.data) for one in found] == [(id, data) for id, _, data in contents]


@given(st.sampled_from(NAMES), some_frames, st.binary(min_size=1, max_size=8))
def test_frames_are_found_behind_noise(name, contents, noise):
    scan, build = CODECS[name]
    # Noise without the bytes that frames begin with.
    quiet = bytes(byte for byte in noise if byte not in (0xFF, 0x55, 0xC7)) or b"\x00"
    whole = quiet + b"".join(build(*content) for content in contents)
    assert len(scan(whole).frames) == len(contents)


# The protocols with checksums: one damaged byte, one lost byte or one byte too many, anywhere in the answers.
CHECKED = ("feetech-sts", "feetech-scs", "dynamixel-x", "dynamixel-mx", "dynamixel-ax", "lx16a")


@st.composite
def damage(draw):
    kind = draw(st.sampled_from(("change", "lose", "insert")))
    return kind, draw(st.integers(0, 200)), draw(st.integers(1, 255))


def damaged(data, kind, at, byte):
    at %= len(data)
    if kind == "change":
        return data[:at] + bytes((data[at] ^ byte,)) + data[at + 1 :]
    return data[:at] + (b"" if kind == "lose" else bytes((byte,))) + data[at + (kind == "lose") :]


@pytest.mark.parametrize("name", CHECKED)
@given(position=st.integers(0, 1000), hurt=damage(), telemetry=st.booleans())
def test_a_damaged_answer_is_never_believed(name, position, hurt, telemetry):
    bus, device = hardware.emulated_bus(name, IDS)
    for id, servo in device.servos.items():
        servo.place(position + id)
    truth = bus.read_telemetry(IDS).require()
    device.faults.delivered = lambda id, answer: damaged(answer, *hurt) if id == 2 else answer
    if telemetry:
        values = bus.read_telemetry(IDS).values
        assert all(values[id] == truth[id] for id in values)
    else:
        values = bus.read_positions(IDS).values
        assert all(values[id] == truth[id].position for id in values)
    # And afterwards everything is as before.
    del device.faults.delivered
    assert bus.read_telemetry(IDS).require() == truth


@pytest.mark.parametrize("name", CHECKED)
def test_no_mix_of_faults_makes_a_wrong_value_look_right(name):
    chance = random.Random(1)
    bus, device = hardware.emulated_bus(name, range(1, 7))
    for id, servo in device.servos.items():
        servo.place(100 + 31 * id)
    got = 0
    for _ in range(80):
        faults = device.faults
        faults.missing = {id for id in device.ids if chance.random() < 0.05}
        faults.corrupt = {id: 0.5 for id in device.ids if chance.random() < 0.2}
        faults.late = {id: chance.uniform(0, 0.08) for id in device.ids if chance.random() < 0.15}
        faults.echo = chance.random() < 0.3
        ids = chance.sample(device.ids, chance.randint(1, 6))
        if chance.random() < 0.6:
            positions = bus.read_positions(ids).values
        else:
            positions = {id: one.position for id, one in bus.read_telemetry(ids).values.items()}
        assert positions == {id: 100 + 31 * id for id in positions}
        got += len(positions)
    assert got > 80


@pytest.mark.parametrize("name", sorted(hardware.BUSES))
@given(noise=st.binary(max_size=40))
def test_noise_raises_none_but_our_errors(name, noise):
    bus, device = hardware.emulated_bus(name, IDS)
    if name == "pca9685":
        return
    device._answers = lambda: [(1, noise)]
    for action in (bus.read_positions, bus.read_telemetry, bus.scan):
        try:
            answers = action(IDS)
        except BusError:
            continue
        assert all(isinstance(error, BusError) for error in answers.errors)


@given(st.lists(st.binary(max_size=20), max_size=4))
@pytest.mark.parametrize("name", sorted(hardware.BUSES))
def test_emulated_servos_bear_any_bytes(name, requests):
    if name == "pca9685":
        return
    device = hardware.emulate(name, IDS)
    for at, request in enumerate(requests):
        device.receive(request, 0.01 * at)
    assert all(0 <= servo.position <= 4095 for servo in device.servos.values())
