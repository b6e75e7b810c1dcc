"""Servo buses on emulated servos: what is measured, what is refused, and what is said about faults."""

import pytest

from tarsus import hardware
from tarsus.errors import CorruptAnswerError, InputError, NoAnswerError, PortError, UnknownNameError

IDS = range(1, 19)


@pytest.fixture(params=["feetech-sts", "feetech-scs"])
def line(request):
    bus, device = hardware.emulated_bus(request.param, IDS)
    bus.set_torque(None, True)
    return bus, device


def settle(bus, goals, ticks=200):
    for _ in range(ticks):
        bus.write_goals(goals)
        bus.read_positions(tuple(goals))


def test_servos_go_where_they_are_sent(line):
    bus, device = line
    goals = {id: device.servos[id].position + 5 * id for id in IDS}
    settle(bus, goals)
    measured = bus.read_positions(IDS).require()
    assert measured == pytest.approx(goals, abs=device.servos[1].traits.play)


def test_a_scan_finds_who_is_there(line):
    bus, device = line
    device.faults.missing = {3}
    assert set(bus.scan(range(6)).require()) == {1, 2, 4, 5}


def test_a_missing_servo_is_named_and_the_others_are_read(line):
    bus, device = line
    device.faults.missing = {3}
    answers = bus.read_positions((2, 3, 4))
    assert set(answers.values) == {2, 4}
    assert [(type(error), error.id) for error in answers.errors] == [(NoAnswerError, 3)]
    with pytest.raises(NoAnswerError, match="id 3: expected an answer with 2 bytes of data, received nothing"):
        answers.require()


def test_two_servos_with_one_id_are_noticed(line):
    bus, device = line
    device.faults.duplicate = {3}
    with pytest.raises(CorruptAnswerError, match="two servos with one id"):
        bus.ping(3)
    assert [error.id for error in bus.scan((2, 3, 4)).errors] == [3]


def test_an_echo_is_no_answer(line):
    bus, device = line
    device.faults.echo = True
    assert bus.read_positions((1, 2, 3)).require() == {id: round(device.servos[id].position) for id in (1, 2, 3)}
    device.faults.missing = {2}
    assert bus.ping(2) is None
    assert "only the echo" in str(bus.read_positions((2,)).errors[0])


def test_limits_are_kept_by_the_servo(line):
    bus, device = line
    middle = device.servos[2].position
    assert bus.set_limits(2, middle - 100, middle + 20)
    settle(bus, {2: middle + 90})
    assert device.servos[2].position == pytest.approx(middle + 20, abs=device.servos[2].traits.play)


@pytest.mark.parametrize(
    ("goals", "message"),
    [({1: float("nan")}, "nan"), ({1: 5000}, "5000 tick is outside 0"), ({300: 1}, "has no id 300")],
)
def test_impossible_goals_are_refused_and_nothing_is_sent(line, goals, message):
    bus, device = line
    before = {id: servo.goal for id, servo in device.servos.items()}
    with pytest.raises(InputError, match=message):
        bus.write_goals({2: 500, **goals})
    assert {id: servo.goal for id, servo in device.servos.items()} == before


def test_an_unplugged_line_is_a_port_error(line):
    bus, device = line
    device.faults.unplugged = True
    with pytest.raises(PortError, match="unplugged"):
        bus.read_positions((1,))


def test_a_pseudo_terminal_is_opened_like_a_serial_port():
    device = hardware.emulate("feetech-sts", IDS)
    with hardware.PtyServer(device) as server:
        bus = hardware.open_bus("feetech-sts", server.port, timeout=1.0)
        assert bus.read_positions(IDS).require() == dict.fromkeys(IDS, 2048.0)
        server.close()
        with pytest.raises(PortError):
            bus.read_positions((1,))
        bus.close()


def test_unknown_buses_list_the_known():
    with pytest.raises(UnknownNameError, match="Did you mean 'feetech-sts'"):
        hardware.open_bus("feetech-stx", "nowhere")
    with pytest.raises(UnknownNameError, match="Did you mean 'feetech-sts'"):
        hardware.emulate("feetech-stx", IDS)
    with pytest.raises(PortError, match="Serial ports found"):
        hardware.open_bus("feetech-sts", "/dev/nowhere")
