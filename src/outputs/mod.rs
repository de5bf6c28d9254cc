//! Named physical quantities of a committed state: what the FMU's getters read.
//!
//! z-up world and ship axes, SI; conversion to a user's frame happens at the FMI border.

mod observe;
mod sheave;
mod slope;

pub use observe::{observe, tangent_at};
pub use sheave::contact_arc;
pub use slope::Slope;

use nalgebra::Vector3;

/// All outputs. Parts that a scene does not have stay at their defaults.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Outputs {
    /// With a winch.
    pub winch: WinchOutputs,
    /// With an anchor.
    pub anchor: AnchorOutputs,
    /// One per sheave.
    pub sheaves: Vec<SheaveOutputs>,
    /// What cable, winch and sheaves do to the ship.
    pub ship: ShipOutputs,
    /// The cable as a whole.
    pub cable: CableOutputs,
    /// The lump at the far end.
    pub body: BodyOutputs,
    /// The rigid load at the far end.
    pub load: LoadOutputs,
    /// The fixed far end.
    pub far_end: FarEndOutputs,
    /// Turbulence of the current, world, m/s.
    pub current_noise: Vector3<f64>,
    /// Solver statistics.
    pub solver: SolverOutputs,
    /// How the run fares.
    pub status: Status,
}

/// The winch.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WinchOutputs {
    /// N + ½EIκ² where the cable leaves the drum, N.
    pub tension: f64,
    /// φ, rad.
    pub angle: f64,
    /// φ̇, rad/s.
    pub rate: f64,
    /// Torque of the cable on the drum about the axis, N·m.
    pub torque: f64,
    /// Cable paid out since the start, m.
    pub payout: f64,
    /// Force of the cable on the drum, ship axes, N.
    pub force: Vector3<f64>,
    /// The built-in set-point: rad, or m of payout where the scene commands that.
    pub target: f64,
    /// Its rate.
    pub target_rate: f64,
}

/// The anchor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AnchorOutputs {
    /// Section's axial force, N.
    pub tension: f64,
    /// Force of the cable on the anchor, ship axes, N.
    pub force: Vector3<f64>,
}

/// A sheave.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SheaveOutputs {
    /// Force of the cable on the sheave, ship axes, N.
    pub force: Vector3<f64>,
    /// Its moment about the sheave's centre, ship axes, N·m.
    pub moment: Vector3<f64>,
    /// Magnitude of the resultant, N.
    pub normal_force: f64,
    /// Force on each flank, N.
    pub flank_force: [f64; 2],
    /// N + ½EIκ² on the winch side, N.
    pub tension_in: f64,
    /// The same on the far side, N.
    pub tension_out: f64,
    /// The contact arc, rad.
    pub wrap_angle: f64,
    /// Where contact starts, rad about the axis from "up".
    pub contact_begin: f64,
    /// Where contact ends, rad.
    pub contact_end: f64,
    /// How much the cable turns between the free spans, rad.
    pub turn_angle: f64,
    /// Greatest line load in the contact arc, N/m.
    pub line_load_max: f64,
    /// Least line load in the contact arc, N/m.
    pub line_load_min: f64,
    /// How far a turning sheave has turned relative to the ship, rad.
    pub angle: f64,
    /// Its rate, rad/s.
    pub rate: f64,
    /// Whether anything touches.
    pub in_contact: bool,
    /// Whether the cable has climbed out of the groove.
    pub out_of_groove: bool,
}

/// The ship.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShipOutputs {
    /// Ship axes, N.
    pub force: Vector3<f64>,
    /// About the ship frame's origin, ship axes, N·m.
    pub moment: Vector3<f64>,
    /// World axes, N.
    pub force_world: Vector3<f64>,
}

/// The cable.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CableOutputs {
    /// N.
    pub tension_max: f64,
    /// N.
    pub tension_min: f64,
    /// Whether some part carries no tension.
    pub slack: bool,
    /// Equally spaced in arc length from the first end to the last, world, m.
    pub points: Vec<Vector3<f64>>,
}

/// The body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyOutputs {
    /// World, m.
    pub position: Vector3<f64>,
    /// World, m/s.
    pub velocity: Vector3<f64>,
    /// Section's axial force at the body, N.
    pub tension: f64,
}

/// The rigid load.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadOutputs {
    /// Centre of gravity, world, m.
    pub position: Vector3<f64>,
    /// World, m/s.
    pub velocity: Vector3<f64>,
    /// Section's axial force at the attachment, N.
    pub tension: f64,
    /// Angle of the link from the vertical, rad.
    pub angle: f64,
}

/// The fixed far end.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FarEndOutputs {
    /// Force of the cable on what holds it, world, N.
    pub force: Vector3<f64>,
    /// Section's axial force there, N.
    pub tension: f64,
}

/// Solver statistics since the start of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolverOutputs {
    /// Accepted sub-steps.
    pub steps: u64,
    /// Rejected sub-steps.
    pub rejected: u64,
    /// Linear solves (stages of a Rosenbrock method, iterations of a Newton method).
    pub iterations: u64,
    /// Defect of the work and energy balance over the work done.
    pub energy_error: f64,
}

/// How the run fares.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// 0 fine, 1 degraded, 2 stopped.
    pub code: i32,
    /// Why, in words; empty when fine.
    pub message: String,
}

impl Outputs {
    /// Takes over those of the same scene, in the room that there is.
    pub fn copy(&mut self, o: &Self) {
        let Self { winch, anchor, sheaves, ship, cable, body, load, far_end, current_noise, solver, status } = o;
        self.winch.clone_from(winch);
        self.anchor.clone_from(anchor);
        self.sheaves.clone_from(sheaves);
        self.ship.clone_from(ship);
        let CableOutputs { tension_max, tension_min, slack, points } = cable;
        (self.cable.tension_max, self.cable.tension_min, self.cable.slack) = (*tension_max, *tension_min, *slack);
        self.cable.points.clone_from(points);
        self.body.clone_from(body);
        self.load.clone_from(load);
        self.far_end.clone_from(far_end);
        self.current_noise = *current_noise;
        self.solver.clone_from(solver);
        self.status.code = status.code;
        self.status.message.clone_from(&status.message);
    }

    /// Every number in a fixed order, for snapshots (the status message is not kept).
    pub fn visit(&mut self, mut visit: impl FnMut(&mut f64)) {
        fn vector(v: &mut Vector3<f64>, visit: &mut impl FnMut(&mut f64)) {
            v.iter_mut().for_each(visit);
        }
        fn flag(b: &mut bool, visit: &mut impl FnMut(&mut f64)) {
            let mut x = f64::from(u8::from(*b));
            visit(&mut x);
            *b = x != 0.0;
        }
        fn count(n: &mut u64, visit: &mut impl FnMut(&mut f64)) {
            let mut x = *n as f64;
            visit(&mut x);
            // The largest count that a double holds exactly; only a forged state has more.
            *n = (x as u64).min(1 << 53);
        }
        let w = &mut self.winch;
        for x in [&mut w.tension, &mut w.angle, &mut w.rate, &mut w.torque, &mut w.payout, &mut w.target, &mut w.target_rate] {
            visit(x);
        }
        vector(&mut w.force, &mut visit);
        visit(&mut self.anchor.tension);
        vector(&mut self.anchor.force, &mut visit);
        for s in &mut self.sheaves {
            vector(&mut s.force, &mut visit);
            vector(&mut s.moment, &mut visit);
            let [f1, f2] = &mut s.flank_force;
            for x in [&mut s.normal_force, f1, f2, &mut s.tension_in, &mut s.tension_out, &mut s.wrap_angle, &mut s.contact_begin] {
                visit(x);
            }
            for x in [&mut s.contact_end, &mut s.turn_angle, &mut s.line_load_max, &mut s.line_load_min, &mut s.angle, &mut s.rate] {
                visit(x);
            }
            flag(&mut s.in_contact, &mut visit);
            flag(&mut s.out_of_groove, &mut visit);
        }
        for v in [&mut self.ship.force, &mut self.ship.moment, &mut self.ship.force_world] {
            vector(v, &mut visit);
        }
        visit(&mut self.cable.tension_max);
        visit(&mut self.cable.tension_min);
        flag(&mut self.cable.slack, &mut visit);
        for p in &mut self.cable.points {
            vector(p, &mut visit);
        }
        vector(&mut self.body.position, &mut visit);
        vector(&mut self.body.velocity, &mut visit);
        visit(&mut self.body.tension);
        vector(&mut self.load.position, &mut visit);
        vector(&mut self.load.velocity, &mut visit);
        visit(&mut self.load.tension);
        visit(&mut self.load.angle);
        vector(&mut self.far_end.force, &mut visit);
        visit(&mut self.far_end.tension);
        vector(&mut self.current_noise, &mut visit);
        for n in [&mut self.solver.steps, &mut self.solver.rejected, &mut self.solver.iterations] {
            count(n, &mut visit);
        }
        visit(&mut self.solver.energy_error);
        let mut code = f64::from(self.status.code);
        visit(&mut code);
        self.status.code = code as i32;
    }
}
