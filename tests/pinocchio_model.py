"""The same robot built joint by joint in Pinocchio, with a free-flying base: the reference for statics and dynamics."""

import numpy as np
import pinocchio as pin

LIFT = np.array([0.0, -1.0, 0.0])  # about -y, a positive angle lifts the foot


class Reference:
    """A robot's model, which moves under gravity and with a payload on its body."""

    def __init__(self, robot, *, payload=None, gravity=(0, 0, -9.80665)):
        self.model = pin.Model()
        self.model.gravity.linear = np.asarray(gravity, dtype=float)
        base = self.model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "body")
        mass = float(robot.body_mass)
        box = np.zeros(3) if robot.body_size is None else mass / 12 * (np.sum(robot.body_size**2) - robot.body_size**2)
        self._append(base, mass, robot.body_com, np.diag(box))
        if payload is not None:
            self._append(base, payload.mass, payload.position, np.zeros((3, 3)))
        self.feet = []
        for leg in range(robot.legs):
            ends = (
                [robot.coxa[leg], *robot.femur_axis_offset[leg]],
                [robot.femur[leg], 0, 0],
                [robot.tibia[leg], 0, 0],
            )
            parent = base
            place = pin.SE3(pin.utils.rotate("z", float(robot.mount_yaw[leg])), robot.mount_position[leg])
            joints = (pin.JointModelRZ(), *(pin.JointModelRevoluteUnaligned(LIFT) for _ in range(2)))
            for i, (joint, end) in enumerate(zip(joints, ends, strict=True)):
                parent = self.model.addJoint(parent, joint, place, f"{leg}.{i}")
                place = pin.SE3(np.eye(3), np.asarray(end, dtype=float))
                length = np.linalg.norm(end)
                along = np.asarray(end) / length if length else np.zeros(3)
                link = float(robot.link_mass[leg, i])
                rod = link * length**2 / 12 * (np.eye(3) - np.outer(along, along))
                self._append(parent, link, along * robot.link_com[leg, i], rod)
            self.feet.append(self.model.addFrame(pin.Frame(f"foot {leg}", parent, 0, place, pin.FrameType.OP_FRAME)))
        self.data = self.model.createData()

    def com(self, angles):
        """Mass, and centre of mass in B."""
        com = pin.centerOfMass(self.model, self.data, self._place(angles, np.eye(3), np.zeros(3)))
        return self.data.mass[0], com.copy()

    def _append(self, joint, mass, com, inertia):
        self.model.appendBodyToJoint(
            joint, pin.Inertia(mass, np.asarray(com, dtype=float), inertia), pin.SE3.Identity()
        )

    @staticmethod
    def _place(angles, rotation, position):
        return np.concatenate([position, pin.Quaternion(rotation).coeffs(), np.ravel(angles)])

    def residual(self, angles, body, forces):
        """Base wrench (6,) and joint torques (legs, 3) left by gravity and the ground's forces, at rest."""
        q = self._place(angles, body.rotation, body.position)
        return self._less_forces(q, pin.computeGeneralizedGravity(self.model, self.data, q), forces)

    def dynamics(self, angles, body, forces, joints, rates):
        """The same for a moving robot, by the recursive Newton-Euler algorithm."""
        q = self._place(angles, body.rotation, body.position)
        to_body = np.asarray(body.rotation).T
        omega = to_body @ rates.angular_velocity
        velocity = np.array([0.3, -0.2, 0.1])  # of the base, in B: any will do
        linear = to_body @ rates.acceleration - np.cross(omega, velocity)
        v = np.concatenate([velocity, omega, np.ravel(joints.velocity)])
        a = np.concatenate([linear, to_body @ rates.angular_acceleration, np.ravel(joints.acceleration)])
        return self._less_forces(q, pin.rnea(self.model, self.data, q, v, a), forces)

    def _less_forces(self, q, generalized, forces):
        pin.computeJointJacobians(self.model, self.data, q)
        pin.updateFramePlacements(self.model, self.data)
        left = generalized.copy()
        for foot, force in zip(self.feet, forces, strict=True):
            jacobian = pin.getFrameJacobian(self.model, self.data, foot, pin.ReferenceFrame.LOCAL_WORLD_ALIGNED)
            left -= jacobian[:3].T @ force
        return left[:6], left[6:].reshape(-1, 3)
