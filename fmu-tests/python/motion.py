"""Ship motions with their derivatives, as dictionaries of inputs."""

import math

POSE = ["ship.x", "ship.y", "ship.z", "ship.roll", "ship.pitch", "ship.yaw"]
RATE = ["ship.vx", "ship.vy", "ship.vz", "ship.roll_rate", "ship.pitch_rate", "ship.yaw_rate"]
ACCELERATION = ["ship.ax", "ship.ay", "ship.az", "ship.roll_acceleration", "ship.pitch_acceleration", "ship.yaw_acceleration"]

# Amplitude (m, rad), angular frequency (rad/s), phase: flume scale, all six degrees of freedom.
WAVES = [
    (0.004, 4.0, 0.3), (0.003, 3.1, 1.0), (0.010, 4.4, 2.0), (0.050, 3.7, 0.1), (0.030, 4.1, 0.7), (0.010, 2.3, 1.7),
]


def wave(t):
    """Pose, rates and accelerations of a swell: three lists of six."""
    phases = [w * t + p for _, w, p in WAVES]
    pose = [a * math.sin(x) for (a, _, _), x in zip(WAVES, phases)]
    rate = [a * w * math.cos(x) for (a, w, _), x in zip(WAVES, phases)]
    acceleration = [-a * w * w * math.sin(x) for (a, w, _), x in zip(WAVES, phases)]
    return pose, rate, acceleration


def rising(t):
    """A swell that begins at rest, with neither velocity nor acceleration: a (1 - cos w t)^2 / 4."""
    pose, rate, acceleration = [], [], []
    for a, w, _ in WAVES:
        pose.append(a / 4 * (1.5 - 2 * math.cos(w * t) + 0.5 * math.cos(2 * w * t)))
        rate.append(a / 4 * w * (2 * math.sin(w * t) - math.sin(2 * w * t)))
        acceleration.append(a / 4 * w * w * (2 * math.cos(w * t) - 2 * math.cos(2 * w * t)))
    return pose, rate, acceleration


def parabola(t):
    """A motion that input derivatives up to the second describe without error."""
    rates = [0.02, -0.01, 0.015, 0.05, -0.04, 0.08]
    accelerations = [-0.03, 0.02, 0.04, 0.1, 0.06, -0.05]
    pose = [0.01 + v * t + a * t * t / 2 for v, a in zip(rates, accelerations)]
    return pose, [v + a * t for v, a in zip(rates, accelerations)], accelerations


def inputs(motion, fmu, frame=1.0):
    """Function of time that gives the ship inputs which the FMU has; `frame` is -1 for z down."""
    signs = [1, frame, frame] * 2
    present = set(fmu.names("input"))

    def at(t):
        values = {}
        for names, numbers in zip((POSE, RATE, ACCELERATION), motion(t)):
            values.update((name, sign * x) for name, sign, x in zip(names, signs, numbers) if name in present)
        return values

    return at


def rotation(roll, pitch, yaw):
    """R_z(yaw) R_y(pitch) R_x(roll): ship axes to the inertial frame."""
    (sa, ca), (sb, cb), (sg, cg) = ((math.sin(a), math.cos(a)) for a in (roll, pitch, yaw))
    return [
        [cg * cb, cg * sb * sa - sg * ca, cg * sb * ca + sg * sa],
        [sg * cb, sg * sb * sa + cg * ca, sg * sb * ca - cg * sa],
        [-sb, cb * sa, cb * ca],
    ]
