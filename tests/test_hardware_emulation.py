"""Emulated servos: gear play, speed, heat and supply, and the queries that the buses do not need."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tarsus import hardware
from tarsus.hardware.codec import lines, lx16a, maestro, packet, servo2040, ssc32
from tarsus.hardware.emulation.pulses import PULSE_TRAITS

TRAITS = hardware.ServoTraits(per_turn=4096, lowest=0, highest=4095, speed=3000, play=8)


def servo_at(position, **traits):
    servo = hardware.EmulatedServo(hardware.ServoTraits(**{**TRAITS.__dict__, **traits}), position)
    servo.torque = True
    servo.advance(0.0, 1.0)
    return servo


def run(servo, until, step=0.01, supply=1.0):
    for tick in range(1, round(until / step) + 1):
        servo.advance(tick * step, supply)


def test_the_shaft_stays_behind_by_the_play_when_the_motor_reverses():
    up, down = servo_at(1000), servo_at(3000)
    up.goal = down.goal = 2000
    run(up, 1.0)
    run(down, 1.0)
    assert up.position == 2000 - TRAITS.play / 2
    assert down.position == 2000 + TRAITS.play / 2


@given(st.floats(0.2, 1.0), st.floats(50, 5000))
def test_speed_is_the_least_of_what_servo_supply_and_limit_allow(supply, limit):
    servo = servo_at(500, play=0)
    servo.goal, servo.speed_limit = 4000, limit
    servo.advance(0.1, supply)
    assert servo.speed == pytest.approx(min(3000 * supply, limit), rel=1e-6)
    assert servo.position == pytest.approx(500 + 0.1 * servo.speed)


def test_goals_beyond_the_travel_end_at_its_end():
    servo = servo_at(4000, play=0)
    servo.goal = 9000
    run(servo, 1.0)
    assert servo.position == 4095


def test_a_load_above_the_torque_limit_stops_the_motor():
    servo = servo_at(1000)
    servo.goal, servo.external, servo.torque_limit = 2000, 0.5, 0.4
    run(servo, 1.0)
    assert servo.position == 1000
    servo.torque_limit = 1.0
    servo.advance(3.0, 1.0)
    assert servo.position == pytest.approx(2000, abs=TRAITS.play)


def test_a_stalled_servo_heats_until_it_lets_go():
    servo = servo_at(1000)
    servo.goal, servo.stuck = 3000, True
    run(servo, 60.0, step=0.1)
    # 90 K at full drive, with a time constant of 90 s.
    assert servo.temperature == pytest.approx(25 + 90 * (1 - math.exp(-60 / 90)), abs=0.5)
    assert servo.current == pytest.approx(2.41)
    run(servo, 90.0, step=0.1)
    assert (servo.torque, servo.overheated) == (False, True)
    servo.advance(2000.0, 1.0)
    assert servo.temperature == pytest.approx(25, abs=0.1)


def test_a_limp_servo_is_turned_by_hand():
    servo = servo_at(1000)
    servo.torque = False
    servo.goal = 3000
    run(servo, 1.0)
    assert (servo.position, servo.load, servo.speed) == (1000, 0, 0)
    servo.place(1234.0)
    assert servo.position == 1234.0


def test_a_supply_sags_and_browns_out():
    supply = hardware.Supply(7.4, resistance=0.3)
    servos = [servo_at(1000) for _ in range(3)]
    for servo in servos:
        servo.goal = 4000
    supply.advance(0.01, servos)
    assert supply.voltage == pytest.approx(7.4 - 0.3 * 3 * 2.41)
    assert supply.up(0.01)
    supply.source = 6.0
    supply.advance(0.02, servos)
    assert not supply.up(0.02)
    assert not any(servo.torque for servo in servos)
    supply.advance(0.03, servos)
    assert not supply.up(0.03)
    assert supply.up(0.4)


def asked(name, request, ids=range(3), **options):
    """What the emulated servos answer to a request, after a goal to the first one."""
    device = hardware.emulate(name, ids, **options)
    bus = hardware.bus_over(name, hardware.MemoryTransport(device))
    bus.set_torque(None, True)
    bus.write_goals({0: 1600})
    return b"".join(one.data for one in device.receive(request, bus._transport.now() + 0.01))


@pytest.mark.parametrize(
    ("name", "request_", "answer"),
    [
        ("maestro", maestro.get_position(0), (6400).to_bytes(2, "little")),
        ("maestro", maestro.command(maestro.GET_MOVING), b"\x01"),
        ("maestro", b"\x12" + maestro.get_errors(), b"\x10\x00"),
        ("maestro", maestro.set_speed(9, 1) + maestro.command(maestro.GO_HOME), b""),
        ("ssc32", ssc32.query_pulses(0, 1), b"\xa0\x00"),
        ("ssc32", ssc32.MOVING, b"+"),
        ("ssc32", b" # 0 p 1700 \n\rqp 0\r", b"\xaa"),
        ("ssc32", b"#0X9\rQP0\r", b"\xa0"),
        ("servo2040", servo2040.get(0, 2), bytes((0xC7, 0, 2)) + servo2040.set_pins(0, (1600, 1500))[3:]),
        ("servo2040", b"\x00" + servo2040.get(0, 1), bytes((0xC7, 0, 1)) + servo2040.set_pins(0, (1600,))[3:]),
        ("lines", b"\xff\n" + lines.ASK, lines.checked("tarsus 18")),
        ("lines", lines.checked("1500") + lines.checked("hello"), b""),
    ],
)
def test_boards_answer_other_queries_too(name, request_, answer):
    assert asked(name, request_) == answer


def test_an_ssc32_keeps_pulses_in_its_range():
    device = hardware.emulate("ssc32", range(3))
    device.receive(b"#0P100#1P3000#2P1500S200T100\r", 0.0)
    assert device.pulses == {0: 500, 1: 2500, 2: 1500}
    assert device.servos[2].speed_limit == 200


def test_commands_that_arrive_in_pieces_are_put_together():
    for name, command in (
        ("maestro", maestro.set_targets(0, [6000, 6100])),
        ("servo2040", servo2040.set_pins(0, (1500, 1525))),
    ):
        device = hardware.emulate(name, range(2))
        device.receive(servo2040.set_pins(servo2040.RELAY, (1,)) if name == "servo2040" else b"", 0.0)
        for at, byte in enumerate(command):
            device.receive(bytes((byte,)), 0.001 * at)
        assert device.pulses == {0: 1500, 1: 1525}


def test_servos_without_travel_of_their_own_follow_pulses():
    device = hardware.emulate("lines", range(2), traits=PULSE_TRAITS)
    device.faults.missing = {1}
    device.receive(lines.pulses([1600] * 18), 0.0)
    assert device.positions(0.4) == pytest.approx({0: 1600 - PULSE_TRAITS.play / 2, 1: 1500})


def test_an_lx16a_moves_in_the_time_it_is_told():
    device = hardware.emulate("lx16a", (1,))
    device.receive(lx16a.frame(1, lx16a.MOVE, lx16a.encode_words(700, 1000)), 0.0)
    assert device.positions(0.5)[1] == pytest.approx(600, abs=4)
    assert device.positions(1.2)[1] == pytest.approx(700, abs=2)
    # A movement that was not announced does not begin, and one without data is none.
    device.receive(lx16a.frame(1, lx16a.MOVE_START) + lx16a.frame(1, lx16a.MOVE), 1.3)
    assert device.servos[1].goal == 700


def test_feetech_servos_with_status_level_0_do_not_confirm():
    device = hardware.emulate("feetech-sts", (1,))
    write = packet.packet(1, 3, bytes((42, 0, 4)))
    assert device.receive(write, 0.0)
    device.memory[1].set("status_level", 0)
    assert not device.receive(write, 0.1)
    assert not device.receive(packet.packet(9, 1), 0.2)
    assert not device.receive(packet.packet(1, 0x55), 0.3)
