"""A ship afloat: six linear equations of motion about its mean position, with a wave excitation that moves it by itself as
`cargo xtask ship-motion` says."""

import math
from dataclasses import dataclass

import numpy as np
from common import rotation, turning

GRAVITY, DENSITY = 9.81, 1025.0


@dataclass
class Hull:
    """Main dimensions (m); the defaults are those of `cargo xtask ship-motion`, and so are the estimates below."""

    length: float = 80.0
    beam: float = 18.0
    draught: float = 5.0
    block: float = 0.7
    # Height of the centre of gravity above the still water, as in the scene overboard.
    gravity_height: float = 1.5
    # Natural period (s) and damping ratio of what holds the ship in place in surge, sway and yaw: a dynamic positioning; infinity is none.
    station_period: float = 120.0
    station_damping: float = 0.7
    roll_damping: float = 0.10

    @property
    def displacement(self):
        """Displaced mass, kg."""
        return DENSITY * self.block * self.length * self.beam * self.draught

    @property
    def waterplane(self):
        """Waterplane area (m2), of the coefficient (1 + 2 C_B)/3 (Schneekluth and Bertram, Ship Design for Efficiency and Economy, 1998)."""
        return (1.0 + 2.0 * self.block) / 3.0 * self.length * self.beam

    @property
    def metacentric_heights(self):
        """Transverse and longitudinal, m. GM_T = 0.06 B. GM_L = KB + I_L/V - KG, with I_L of a rectangle of the waterplane's area and Morrish's
        KB = T (5/6 - C_B/(3 C_WP))."""
        volume = self.displacement / DENSITY
        waterplane_coefficient = self.waterplane / (self.length * self.beam)
        buoyancy = self.draught * (5.0 / 6.0 - self.block / (3.0 * waterplane_coefficient))
        longitudinal = buoyancy + self.waterplane * self.length**2 / 12.0 / volume - (self.draught + self.gravity_height)
        return 0.06 * self.beam, longitudinal

    @property
    def stiffness(self):
        """Hydrostatic stiffness of heave, roll and pitch, and the station keeping's of surge, sway and yaw: N/m or N.m/rad."""
        transverse, longitudinal = self.metacentric_heights
        weight = GRAVITY * self.displacement
        station = (2.0 * math.pi / self.station_period) ** 2
        surge, sway, _, _, _, yaw = self.inertia
        heave = DENSITY * GRAVITY * self.waterplane
        return np.array([station * surge, station * sway, heave, weight * transverse, weight * longitudinal, station * yaw])

    @property
    def inertia(self):
        """Mass or moment of inertia with added mass, kg or kg.m2. Heave and pitch: natural frequency sqrt(g/2T), Jensen, Mansour and Olsen, Ocean
        Engineering 31 (2004) 61-85; roll: radius of gyration with added mass 0.40 B; surge, sway: 5 % and 80 % added (usual values); yaw:
        0.25 L and twice that inertia."""
        transverse, longitudinal = self.metacentric_heights
        mass = self.displacement
        soft = 2.0 * self.draught / GRAVITY
        roll, yaw = mass * (0.40 * self.beam) ** 2, 2.0 * mass * (0.25 * self.length) ** 2
        heave, pitch = soft * DENSITY * GRAVITY * self.waterplane, soft * GRAVITY * mass * longitudinal
        return np.array([1.05 * mass, 1.8 * mass, heave, roll, pitch, yaw])

    @property
    def damping(self):
        """N.s/m or N.m.s/rad. Heave and pitch: that of Jensen, Mansour and Olsen at the natural frequency, where k T = 1/2: as a share of the
        stiffness A^2/(kB w) with A = 2 sin(kB/2) exp(-kT), B the beam times C_B. Roll and station keeping by their damping ratios."""
        critical = 2.0 * np.sqrt(self.inertia * self.stiffness)
        k_beam = 0.5 * self.block * self.beam / self.draught
        made = 2.0 * math.sin(0.5 * k_beam) * math.exp(-0.5)
        vertical = 0.5 * made**2 / k_beam
        station = self.station_damping
        return critical * np.array([station, station, vertical, self.roll_damping, vertical, station])


class Vessel:
    """M q'' + B q' + C q = excitation + load, with q = x, y, z, roll, pitch, yaw (m, rad), by Newmark's method with constant average acceleration:
    second order, and without damping the energy it gains in a step is the mean load times the way, to rounding."""

    def __init__(self, hull):
        self.inertia, self.damping, self.stiffness = hull.inertia, hull.damping, hull.stiffness
        self.pose, self.rate, self.acceleration = np.zeros(6), np.zeros(6), np.zeros(6)

    def state(self):
        """Values of SHIP."""
        return np.concatenate([self.pose, self.rate, self.acceleration])

    def excitation(self, motion):
        """The waves' load that moves the ship by itself as the 18 values of `motion` say: N, N.m."""
        pose, rate, acceleration = motion.reshape(3, 6)
        return self.inertia * acceleration + self.damping * rate + self.stiffness * pose

    def rest(self, load):
        """Lies where the stiffness bears the load, at rest, as far as there is a stiffness."""
        soft = self.stiffness == 0.0
        self.pose = np.where(soft, 0.0, load / np.where(soft, 1.0, self.stiffness))
        self.rate, self.acceleration = np.zeros(6), np.zeros(6)

    def accelerate(self, load):
        """The acceleration now, under a load."""
        self.acceleration = (load - self.damping * self.rate - self.stiffness * self.pose) / self.inertia

    def step(self, h, load):
        """Over `h` seconds; `load` is that at their end."""
        pose = self.pose + h * self.rate + 0.25 * h * h * self.acceleration
        rate = self.rate + 0.5 * h * self.acceleration
        effective = self.inertia + 0.5 * h * self.damping + 0.25 * h * h * self.stiffness
        self.acceleration = (load - self.damping * rate - self.stiffness * pose) / effective
        self.pose = pose + 0.25 * h * h * self.acceleration
        self.rate = rate + 0.5 * h * self.acceleration

    def energy(self):
        """Kinetic and hydrostatic, J."""
        return 0.5 * np.sum(self.inertia * self.rate**2 + self.stiffness * self.pose**2)


def generalized(force, moment, angles):
    """What a force in inertial axes (N) and a moment in ship axes (N.m) about the ship's origin do along x, y, z, roll, pitch and yaw: their power
    is this times the rates of these six, exactly."""
    return np.concatenate([force, turning(angles).T @ np.asarray(moment)])


def suspended(hull, weights):
    """What weights on board do, by hydrostatics alone: z, roll, pitch (m, rad), from rows of weight (N) and place (ship axes, m). A weight that hangs
    plumb counts at the point that it hangs from. Roll turns it from y to y cos(roll) - z sin(roll), and so the moments are solved for anew."""
    weights = np.asarray(weights)
    total, moment = weights[:, 0].sum(), weights[:, 0] @ weights[:, 1:]
    angles = np.zeros(3)
    for _ in range(50):
        down = -rotation(angles)[2]
        angles = generalized([0.0, 0.0, -total], np.cross(moment, down), angles)[3:] / hull.stiffness[3:]
    return -total / hull.stiffness[2], angles[0], angles[1]
