//! Closed-form response amplitude operators of a monohull.
//!
//! # Source
//!
//! J. J. Jensen, A. E. Mansour, A. S. Olsen, "Estimation of ship motions using closed-form expressions", Ocean Engineering 31
//! (2004) 61-85, abbreviated JMO below: its section on heave and pitch (a homogeneously loaded box) and its section on roll (two
//! prismatic beams of the same draught). The paper itself was not at hand; the formulas were compared with three public
//! transcriptions that agree with each other except where noted: NetSSE (Technical University of Denmark), Vessel.js (NTNU)
//! and `waveresponse345` of the Marine Systems Simulator (T. I. Fossen). Hence formulas are named here, not numbered.
//!
//! # What is not in the paper, or was decided here
//!
//! * **Smith factor.** κ = exp(−kT), as NetSSE and Vessel.js have it; the Marine Systems Simulator writes exp(−k_e T). They agree in
//!   head and following seas. Only the first lets heave vanish in short beam seas.
//! * **Roll damping's frequency.** The fitted curve is used with the dimensionless ω̂ = ω_e √(B/2g), because its left side is
//!   dimensionless and a function of B/T and frequency alone; the transcriptions insert ω_e in rad/s. The two coincide
//!   at B = 2g·s² ≈ 19.6 m. With ω̂ the response obeys Froude's scaling.
//! * **Range of the roll fit.** It covers 1 ≤ B/T ≤ 6 (with the paper's jump at 3). Outside, the value at the nearest end is used.
//! * **Signs and phases.** Heave and pitch follow from the paper's equations of motion, forced by F cos and G sin. The roll
//!   moment's phase is that of the wave slope; the paper gives its amplitude only. In very long waves its exciting
//!   moment fades faster than the wave slope, so roll tends to zero there and not to the slope.
//! * **Natural roll period**, where not given: 2π · 0.40 B / √(g GM), the middle of the usual 0.35 to 0.45 B for the radius of gyration with
//!   added mass.
//! * **Surge, sway, yaw** are ours: the hull follows the orbital motion of the undisturbed wave at half draught, averaged over the
//!   box's length and breadth (Froude-Krylov with equal displaced and real mass, no added mass, no damping, no restoring).
//!   The amplitude does not change with forward speed.
//! * The centre of gravity lies amidships, and the modes are not coupled.

#![allow(non_snake_case, reason = "letters of the paper")]

use super::spectrum::GRAVITY;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// A monohull's main particulars.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hull {
    /// Length L, m.
    pub length: f64,
    /// Breadth B, m.
    pub beam: f64,
    /// Draught T, m.
    pub draught: f64,
    /// Block coefficient C_B.
    pub block_coefficient: f64,
    /// Waterplane area coefficient C_WP.
    pub waterplane_coefficient: f64,
    /// Transverse metacentric height GM, m.
    pub metacentric_height: f64,
    /// Natural roll period T_N, s.
    pub roll_period: f64,
    /// Viscous roll damping added to the hydrodynamic one, as a fraction of the critical damping.
    pub roll_damping: f64,
    /// Share δ of the length that the wider of the roll model's two beams takes.
    pub wide_share: f64,
}

impl Hull {
    /// A hull of which only the main dimensions are known: C_WP = (1 + 2 C_B)/3 (Schneekluth & Bertram, "Ship Design for Efficiency and
    /// Economy", 1998), GM = 0.06 B, roll period from a radius of gyration of 0.40 B, 10 % of critical added to the roll damping, δ = 0.6.
    pub fn from_dimensions(length: f64, beam: f64, draught: f64, block_coefficient: f64) -> Hull {
        let metacentric_height = 0.06 * beam;
        Hull {
            length,
            beam,
            draught,
            block_coefficient,
            waterplane_coefficient: (1.0 + 2.0 * block_coefficient) / 3.0,
            metacentric_height,
            roll_period: natural_roll_period(beam, metacentric_height),
            roll_damping: 0.10,
            wide_share: 0.6,
        }
    }
}

/// Natural roll period of a hull with a radius of gyration (added mass included) of 0.40 B, s.
pub fn natural_roll_period(beam: f64, metacentric_height: f64) -> f64 {
    TAU * 0.40 * beam / (GRAVITY * metacentric_height).sqrt()
}

/// Heading and speed of the ship in the waves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// cos β.
    pub cos: f64,
    /// sin β.
    pub sin: f64,
    /// Forward speed U, m/s.
    pub speed: f64,
}

impl Course {
    /// From the heading in degrees (180 is head seas); exact at multiples of 90°, so that head seas leave sway, roll and yaw at zero.
    pub fn new(heading_degrees: f64, speed: f64) -> Course {
        let reduced = heading_degrees.rem_euclid(360.0);
        let (sin, cos) = match reduced {
            0.0 => (0.0, 1.0),
            90.0 => (1.0, 0.0),
            180.0 => (0.0, -1.0),
            270.0 => (-1.0, 0.0),
            angle => angle.to_radians().sin_cos(),
        };
        Course { cos, sin, speed }
    }

    /// Encounter frequency ω_e = ω − k U cos β, rad/s; negative where the ship overtakes the wave.
    pub fn encounter(&self, omega: f64) -> f64 {
        omega - omega * omega / GRAVITY * self.speed * self.cos
    }
}

/// Response to a wave of unit amplitude: the motion is `amplitude · cos(ω_e t + ε + phase)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Metres or radians per metre of wave amplitude; may be negative.
    pub amplitude: f64,
    /// Phase ahead of the wave's elevation at the centre of gravity, rad.
    pub phase: f64,
}

/// Responses of surge, sway, heave (m/m), roll, pitch and yaw (rad/m) to a wave of circular frequency `omega`.
pub fn responses(hull: &Hull, course: &Course, omega: f64) -> [Response; 6] {
    let vertical = Vertical::new(hull, course, omega);
    let [surge, sway, yaw] = horizontal(hull, course, omega);
    [surge, sway, vertical.heave(), roll(hull, course, omega), vertical.pitch(), yaw]
}

/// The terms that heave and pitch share (JMO, heave and pitch of a box).
struct Vertical {
    /// κ f, on which both forcing functions rest.
    forcing: f64,
    /// η, the dynamic amplification.
    eta: f64,
    /// Lag of the motion behind its forcing, rad.
    lag: f64,
    /// Effective wave number with its sign, k cos β, 1/m.
    k_x: f64,
    length: f64,
}

impl Vertical {
    fn new(hull: &Hull, course: &Course, omega: f64) -> Vertical {
        let k = omega * omega / GRAVITY;
        let T = hull.draught;
        // JMO: the box has the ship's length and draught, and its breadth times C_B.
        let B = hull.beam * hull.block_coefficient;
        // JMO: α = 1 − Fn √(kL) cos β, which is ω_e/ω.
        let alpha = course.encounter(omega) / omega;
        // JMO: sectional damping A = 2 sin(kBα²/2) exp(−kTα²), written as kBα² · a so that α = 0 needs no care.
        let a = sinc(0.5 * k * B * alpha * alpha) * (-k * T * alpha * alpha).exp();
        // JMO: A²/(kBα³) in the forcing, A²/(kBα²) in the response.
        let diffraction = k * B * alpha * a * a;
        let damping = k * B * (alpha * a).powi(2);
        // JMO: f = √((1 − kT)² + (A²/(kBα³))²) and κ = exp(−kT).
        let f = (1.0 - k * T).hypot(diffraction);
        let kappa = (-k * T).exp();
        // JMO: (2kT/ω²) ẅ + A²/(kBα³ω) ẇ + w = a F cos(ω_e t), hence η = [(1 − 2kTα²)² + (A²/(kBα²))²]^(−1/2). The lag has the
        // sign of ω_e, because the damper resists the motion in both senses of rotation.
        let stiffness = 1.0 - 2.0 * k * T * alpha * alpha;
        let eta = 1.0 / stiffness.hypot(damping);
        let lag = damping.copysign(alpha).atan2(stiffness);
        Vertical { forcing: kappa * f, eta, lag, k_x: k * course.cos, length: hull.length }
    }

    fn heave(&self) -> Response {
        // JMO: F = κ f · 2/(k_e L) · sin(k_e L/2).
        let F = self.forcing * sinc(0.5 * self.k_x * self.length);
        Response { amplitude: self.eta * F, phase: -self.lag }
    }

    fn pitch(&self) -> Response {
        // JMO: G = κ f · 24/((k_e L)² L) · [sin(k_e L/2) − (k_e L/2) cos(k_e L/2)], forcing with sin instead of cos. Pitch, positive bow
        // down, follows −∂ζ/∂x = −a k cos β sin(ω_e t + ε): a quarter period ahead of the elevation times k cos β.
        let G = self.forcing * average_slope(self.k_x, self.length);
        Response { amplitude: self.eta * G, phase: FRAC_PI_2 - self.lag }
    }
}

/// Roll (JMO, roll of two prismatic beams of one draught).
fn roll(hull: &Hull, course: &Course, omega: f64) -> Response {
    let still = Response { amplitude: 0.0, phase: 0.0 };
    let omega_e = course.encounter(omega);
    if course.sin == 0.0 || omega_e.abs() < 1e-6 * omega {
        return still;
    }
    let (L, B_0, T) = (hull.length, hull.beam, hull.draught);
    let k_e = (omega * omega / GRAVITY * course.cos).abs();

    // JMO: beam 0 with the ship's breadth over δL, beam 1 with γB over the rest, so that C_WP = δ + γ(1 − δ) and C_B is kept.
    let delta = hull.wide_share;
    let gamma = ((hull.waterplane_coefficient - delta) / (1.0 - delta)).clamp(0.05, 1.0);
    let B_1 = gamma * B_0;
    let A_0 = hull.block_coefficient * B_0 * T / (delta + gamma * (1.0 - delta));
    let A_1 = gamma * A_0;

    // Everything below is divided by the water's density.
    let b_0 = sectional_roll_damping(A_0, B_0, T, omega_e.abs());
    let b_1 = sectional_roll_damping(A_1, B_1, T, omega_e.abs());
    // JMO: hydrodynamic damping B44 = L b44,0 [δ + κ²(1 − δ)] with κ² = b44,1/b44,0.
    let B_hydrodynamic = L * (b_0 * delta + b_1 * (1.0 - delta));
    // JMO: restoring C44 = g Δ GM; critical damping C44 T_N/π, of which the given fraction is added for viscosity.
    let C_44 = GRAVITY * hull.block_coefficient * L * B_0 * T * hull.metacentric_height;
    let B_44 = B_hydrodynamic + hull.roll_damping * C_44 * hull.roll_period / PI;

    // JMO: moment from the Haskind relation, |sin β| √(ρg²/ω_e) (2/k_e) √b44,0
    //      √(sin²(½δLk_e) + κ² sin²(½(1−δ)Lk_e) + 2κ sin(½δLk_e) sin(½(1−δ)Lk_e) cos(½Lk_e)),
    // with 2/k_e and √b44,0 drawn inside, so that beam seas and vanishing damping need no care.
    let s_0 = b_0.sqrt() * delta * sinc(0.5 * delta * L * k_e);
    let s_1 = b_1.sqrt() * (1.0 - delta) * sinc(0.5 * (1.0 - delta) * L * k_e);
    let sum = s_0 * s_0 + s_1 * s_1 + 2.0 * s_0 * s_1 * (0.5 * L * k_e).cos();
    let M = course.sin.abs() * GRAVITY / omega_e.abs().sqrt() * L * sum.max(0.0).sqrt();

    // JMO: φ = M / √{[1 − (ω_e T_N/2π)²]² C44² + ω_e² B44²}.
    let stiffness = (1.0 - (omega_e * hull.roll_period / TAU).powi(2)) * C_44;
    let damping = omega_e * B_44;
    // Roll, positive port up, follows the slope ∂ζ/∂y = a k sin β sin(ω_e t + ε): a quarter period behind the elevation times sin β.
    Response { amplitude: (M / stiffness.hypot(damping)).copysign(course.sin), phase: -FRAC_PI_2 - damping.atan2(stiffness) }
}

/// Hydrodynamic roll damping of a section per unit length and per unit density, m⁴/s (JMO, fit to strip theory):
/// b44/(ρ A B²) √(B/2g) = a exp(b ω̂^−1.3) ω̂^d with a, b, d linear in B/T on either side of B/T = 3.
fn sectional_roll_damping(area: f64, beam: f64, draught: f64, omega_e: f64) -> f64 {
    let ratio = (beam / draught).clamp(1.0, 6.0);
    let (a, b, d) = if ratio < 3.0 {
        (-3.94 * ratio + 13.69, -2.12 * ratio - 1.89, 1.16 * ratio - 7.97)
    } else {
        (0.256 * ratio - 0.286, -0.11 * ratio - 2.55, 0.033 * ratio - 1.419)
    };
    let time = (beam / (2.0 * GRAVITY)).sqrt();
    let omega_hat = omega_e * time;
    // One exponential, because ω̂^d alone overflows where exp(b ω̂^−1.3) vanishes.
    area * beam * beam / time * a * (b * omega_hat.powf(-1.3) + d * omega_hat.ln()).exp()
}

/// Surge, sway and yaw (ours, see the module's notes): the undisturbed wave's orbital displacement at half draught, averaged over the
/// waterplane box; yaw is the least-squares slope of the lateral displacement along the length.
fn horizontal(hull: &Hull, course: &Course, omega: f64) -> [Response; 3] {
    let k = omega * omega / GRAVITY;
    let (k_x, k_y) = (k * course.cos, k * course.sin);
    let depth = (-0.5 * k * hull.draught).exp();
    let across = sinc(0.5 * k_y * hull.beam);
    let mean = depth * across * sinc(0.5 * k_x * hull.length);
    // The water moves with the wave under a crest, so its displacement along the wave's direction is a sin(ω_e t + ε).
    let surge = Response { amplitude: course.cos * mean, phase: -FRAC_PI_2 };
    let sway = Response { amplitude: course.sin * mean, phase: -FRAC_PI_2 };
    // ∂/∂x of a sin β sin(ω_e t + ε − k_x x) is −a k_x sin β cos(…).
    let yaw = Response { amplitude: -course.sin * depth * across * average_slope(k_x, hull.length), phase: 0.0 };
    [surge, sway, yaw]
}

/// sin(x)/x.
fn sinc(x: f64) -> f64 {
    if x.abs() < 1e-4 { 1.0 - x * x / 6.0 } else { x.sin() / x }
}

/// Least-squares slope over the length L of sin(kx): 24/((kL)² L) [sin(kL/2) − (kL/2) cos(kL/2)] → k in long waves; odd in k.
fn average_slope(k: f64, length: f64) -> f64 {
    let s = 0.5 * k * length;
    let shape = if s.abs() < 1e-2 { 1.0 - s * s / 10.0 + s.powi(4) / 280.0 } else { 3.0 * (s.sin() - s * s.cos()) / s.powi(3) };
    k * shape
}

#[cfg(test)]
mod tests {
    use super::*;

    fn hull() -> Hull {
        Hull::from_dimensions(80.0, 18.0, 5.0, 0.7)
    }

    #[test]
    fn exact_long_waves_carry_the_ship() {
        for heading in [180.0, 150.0, 90.0, 30.0, 0.0, -120.0] {
            let course = Course::new(heading, 0.0);
            let omega: f64 = 0.01;
            let k = omega * omega / GRAVITY;
            let [surge, sway, heave, _, pitch, yaw] = responses(&hull(), &course, omega);
            // First-order terms left out are of size kT and (kL)²/24, below 1e-4 here.
            assert!((heave.amplitude - 1.0).abs() < 2e-4, "{heading}: {heave:?}");
            assert!((pitch.amplitude - k * course.cos).abs() < 2e-4 * k, "{heading}: {pitch:?}");
            assert!((surge.amplitude - course.cos).abs() < 1e-4 && (sway.amplitude - course.sin).abs() < 1e-4);
            assert!((yaw.amplitude + k * course.cos * course.sin).abs() < 1e-4 * k);
            // The lag is kB.
            assert!(heave.phase.abs() < 2e-4 && (pitch.phase - FRAC_PI_2).abs() < 2e-4);
        }
    }

    #[test]
    fn exact_short_waves_leave_the_ship_alone() {
        for heading in [180.0, 135.0, 90.0, 0.0] {
            let course = Course::new(heading, 0.0);
            for (mode, response) in responses(&hull(), &course, 5.0).iter().enumerate() {
                assert!(response.amplitude.abs() < 2e-3, "{heading}, mode {mode}: {response:?}");
            }
        }
    }

    /// JMO's expressions, evaluated as printed (where no denominator is near zero).
    #[test]
    fn paper_heave_pitch_and_roll_as_printed() {
        let hull = hull();
        for (heading, speed) in [(180.0_f64, 0.0), (150.0, 5.0), (60.0, 3.0)] {
            for omega in [0.3_f64, 0.6, 0.9, 1.4] {
                let beta = heading.to_radians();
                let (g, L, T) = (GRAVITY, hull.length, hull.draught);
                let B = hull.beam * hull.block_coefficient;
                let k = omega * omega / g;
                let k_e = (k * beta.cos()).abs();
                let alpha = 1.0 - speed / (g * L).sqrt() * (k * L).sqrt() * beta.cos();
                let A = 2.0 * (k * B * alpha * alpha / 2.0).sin() * (-k * T * alpha * alpha).exp();
                let f = ((1.0 - k * T).powi(2) + (A * A / (k * B * alpha.powi(3))).powi(2)).sqrt();
                let kappa = (-k * T).exp();
                let eta = ((1.0 - 2.0 * k * T * alpha * alpha).powi(2) + (A * A / (k * B * alpha * alpha)).powi(2)).powf(-0.5);
                let F = kappa * f * 2.0 / (k_e * L) * (k_e * L / 2.0).sin();
                let half = k_e * L / 2.0;
                let G = kappa * f * 24.0 / ((k_e * L).powi(2) * L) * (half.sin() - half * half.cos());
                let [_, _, heave, roll, pitch, _] = responses(&hull, &Course::new(heading, speed), omega);
                assert!((heave.amplitude - eta * F).abs() < 1e-12);
                assert!((pitch.amplitude - eta * G * beta.cos().signum()).abs() < 1e-12);

                let omega_e = alpha * omega;
                let delta = hull.wide_share;
                let gamma = (hull.waterplane_coefficient - delta) / (1.0 - delta);
                let A_0 = hull.block_coefficient * hull.beam * T / (delta + gamma * (1.0 - delta));
                let b44 = |A: f64, B: f64| {
                    let time = (B / (2.0 * g)).sqrt();
                    let (a, b, d) = if B / T < 3.0 {
                        (-3.94 * B / T + 13.69, -2.12 * B / T - 1.89, 1.16 * B / T - 7.97)
                    } else {
                        (0.256 * B / T - 0.286, -0.11 * B / T - 2.55, 0.033 * B / T - 1.419)
                    };
                    let hat = omega_e * time;
                    1025.0 * A * B * B / time * a * (b * hat.powf(-1.3)).exp() * hat.powf(d)
                };
                let (b_0, b_1) = (b44(A_0, hull.beam), b44(gamma * A_0, gamma * hull.beam));
                let ratio = (b_1 / b_0).sqrt();
                let C44 = 1025.0 * g * hull.block_coefficient * L * hull.beam * T * hull.metacentric_height;
                let B44 = L * b_0 * (delta + ratio * ratio * (1.0 - delta)) + hull.roll_damping * C44 * hull.roll_period / PI;
                let (one, two) = ((0.5 * delta * L * k_e).sin(), (0.5 * (1.0 - delta) * L * k_e).sin());
                let root = (one * one + (ratio * two).powi(2) + 2.0 * ratio * one * two * (0.5 * L * k_e).cos()).sqrt();
                let M = beta.sin().abs() * (1025.0 * g * g / omega_e).sqrt() * 2.0 / k_e * b_0.sqrt() * root;
                let tuning = 1.0 - (omega_e * hull.roll_period / TAU).powi(2);
                let phi = M / ((tuning * C44).powi(2) + (omega_e * B44).powi(2)).sqrt();
                if heading != 180.0 {
                    assert!((roll.amplitude / phi - 1.0).abs() < 1e-9, "{heading} {omega}: {roll:?} {phi}");
                } else {
                    assert_eq!(roll.amplitude, 0.0);
                }
            }
        }
    }

    #[test]
    fn exact_encounter_frequency_and_exact_headings() {
        let head = Course::new(180.0, 5.0);
        assert_eq!(head.encounter(1.0), 1.0 + 5.0 / GRAVITY);
        assert_eq!(Course::new(-180.0, 5.0), head);
        let [_, sway, _, roll, _, yaw] = responses(&hull(), &head, 0.7);
        assert!(sway.amplitude == 0.0 && roll.amplitude == 0.0 && yaw.amplitude == 0.0);
    }

    /// A ship that sails exactly with the wave (ω_e = 0) or faster must still give finite answers.
    #[test]
    fn exact_overtaken_waves_are_finite() {
        for speed in [GRAVITY / 0.8, 20.0] {
            for response in
                responses(&hull(), &Course::new(0.0, speed), 0.8).iter().chain(&responses(&hull(), &Course::new(30.0, speed), 0.8))
            {
                assert!(response.amplitude.is_finite() && response.phase.is_finite(), "{response:?}");
            }
        }
    }

    /// A mirrored sea (waves from the other side) mirrors sway, roll and yaw and leaves the rest.
    #[test]
    fn exact_port_and_starboard_mirror() {
        let (a, b) = (responses(&hull(), &Course::new(120.0, 4.0), 0.8), responses(&hull(), &Course::new(240.0, 4.0), 0.8));
        for (mode, sign) in [1.0, -1.0, 1.0, -1.0, 1.0, -1.0].into_iter().enumerate() {
            assert!((a[mode].amplitude - sign * b[mode].amplitude).abs() < 1e-14 && (a[mode].phase - b[mode].phase).abs() < 1e-12);
        }
    }
}
