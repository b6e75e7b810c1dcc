"""Source 004: inverse kinematics of a robot with its coxa axes on a circle; its torques are `handbook`'s."""

from __future__ import annotations

from tarsus.studio.sources.document import Document, Given, Slip, Step
from tarsus.studio.sources.live import Live

__all__ = ["DOCUMENT"]

DOCUMENT = Document(
    number="004",
    title="Torque calculations and Inverse Kinematics",
    about="Author not given. A robot with its coxa axes on a circle, Tarsus' preset strider: the angles of a leg, and "
    "the torques by a hand calculation. The static torques are in the view Loads.",
    lines=(
        Given("v_x", "foot from the coxa axis in the body frame, forward", "mm", lambda leg: _from_mount(leg)[0]),
        Given("v_y", "foot from the coxa axis in the body frame, left", "mm", lambda leg: _from_mount(leg)[1]),
        Given("v_z", "foot from the femur axis, up", "mm", lambda leg: leg.foot[2] - leg.offset[1]),
        Given("psi", "direction of the leg", "deg", lambda leg: leg.yaw),
        Given("L1", "length of the coxa", "mm", lambda leg: leg.length("coxa")),
        Given("L2", "length of the femur", "mm", lambda leg: leg.length("femur")),
        Given("L3", "length of the tibia", "mm", lambda leg: leg.length("tibia")),
        Step("q1", "coxa angle", "deg", "atan2(v_y, v_x) - psi", "coxa", lambda leg: leg.angles[0]),
        Step("rho", "reach from the femur axis", "mm", "hypot(v_x, v_y) - L1"),
        Step("D", "from the femur axis to the foot", "mm", "sqrt(rho ** 2 + v_z ** 2)"),
        Step("alpha", "between femur and D", "deg", "acos((L2 ** 2 + D ** 2 - L3 ** 2) / (2 * L2 * D))"),
        Step("gamma", "between D and the horizontal", "deg", "atan2(v_z, rho)"),
        Step("q2", "femur angle", "deg", "gamma + alpha", "femur", lambda leg: leg.angles[1]),
        Step("beta", "angle inside the knee", "deg", "acos((L2 ** 2 + L3 ** 2 - D ** 2) / (2 * L2 * L3))"),
        Step("q3", "bend of the knee", "deg", "deg(180) - beta", "−tibia", lambda leg: -leg.angles[2]),
        Step("D_min", "least D in reach", "mm", "abs(L2 - L3)"),
        Step("D_max", "greatest D in reach", "mm", "L2 + L3"),
        Step("rho_max", "greatest horizontal reach from the coxa axis", "mm", "L1 + L2 + L3"),
        Given("q_01", "zero of the coxa's servo: of each robot, here as if it were calibrated", "deg", lambda _: 0.0),
        Given("q_02", "zero of the femur's servo", "deg", lambda _: 0.0),
        Given("q_03", "zero of the tibia's servo", "deg", lambda _: 0.0),
        Given("s_1", "direction of the coxa's servo, 1 or −1", "", lambda _: 1.0),
        Given("s_2", "direction of the femur's servo", "", lambda _: 1.0),
        Given("s_3", "direction of the tibia's servo", "", lambda _: 1.0),
        Step("q_cmd1", "command of the coxa's servo", "deg", "q_01 + s_1 * q1"),
        Step("q_cmd2", "command of the femur's servo", "deg", "q_02 + s_2 * q2"),
        Step("q_cmd3", "command of the tibia's servo", "deg", "q_03 + s_3 * q3"),
    ),
    slips={
        "test_004_erratum_q1_is_less_the_mounting_angle": Slip("atan2(v_y, v_x)", "atan2(v_y, v_x) - psi", "deg"),
        "test_004_erratum_the_other_convention_does_not_close": Slip("-beta", "deg(180) - beta", "deg"),
    },
)


def _from_mount(leg: Live) -> tuple[float, float]:
    ahead, aside, _ = leg.foot_in_body - leg.mount
    return float(ahead), float(aside)
