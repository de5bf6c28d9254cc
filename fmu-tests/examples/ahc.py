"""An active heave compensation as ships have them: a motion sensor, an estimator that makes up for the sensor's delay, feed-forward of what it
says and a PD controller of the winch's payout. Everything is sampled with the controller's step."""

from collections import deque
from dataclasses import dataclass

import numpy as np


@dataclass
class Settings:
    """Of sensor and controller; lengths in m, times in s."""

    step: float = 0.01
    # A motion reference unit with its processing and its bus.
    delay: float = 0.1
    # Standard deviations of the noise, white from sample to sample: of position (m) and of velocity (m/s).
    noise: float = 0.005
    noise_rate: float = 0.01
    # What the estimator takes for the delay; the sensor's own if None.
    assumed_delay: float | None = None
    # Period (s) of the motion that the estimator continues best.
    period: float = 9.0
    # Spectral density of the estimator's driving noise, (m/s3)2 s: larger follows faster, smaller is smoother.
    jerk: float = 0.2
    # PD controller: metres of set-point per metre of error, metres per second of set-point rate per metre per second of error.
    gain_position: float = 1.0
    gain_rate: float = 1.0
    # Share of the estimated motion that is fed forward: position and rate; acceleration.
    feed_forward: float = 1.0
    feed_forward_acceleration: float = 1.0
    seed: int = 1


class Sensor:
    """Tells how far (m) and how fast (m/s) the point that the cable hangs from has moved up along the cable, late and with noise."""

    def __init__(self, settings):
        self.samples = round(settings.delay / settings.step)
        self.deviation = np.array([settings.noise, settings.noise_rate])
        self.random = np.random.default_rng(settings.seed)
        self.line = deque([np.zeros(2)] * (self.samples + 1), maxlen=self.samples + 1)

    def sample(self, truth):
        """The measurement that arrives now, while `truth` = (position, velocity) happens."""
        self.line.append(np.asarray(truth) + self.deviation * self.random.standard_normal(2))
        return self.line[0]


def transition(omega, t):
    """exp(A t) of ẋ = (x₂, x₃, −ω² x₂): position, velocity and acceleration of a harmonic motion about any mean, after the time t."""
    s, c = np.sin(omega * t), np.cos(omega * t)
    return np.array([[1.0, s / omega, (1.0 - c) / omega**2], [0.0, c, s / omega], [0.0, -omega * s, c]])


class Estimator:
    """Kalman filter with constant gains for position, velocity and acceleration, and their prediction over the sensor's delay.

    The model is z''' = −ω² z' + w: a harmonic motion of the sea's period whose acceleration white noise w of density `jerk` disturbs. Measured
    are position and velocity. The gains are those that the filter's covariance P settles to; with a perfect sensor they approach one. What
    is measured at t − τ is filtered there and continued over τ by the model, which is exact for a motion of the period told and, for another
    frequency ω', off by (ω'² − ω²) ω' τ³/6 of its amplitude: 0.03 % for half of 9 s at τ = 0.1 s.
    """

    def __init__(self, settings):
        omega, h = 2.0 * np.pi / settings.period, settings.step
        self.advance = transition(omega, h)
        delay = settings.delay if settings.assumed_delay is None else settings.assumed_delay
        self.predict = transition(omega, delay)
        measure = np.eye(2, 3)
        # Never quite zero, or the covariance of the measurement would be singular.
        variance = np.diag(np.maximum([settings.noise, settings.noise_rate], [1e-6, 1e-5]) ** 2)
        # The noise's covariance over a step: the integral of g gᵀ with g = exp(A s) (0, 0, 1), by the midpoint rule.
        g = [transition(omega, (k + 0.5) / 16 * h)[:, 2] for k in range(16)]
        noise = settings.jerk * h / 16 * sum(np.outer(v, v) for v in g)
        covariance, self.gain = np.eye(3), np.zeros((3, 2))
        for _ in range(5000):
            prior = self.advance @ covariance @ self.advance.T + noise
            before, self.gain = self.gain, np.linalg.solve(measure @ prior @ measure.T + variance, measure @ prior).T
            covariance = (np.eye(3) - self.gain @ measure) @ prior
            if np.abs(self.gain - before).max() < 1e-9 * np.abs(self.gain).max():
                break
        self.state = np.zeros(3)

    def update(self, measured):
        """Position, velocity and acceleration now, from the measurement that has just arrived."""
        prior = self.advance @ self.state
        self.state = prior + self.gain @ (measured - prior[:2])
        return self.predict @ self.state


class Controller:
    """Set-point and its rate for a winch with φ̈ = k₁ (φ_SP − φ) + k₂ (φ̇_SP − φ̇), in metres of payout.

    The wanted payout r is the estimated motion up along the cable. The winch is told r + r̈/k₁ and ṙ, with which it follows r without lag, and
    the PD controller's correction by the payout's error e = r − payout: K_p e and K_d ė.
    """

    def __init__(self, settings, winch_gain):
        """`winch_gain`: k₁ in 1/s²."""
        self.settings, self.winch_gain = settings, winch_gain
        self.sensor, self.estimator = Sensor(settings), Estimator(settings)

    def command(self, truth, payout, payout_rate):
        """(set-point in m, its rate in m/s) for the motion that the sensor meets and the payout that the winch's encoder shows."""
        position, velocity, acceleration = self.estimator.update(self.sensor.sample(truth))
        s = self.settings
        forward = s.feed_forward * position + s.feed_forward_acceleration * acceleration / self.winch_gain
        setpoint = forward + s.gain_position * (position - payout)
        return setpoint, s.feed_forward * velocity + s.gain_rate * (velocity - payout_rate)
