//! The checked scene, in SI units, in z-up world and ship axes whatever frame the file uses.

use nalgebra::Vector3;
use serde::Deserialize;

/// Everything that one simulation consists of.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// C identifier; the FMU's model identifier.
    pub name: String,
    /// Free text.
    pub description: String,
    /// Gravitational acceleration, m/s².
    pub gravity: f64,
    /// The cable.
    pub cable: Cable,
    /// Unstretched element lengths from the first end, m; they sum to the cable's length.
    pub elements: Vec<f64>,
    /// `None`: vacuum.
    pub fluid: Option<Fluid>,
    /// `None`: the ship's frame rests at the origin and there are no ship inputs.
    pub ship: Option<Ship>,
    /// `None`: the first end is fixed at [`Scene::anchor`].
    pub winch: Option<Winch>,
    /// Where the first end is fixed without a winch, ship axes, m.
    pub anchor: Option<Vector3<f64>>,
    /// In the order in which the cable passes them.
    pub sheaves: Vec<Sheave>,
    /// A lump at the far end.
    pub body: Option<Body>,
    /// A rigid link at the far end.
    pub load: Option<Load>,
    /// A fixed far end, world, m.
    pub far_end: Option<Vector3<f64>>,
    /// How the run starts.
    pub initial: Initial,
    /// Numerical settings.
    pub solver: Solver,
    /// Number of `cable.point[k]` outputs.
    pub points: usize,
}

/// The cable's section.
#[derive(Clone, Debug, PartialEq)]
pub struct Cable {
    /// Unstretched length, m.
    pub length: f64,
    /// Diameter, m.
    pub diameter: f64,
    /// Mass per unstretched length, kg/m.
    pub mass_per_length: f64,
    /// Axial stiffness, N.
    pub ea: f64,
    /// Bending stiffness, N·m².
    pub ei: f64,
    /// What the cable does when pushed.
    pub compression: Compression,
    /// Which strain and curvature measures.
    pub strain: Strain,
    /// Internal damping.
    pub damping: Damping,
}

/// The axial law in compression.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Compression {
    /// EA max(ε, 0): a cable cannot be pushed.
    None,
    /// EA ε on both sides (the thesis).
    Linear,
}

/// The pair of strain and curvature measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Strain {
    /// ε = ‖r_p‖ − 1, κ = ‖r_p × r_pp‖/‖r_p‖² (what data sheets mean).
    Engineering,
    /// ε = ½(r_p·r_p − 1), κ = ‖r_p × r_pp‖/‖r_p‖³ (the thesis).
    Green,
}

/// Internal damping.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(tag = "model", rename_all = "snake_case")]
pub enum Damping {
    /// Objective: c_a ε̇ (N·s) and c_b κ̇ (N·m²·s).
    KelvinVoigt {
        /// c_a, N·s.
        axial: f64,
        /// c_b, N·m²·s.
        bending: f64,
        /// Whether the axial part also acts while the cable is slack.
        in_slack: bool,
    },
    /// Q = c ∫ S_pᵀ S_p dp q̇: the thesis's, not objective.
    GradientRate {
        /// c, N·s.
        coefficient: f64,
    },
}

/// Water.
#[derive(Clone, Debug, PartialEq)]
pub struct Fluid {
    /// kg/m³.
    pub density: f64,
    /// Dynamic viscosity, Pa·s; needed only by coefficients that depend on the Reynolds number.
    pub viscosity: Option<f64>,
    /// Height of the still surface, m; infinite when everything is submerged.
    pub waterline: f64,
    /// Drag on the cable.
    pub drag: Drag,
    /// C_m of the cable.
    pub added_mass: f64,
    /// (z, v_x, v_y), ascending in z, constant beyond the ends; m, m/s. Empty: no current.
    pub current: Vec<[f64; 3]>,
    /// Turbulence of the current; `None`: it is steady.
    pub noise: Option<Noise>,
}

/// Turbulence: white noise through a Chebyshev-II low-pass, uniform in space. The realization belongs to z-up axes.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Noise {
    /// Standard deviations along x, y, z, m/s.
    pub std_dev: [f64; 3],
    /// Which realization.
    pub seed: u32,
    /// Samples per second, Hz.
    pub sample_rate: f64,
    /// Order of the filter.
    pub order: usize,
    /// Where its stop band begins, Hz.
    pub cutoff: f64,
    /// Attenuation there, dB.
    pub attenuation: f64,
    /// Time in which the noise grows out of the mean current after the start, s.
    pub ramp: f64,
}

/// The cable's drag law.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(tag = "law", rename_all = "snake_case")]
pub enum Drag {
    /// Driscoll & Nahon's loading functions (Buckham et al. 2004), normal part amplified by G.
    LoadingFunctions {
        /// C_d.
        cd: Coefficient,
        /// G.
        amplification: f64,
    },
    /// Independent normal and tangential parts.
    CrossFlow {
        /// C_dn on the diameter.
        #[serde(rename = "cd_normal")]
        normal: Coefficient,
        /// C_dt on the circumference.
        #[serde(rename = "cd_tangential")]
        tangential: f64,
        /// G, on the normal part.
        amplification: f64,
    },
}

/// A drag coefficient.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Coefficient {
    /// The circular cylinder in cross-flow.
    Cylinder,
    /// The smooth sphere.
    Sphere,
    /// The same at every Reynolds number.
    #[serde(untagged)]
    Constant(f64),
    /// (Re, C), ascending in Re, interpolated in the logarithms, constant beyond the ends.
    #[serde(untagged)]
    Table(Vec<[f64; 2]>),
}

/// The ship's motion input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ship {
    /// How many time derivatives of the pose are inputs: 0, 1 or 2.
    pub derivatives: usize,
    /// Whether inputs and outputs use z down.
    pub ned: bool,
}

impl Default for Coefficient {
    /// No drag.
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

/// Hunt-Crossley line contact.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Contact {
    /// k_N, N/m^(1+n).
    pub stiffness: f64,
    /// D, s/m.
    pub damping: f64,
    /// n.
    pub exponent: f64,
}

/// The winch drum with its position controller.
#[derive(Clone, Debug, PartialEq)]
pub struct Winch {
    /// Centre, ship axes, m.
    pub position: Vector3<f64>,
    /// Unit axis, ship axes.
    pub axis: Vector3<f64>,
    /// Drum radius, m (the cable's centreline lies half a diameter further out).
    pub radius: f64,
    /// Initial angle of the cable's first node about the axis from "up", rad.
    pub angle: f64,
    /// k1, 1/s².
    pub gain_position: f64,
    /// k2, 1/s.
    pub gain_rate: f64,
    /// Greatest |φ̇|, rad/s; infinite when not given.
    pub max_rate: f64,
    /// Greatest |φ̈|, rad/s²; infinite when not given.
    pub max_acceleration: f64,
    /// Drum contact; `None`: the cable passes through the drum.
    pub contact: Option<Contact>,
    /// Whether the set-point is metres of payout instead of the drum's angle.
    pub payout_command: bool,
    /// Whether the slope at the first node is held along the drum's tangent.
    pub tangent_end: bool,
    /// −1: the cable leaves towards negative φ (decreasing φ pays out); +1: the mirror image.
    pub direction: f64,
    /// Where the set-point comes from.
    pub setpoint: Setpoint,
}

/// Where the winch's set-point comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Setpoint {
    /// The FMU's input.
    External,
    /// Pays out Δl = −u·Δr_s, u the cable's direction at the start where it leaves the last sheave (or the drum).
    SimplifiedSheave,
    /// The same with u the cable's present direction.
    Sheave,
    /// Keeps the cable where it met the water at the start, and so the body's depth below.
    Waterline,
}

/// A grooved or plain sheave.
#[derive(Clone, Debug, PartialEq)]
pub struct Sheave {
    /// Free text, for messages.
    pub name: String,
    /// Centre, ship axes, m.
    pub position: Vector3<f64>,
    /// Unit axis, ship axes.
    pub axis: Vector3<f64>,
    /// Radius to the groove's root, m.
    pub radius: f64,
    /// Whether the cable passes over (true) or under (false).
    pub over: bool,
    /// Throat angle θ_g, rad; `None`: a plain cylinder.
    pub groove_angle: Option<f64>,
    /// Groove depth h_g, m; infinite when not given.
    pub groove_depth: f64,
    /// Contact law.
    pub contact: Contact,
    /// Coulomb coefficient; 0: frictionless.
    pub friction: f64,
    /// Moment of inertia about the axis, kg·m²; `None`: the sheave does not turn.
    pub inertia: Option<f64>,
    /// Coulomb friction of the bearing, N·m.
    pub bearing_friction: f64,
    /// Its viscous friction, N·m·s.
    pub bearing_damping: f64,
}

/// A lump at the far end.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Body {
    /// kg.
    pub mass: f64,
    /// m³.
    #[serde(default)]
    pub volume: f64,
    /// m².
    #[serde(default)]
    pub drag_area: f64,
    /// C_db, on the drag area; Re uses the diameter of a circle of that area.
    #[serde(default)]
    pub drag_coefficient: Coefficient,
    /// C_mb.
    pub added_mass: f64,
    /// Whether `body.force.*` inputs exist.
    pub force_input: bool,
}

/// A rigid link hanging from the far end.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Load {
    /// kg.
    pub mass: f64,
    /// L_PI, radius of gyration about the attachment, m.
    pub length_inertia: f64,
    /// L_PG, distance of the centre of gravity from the attachment, m.
    pub length_gravity: f64,
}

/// How a run starts.
#[derive(Clone, Debug, PartialEq)]
pub enum Initial {
    /// Static equilibrium under the first inputs.
    Equilibrium,
    /// Equilibrium with the far end held along a direction, then released.
    Released(Vector3<f64>),
    /// Straight and unstretched along a direction, at rest.
    Straight(Vector3<f64>),
    /// Given positions, tangents and velocities over arc length.
    Shape(Vec<ShapePoint>),
}

/// One row of a start shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapePoint {
    /// Arc length, m.
    pub s: f64,
    /// Position, world, m.
    pub position: Vector3<f64>,
    /// ∂r/∂s, `None`: derived from the positions.
    pub tangent: Option<Vector3<f64>>,
    /// Velocity, m/s; zero when not given.
    pub velocity: Vector3<f64>,
}

/// Numerical settings.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Solver {
    /// Time integrator.
    pub method: Method,
    /// Asked-for relative accuracy of the tension.
    pub tolerance: f64,
    /// Greatest sub-step, s.
    pub step_max: f64,
    /// Smallest sub-step, s, below which a step counts as failed.
    pub step_min: f64,
    /// Greatest number of sub-steps in one communication step.
    pub steps_max: usize,
    /// Greatest number of sub-steps tried in one communication step, whatever the error (real time); 0 is no limit.
    pub tries_max: usize,
}

/// Time integrators.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Rosenbrock, order 4(3), L-stable, stiffly accurate (Hairer & Wanner).
    Rodas4,
    /// Trapezoidal rule and backward difference, order 2, L-stable, with kept factors (Bank et al.).
    TrBdf2,
    /// ESDIRK3(2)5L[2]SA, L-stable, with kept factors (Kennedy & Carpenter).
    Esdirk3,
    /// ESDIRK4(3)6L[2]SA, the same.
    Esdirk4,
    /// Radau IIA, order 5, L-stable, stiffly accurate (Hairer & Wanner): the reference.
    Radau5,
}
