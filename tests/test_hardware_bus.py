"""Servo buses on emulated servos: what is measured, what is refused, and what is said about faults."""

import math
import random

import pytest

from tarsus import hardware
from tarsus.errors import (
    BusError,
    CorruptAnswerError,
    InputError,
    NoAnswerError,
    PortError,
    ServoStatusError,
    UnknownNameError,
)
from tarsus.hardware.codec import dynamixel2, lx16a, packet

IDS = range(9)
SMART = ("feetech-sts", "feetech-scs", "dynamixel-x", "dynamixel-mx", "dynamixel-ax", "lx16a")
BOARDS = ("maestro", "ssc32", "servo2040", "lines", "pca9685")


@pytest.fixture(params=SMART)
def smart(request):
    return opened(request.param)


@pytest.fixture(params=BOARDS)
def board(request):
    return opened(request.param)


@pytest.fixture(params=SMART + BOARDS)
def any_bus(request):
    return opened(request.param)


def opened(name, **options):
    bus, device = hardware.emulated_bus(name, IDS, **options)
    bus.set_torque(None, True)
    return bus, device


def clock(bus):
    return bus._transport.clock


def drive(bus, goals, seconds=0.8, tick=0.02):
    for _ in range(round(seconds / tick)):
        bus.write_goals(goals)
        clock(bus).sleep(tick)


def middle(bus):
    return (bus.capabilities.lowest + bus.capabilities.highest) / 2


def shafts(bus, device):
    return device.positions(clock(bus).now())


def test_each_bus_has_emulated_servos_and_is_tested_here():
    assert set(SMART + BOARDS) == set(hardware.BUSES)


def test_servos_go_where_they_are_sent(any_bus):
    bus, device = any_bus
    goals = {id: middle(bus) + 8 * (id - 9) for id in IDS}
    drive(bus, goals)
    traits = device.servos[0].traits
    # Pulses of a PCA9685 have steps of 5 us.
    step = 5 if bus.name == "pca9685" else 1
    assert shafts(bus, device) == pytest.approx(goals, abs=traits.play / 2 + step)


def test_what_is_measured_is_where_the_shafts_are(smart):
    bus, device = smart
    drive(bus, {id: middle(bus) + 8 * (id - 9) for id in IDS})
    assert bus.read_positions(IDS).require() == pytest.approx(shafts(bus, device), abs=0.5)


def test_a_board_measures_no_positions(board):
    bus, _ = board
    assert not bus.capabilities.positions
    assert bus.read_positions(IDS) == hardware.Answers()


def test_telemetry_has_what_the_capabilities_say(any_bus):
    bus, _ = any_bus
    drive(bus, {3: middle(bus)})
    telemetry = bus.read_telemetry((3,)).values.get(3, hardware.Telemetry())
    known = {name for name in telemetry.__slots__ if getattr(telemetry, name) is not None}
    assert known | {"alarms"} == bus.capabilities.telemetry | {"alarms"}
    if telemetry.voltage is not None:
        nominal = 12.0 if bus.name.startswith("dynamixel") else 7.4
        assert telemetry.voltage == pytest.approx(nominal, abs=0.4)


def test_a_scan_finds_who_is_there(smart):
    bus, device = smart
    device.faults.missing = {3}
    assert set(bus.scan((2, 3, 4, 200)).require()) == {2, 4}


def test_a_scan_waits_once_for_each_id_that_is_missing(smart):
    bus, _ = smart
    begin = clock(bus).now()
    bus.scan(range(100, 120))
    assert clock(bus).now() - begin < 20 * 0.03


def test_a_scan_finds_channels_of_boards(board):
    bus, device = board
    assert set(bus.scan().require()) == set(bus.capabilities.ids)
    device.faults.unplugged = True
    with pytest.raises(PortError, match="unplugged"):
        bus.ping(0)


def test_torque_is_switched_off_one_by_one_and_all_at_once(any_bus):
    bus, device = any_bus
    drive(bus, dict.fromkeys(IDS, middle(bus)), 0.1)
    assert bus.set_torque((2, 3), False)
    device.advance(clock(bus).now() + 0.001)
    on = {id for id, servo in device.servos.items() if servo.torque}
    # The relay of a Servo2040 is one for all.
    assert on == (set() if bus.name == "servo2040" else set(IDS) - {2, 3})
    assert bus.set_torque(None, False)
    device.advance(clock(bus).now() + 0.002)
    assert not any(servo.torque for servo in device.servos.values())


def test_a_missing_servo_is_named_and_the_others_are_read(smart):
    bus, device = smart
    device.faults.missing = {3}
    answers = bus.read_positions((2, 3, 4))
    assert set(answers.values) == {2, 4}
    assert [(type(error), error.id) for error in answers.errors] == [(NoAnswerError, 3)]
    with pytest.raises(NoAnswerError, match=r"id 3: expected an answer with \d bytes of data, received nothing"):
        answers.require()
    assert [error.id for error in bus.read_telemetry((2, 3)).errors] == [3]


def test_a_missing_servo_is_told_from_a_damaged_answer(smart):
    bus, device = smart
    device.faults.missing, device.faults.corrupt = {3}, {5: 1.0}
    device.faults._random = random.Random(4)
    seen = set()
    for _ in range(20):
        answers = bus.read_positions((2, 3, 4, 5, 6))
        assert 3 in {error.id for error in answers.errors}
        seen.add(tuple(type(error) for error in answers.errors if error.id in (3, 5)))
    assert (NoAnswerError, CorruptAnswerError) in seen


def test_an_answer_to_something_else_is_shown():
    bus, device = opened("lx16a")
    device._answers = lambda: [(4, lx16a.frame(4, lx16a.POSITION_READ, b"\x00\x01"))]
    (error,) = bus.read_positions((3,)).errors
    assert isinstance(error, NoAnswerError)
    assert "55 55 04 05 1C 00 01 D9, which answers something else" in str(error)


def test_a_missing_servo_is_noticed_in_time(smart):
    bus, device = smart
    device.faults.missing = {3}
    begin = clock(bus).now()
    assert bus.read_positions((2, 3, 4)).errors
    assert clock(bus).now() - begin < 0.1


def test_two_servos_with_one_id_are_noticed(smart):
    bus, device = smart
    drive(bus, dict.fromkeys(IDS, middle(bus) + 1), 0.5)
    device.faults.duplicate = {3}
    answers = bus.read_positions((2, 3, 4))
    assert set(answers.values) == {2, 4}
    assert [(type(error), error.id) for error in answers.errors] == [(CorruptAnswerError, 3)]
    assert "two servos with one id" in str(answers.errors[0])


def test_an_answer_that_comes_twice_is_not_believed():
    bus, device = opened("lx16a")
    honest = device._answers
    device._answers = lambda: [one for one in honest() for _ in range(2)]
    bus.read_positions((3,))
    # The second answer to the first request is still on its way: it is thrown away.
    assert bus.read_positions((4,)).require() == {4: 500.0}
    bus, device = opened("feetech-sts")
    honest = device._answers
    device._answers = lambda: [one for one in honest() for _ in range(2)]
    answers = bus.read_positions((3, 4))
    assert answers.errors[0].id == 3
    assert "two servos with this id" in str(answers.errors[0])


def test_an_echo_is_no_answer(smart):
    bus, device = smart
    drive(bus, dict.fromkeys(IDS, middle(bus)), 0.1)
    device.faults.echo = True
    drive(bus, dict.fromkeys(IDS, middle(bus)), 0.1)
    assert bus.read_positions((1, 2, 3)).require() == pytest.approx(
        {id: shafts(bus, device)[id] for id in (1, 2, 3)}, abs=0.5
    )
    device.faults.missing = {2}
    assert bus.ping(2) is None
    assert "only the echo" in str(bus.read_positions((2,)).errors[0])


def test_boards_are_found_behind_an_echo(board):
    bus, device = board
    device.faults.echo = True
    bus.write_goals({0: 1500})
    assert bus.ping(0)


def test_late_answers_are_never_taken_for_those_of_others(smart):
    bus, device = smart
    goals = {id: middle(bus) + 12 * (id - 9) for id in IDS}
    drive(bus, goals)
    device.faults.late = {3: 0.03}
    truth = {id: round(position) for id, position in shafts(bus, device).items()}
    for ids in ((3,), (4,), (3, 4, 5), (5, 6)):
        answers = bus.read_positions(ids)
        assert all(answers.values[id] == truth[id] for id in answers.values)
        assert {error.id for error in answers.errors} <= {3}


def test_after_a_fault_the_bus_recovers(smart):
    bus, device = smart
    device.faults.corrupt = {3: 1.0}
    assert 3 not in bus.read_positions((2, 3, 4)).values
    device.faults.corrupt.clear()
    assert set(bus.read_positions((2, 3, 4)).require()) == {2, 3, 4}


def test_limits_are_kept_by_the_servo(smart):
    bus, device = smart
    bus.set_torque(None, False)
    middle_goal = round(middle(bus))
    assert bus.set_limits(2, middle_goal - 100, middle_goal + 20)
    bus.set_torque(None, True)
    drive(bus, {2: middle_goal + 90})
    assert shafts(bus, device)[2] == pytest.approx(middle_goal + 20, abs=device.servos[2].traits.play)


def test_limits_that_a_servo_refuses_are_an_error():
    bus, _ = opened("dynamixel-x")
    with pytest.raises(ServoStatusError, match=r"be written now.\. Switch its torque off"):
        bus.set_limits(2, 1000, 2000)
    bus, device = opened("lx16a")
    device._limits = {2: (0, 1000)}
    with pytest.raises(ServoStatusError, match="received 0 and 1000"):
        bus.set_limits(2, 500, 500)


def test_speed_is_limited_where_the_bus_can(any_bus):
    bus, device = any_bus
    drive(bus, {2: middle(bus)}, 0.6)
    limit = device.servos[2].traits.speed / 10
    assert bus.set_speed_limit((2,), limit) == bus.capabilities.speed_limit
    before = shafts(bus, device)[2]
    drive(bus, {2: middle(bus) + 200}, 0.2)
    way = shafts(bus, device)[2] - before
    expected = 0.2 * limit if bus.capabilities.speed_limit else 200
    assert way == pytest.approx(expected, rel=0.25, abs=device.servos[2].traits.play)
    bus.set_speed_limit((2,), None)
    drive(bus, {2: middle(bus) + 200}, 0.6)
    assert shafts(bus, device)[2] == pytest.approx(middle(bus) + 200, abs=10)


def test_torque_is_limited_where_the_bus_can(any_bus):
    bus, device = any_bus
    drive(bus, {2: middle(bus)}, 0.1)
    assert bus.set_torque_limit((2,), 0.25) == bus.capabilities.torque_limit
    assert device.servos[2].torque_limit == pytest.approx(0.25 if bus.capabilities.torque_limit else 1.0, abs=0.01)


def test_the_watchdog_acts_where_there_is_one(any_bus):
    bus, device = any_bus
    action = bus.capabilities.watchdog_action
    assert bus.set_watchdog(IDS, 0.2) == (action != "none") == (bus.capabilities.watchdog is not None)
    drive(bus, dict.fromkeys(IDS, middle(bus)), 0.3)
    bus.set_speed_limit(IDS, device.servos[0].traits.speed / 50)
    bus.write_goals(dict.fromkeys(IDS, middle(bus) + 200))
    # Nobody sends any more.
    at = clock(bus).now()
    stopped = device.positions(at + 0.25)
    later = device.positions(at + 1.0)
    if action == "hold":
        assert later == pytest.approx(stopped, abs=1)
        assert device.servos[2].torque
        bus.write_goals({2: middle(bus)})
        assert device.servos[2].goal != middle(bus)
        assert bus.set_watchdog((2,), None)
        bus.write_goals({2: middle(bus)})
        assert device.servos[2].goal == round(middle(bus))
    elif action == "release":
        assert not any(servo.torque for servo in device.servos.values())
    else:
        assert all(servo.torque for servo in device.servos.values())


@pytest.mark.parametrize("name", ["dynamixel-x", "lines"])
def test_the_watchdog_acts_in_time_also_if_nobody_looks(name):
    bus, device = opened(name)
    bus.set_watchdog(IDS, 0.2)
    drive(bus, dict.fromkeys(IDS, middle(bus)), 0.6)
    begin = shafts(bus, device)[2]
    slow = device.servos[2].traits.speed / 20
    device.servos[2].speed_limit = slow
    bus.write_goals({2: middle(bus) + 400})
    device.servos[2].speed_limit = slow
    way = device.positions(clock(bus).now() + 2.5)[2] - begin
    assert way == pytest.approx(0.2 * slow, abs=0.03 * slow + device.servos[2].traits.play)


@pytest.mark.parametrize("seed", range(3))
def test_answers_that_are_damaged_by_chance_are_refused_or_right(smart, seed):
    bus, device = smart
    drive(bus, {id: middle(bus) + 8 * (id - 9) for id in IDS}, 0.6)
    truth = bus.read_positions((3, 4)).require()
    device.faults.corrupt = {3: 0.7}
    answers = [bus.read_positions((3, 4)) for _ in range(20)]
    assert all(one.values[id] == truth[id] for one in answers for id in one.values)
    assert any(one.errors for one in answers)


def test_a_maestro_ends_pulses_after_its_serial_timeout():
    bus, device = hardware.emulated_bus("maestro", IDS, serial_timeout=0.1)
    bus.write_goals({0: 1500})
    device.advance(clock(bus).now() + 0.2)
    assert not device.servos[0].torque
    assert bus.read_telemetry((0,)).values[0].alarms == ("serial timeout",)


def test_a_brown_out_makes_smart_servos_limp_and_silent(smart):
    bus, device = smart
    drive(bus, dict.fromkeys(IDS, middle(bus)), 0.1)
    device.supply.source = 3.0
    answers = bus.read_positions((1, 2))
    assert not answers.values
    assert {error.id for error in answers.errors} == {1, 2}
    device.supply.source = device.supply.nominal
    clock(bus).sleep(1.0)
    bus.ping(1)
    clock(bus).sleep(1.0)
    assert set(bus.read_positions((1, 2)).require()) == {1, 2}
    assert not any(servo.torque for servo in device.servos.values())


def test_servos_with_pulses_go_on_after_a_brown_out(board):
    bus, device = board
    bus.set_watchdog(IDS, None)
    drive(bus, dict.fromkeys(IDS, 1500.0), 0.1)
    device.supply.source = 3.0
    device.advance(clock(bus).now() + 0.01)
    assert not device.servos[0].torque
    device.supply.source = device.supply.nominal
    device.advance(clock(bus).now() + 0.02)
    device.advance(clock(bus).now() + 1.0)
    assert device.servos[0].torque


def test_a_hot_servo_lets_go_and_says_why(smart):
    bus, device = smart
    device.servos[3].stuck = True
    drive(bus, {3: middle(bus) + 300})
    device.advance(clock(bus).now() + 200.0)
    assert not device.servos[3].torque
    telemetry = bus.read_telemetry((3,)).require()[3]
    assert telemetry.temperature > 60
    if "alarms" in bus.capabilities.telemetry:
        assert telemetry.alarms == ("temperature",)


def test_a_stuck_joint_draws_current_and_does_not_move(smart):
    bus, device = smart
    before = shafts(bus, device)[3]
    device.servos[3].stuck = True
    drive(bus, {3: middle(bus) + 300})
    assert shafts(bus, device)[3] == before
    telemetry = bus.read_telemetry((3,)).require()[3]
    assert telemetry.load is None or telemetry.load == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("bad", [math.nan, math.inf, 1e6, -1.0])
def test_impossible_goals_are_refused_and_nothing_is_sent(any_bus, bad):
    bus, device = any_bus
    drive(bus, {2: middle(bus)}, 0.1)
    before = {id: servo.goal for id, servo in device.servos.items()}
    with pytest.raises(InputError, match="goal of id 1"):
        bus.write_goals({2: middle(bus) + 50, 1: bad})
    for unknown in (300, -1, 1.5, "1"):
        with pytest.raises(InputError, match=f"has no id {unknown!r}"):
            bus.write_goals({2: middle(bus) + 50, unknown: middle(bus)})
    device.advance(clock(bus).now() + 0.05)
    assert {id: servo.goal for id, servo in device.servos.items()} == before


def test_impossible_limits_are_refused(any_bus):
    bus, _ = any_bus
    low, high = bus.capabilities.lowest, bus.capabilities.highest
    for limits in ((low - 1, high), (low, high + 1), (high, low), (math.nan, high)):
        with pytest.raises(InputError):
            bus.set_limits(2, *limits)
    for speed in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InputError):
            bus.set_speed_limit((2,), speed)
    for share in (-0.1, 1.1, math.nan):
        with pytest.raises(InputError):
            bus.set_torque_limit((2,), share)
    if bus.capabilities.watchdog:
        with pytest.raises(InputError, match="watchdog"):
            bus.set_watchdog((2,), 1000.0)


def test_nothing_is_sent_for_nobody(any_bus):
    bus, _ = any_bus
    before = clock(bus).now()
    bus.write_goals({})
    bus.set_torque((), True)
    bus.set_torque_limit((), 1.0)
    assert bus.read_positions(()) == bus.read_telemetry(()) == hardware.Answers()
    assert clock(bus).now() == before


def test_an_unplugged_line_is_a_port_error(any_bus):
    bus, device = any_bus
    device.faults.unplugged = True
    with pytest.raises(PortError, match="unplugged"):
        bus.write_goals({1: middle(bus)})
    with pytest.raises(PortError, match="unplugged"):
        bus.ping(1)
    bus.close()


def test_the_time_of_a_tick_is_what_it_takes_in_memory(any_bus):
    bus, _ = any_bus
    # A line has all channels, used or not.
    ids = bus.capabilities.ids if bus.name == "lines" else IDS
    bus.write_goals(dict.fromkeys(ids, middle(bus)))
    begin = clock(bus).now()
    bus.write_goals(dict.fromkeys(ids, middle(bus)))
    written = clock(bus).now()
    bus.read_positions(ids)
    timing = bus.timing(ids)
    assert written - begin == pytest.approx(timing.goals, rel=1e-6)
    assert clock(bus).now() - written == pytest.approx(timing.positions, rel=0.02, abs=1e-9)
    assert timing.rate == pytest.approx(1 / (timing.goals + timing.positions))
    assert bus.timing(()).positions == 0
    assert bus.timing(()).rate > timing.rate or bus.name == "lines"


@pytest.mark.parametrize(("pause", "waits"), [(0.0, 0.02), (0.012, 0.008), (0.05, 0.0)])
def test_silence_since_an_answer_was_waited_for_counts_before_the_same_servo_is_asked_again(pause, waits):
    clock = hardware.ManualClock()
    bus, device = hardware.emulated_bus("feetech-sts", IDS, clock=clock)
    device.faults.missing = {IDS[0]}

    def duration():
        began = clock.now()
        assert isinstance(bus.read_positions((IDS[0],)).errors[0], NoAnswerError)
        return clock.now() - began

    first = duration()
    clock.sleep(pause)
    assert duration() == pytest.approx(first + waits, abs=1e-3)


def test_fast_reading_takes_less_time_and_survives_a_missing_servo():
    bus, device = hardware.emulated_bus("dynamixel-x", IDS, baud=1_000_000)
    fast = hardware.bus_over("dynamixel-x", bus._transport, fast=True)
    assert fast.read_positions(IDS) == bus.read_positions(IDS)
    assert fast.timing(IDS).positions < 0.7 * bus.timing(IDS).positions
    device.faults.missing = {3}
    answers = fast.read_positions((2, 3, 4))
    assert set(answers.values) == {2, 4}


def test_boards_that_answer_something_else_are_refused():
    for name, noise in (("maestro", b"\xff\xfe"), ("ssc32", b"\xff\r"), ("servo2040", b"\xff"), ("lines", b"\xff\n")):
        bus, device = opened(name)
        device._answers = lambda noise=noise: [(-1, noise)]
        with pytest.raises(BusError):
            bus.ping(0)
    bus, device = hardware.emulated_bus("lines", IDS, outputs=12)
    with pytest.raises(CorruptAnswerError, match="'tarsus 12'"):
        bus.ping(0)
    bus, device = opened("servo2040")
    device._answers = list
    assert bus.ping(0) is None
    assert [type(error) for error in bus.read_telemetry((0,)).errors] == [NoAnswerError]


def test_touch_sensors_of_a_servo2040_are_read():
    bus, device = opened("servo2040")
    device.levels = {2: 3.0 / 3.3}
    assert bus.read_touch() == pytest.approx((0, 0, 3.0, 0, 0, 0), abs=0.01)


def test_impossible_boards_are_refused():
    for addresses in ((), (0x40, 0x40), (0x10,)):
        with pytest.raises(InputError, match="addresses from 0x40"):
            hardware.emulated_bus("pca9685", IDS)[0].__class__(
                hardware.MemoryTransport(hardware.EmulatedLine({}, baud=9600)), addresses=addresses
            )
    with pytest.raises(InputError, match="24 to 1526 pulses a second"):
        hardware.bus_over("pca9685", opened("pca9685")[0]._transport, rate=5)
    with pytest.raises(InputError, match="1 to 32 channels"):
        hardware.bus_over("lines", opened("lines")[0]._transport, channels=40)
    missing = hardware.bus_over("pca9685", opened("pca9685")[0]._transport, addresses=(0x50,))
    assert missing.ping(0) is None
    with pytest.raises(NoAnswerError, match="acknowledge from address 0x50"):
        missing.write_goals({0: 1500})


def test_a_board_whose_supply_was_off_is_prepared_again_when_it_is_looked_for():
    bus, device = opened("pca9685")
    drive(bus, {1: 1200.0})
    assert device.pulses[1] == pytest.approx(1200, abs=3)
    for address in device._boards:
        device._boards[address] = device._fresh()
    drive(bus, {1: 1200.0})
    assert device.pulses[1] == 0.0
    assert set(bus.scan(IDS).values) == set(IDS)
    assert device.pulses[1] == 0.0
    drive(bus, {1: 1300.0})
    assert device.pulses[1] == pytest.approx(1300, abs=3)
    # A board that works goes on with its pulses.
    bus.scan(IDS)
    assert device.pulses[1] == pytest.approx(1300, abs=3)


def test_unknown_buses_list_the_known():
    with pytest.raises(UnknownNameError, match="Did you mean 'feetech-sts'"):
        hardware.open_bus("feetech-stx", "nowhere")
    with pytest.raises(UnknownNameError, match="Did you mean 'feetech-sts'"):
        hardware.emulate("feetech-stx", IDS)


@pytest.mark.parametrize(
    ("name", "refusal", "error"),
    [
        ("dynamixel-x", dynamixel2.status(2, 4, b""), "value out of range"),
        ("dynamixel-ax", packet.packet(2, 1 << 3, b""), "range"),
        ("feetech-sts", packet.packet(2, 1 << 5, b""), "overload"),
    ],
)
def test_a_servo_that_refuses_is_not_said_to_be_silent(name, refusal, error):
    bus, device = hardware.emulated_bus(name, IDS)
    content = device._content
    device._content = lambda id, *what: [(id, refusal)] if id == 2 else content(id, *what)
    answers = bus.read_positions((1, 2, 3))
    assert set(answers.values) == {1, 3}
    (found,) = answers.errors
    assert isinstance(found, ServoStatusError)
    assert error in str(found)
    assert "received a refusal with the error" in str(found)
