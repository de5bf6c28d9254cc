//! The only door to the physics: a scene goes in, committed states come out.

mod compensation;
mod direction;
mod drives;
mod laid;
mod rates;
mod reel;
mod sensitivity;

use crate::equilibrium;
use crate::integrator::vectors::midway;
use crate::integrator::{Integrator, Method, Problem, Trial};
use crate::ledger::Ledger;
use crate::linalg::BlockTridiagonal;
use crate::outputs::{Outputs, observe};
use crate::scene::{Initial, Scene, Setpoint};
use crate::system::{FirstEnd, Matrices, Ramp, System};
use crate::winch::Compensation;
use drives::Drives;
use nalgebra::Vector3;
use thiserror::Error;

/// One scalar input over a communication step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Channel {
    /// Value at the step's begin.
    pub value: f64,
    /// First time derivative there, if known.
    pub first: Option<f64>,
    /// Second time derivative there, if known (only together with the first).
    pub second: Option<f64>,
}

/// Everything that comes from outside, at the begin of a communication step. z up, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Inputs {
    /// x, y, z, roll, pitch, yaw of the ship's frame.
    pub ship: [Channel; 6],
    /// Winch set-point (rad, or m with a payout command), with its rate; of no effect where the scene has a built-in one.
    pub winch: Channel,
    /// Uniform current added to the profile, x and y, m/s.
    pub current: [Channel; 2],
    /// External force on the body, world, N.
    pub body_force: [Channel; 3],
}

/// What can go wrong in a simulation; every message says when, where, why and what to try.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum SimError {
    /// The scene cannot be started.
    #[error("no start state: {0}")]
    Start(String),
    /// A communication step could not be completed; the state is as it was before it.
    #[error("step failed: {0}")]
    Step(String),
    /// A saved state does not fit.
    #[error("state refused: {0}")]
    State(String),
}

/// A step in which Newton's method fails is halved or so, like one with this error.
const STALLED: f64 = 4.0;
/// Energy defect over the work done from which a run counts as degraded.
const DEGRADED: f64 = 1e-2;
/// What is said when numbers overflow.
const NOT_FINITE: &str = "the outputs are not finite; expected inputs and parameters of a size that ships and cables have";

/// A simulation of one scene.
#[derive(Clone)]
pub struct Simulation {
    scene: Scene,
    system: System,
    method: Method,
    state: State,
    backup: State,
    work: Work,
    outputs: Outputs,
    /// Where the winch's set-point comes from, if not from outside.
    compensation: Option<Compensation>,
    /// How the last step began, with `backup`; `None` if the state does not come from a step.
    last: Option<(Drives, Inputs)>,
}

/// Everything that the next step depends on, beside the drives.
#[derive(Clone, Debug, Default, PartialEq)]
struct State {
    time: f64,
    /// Positions relative to the first node, their rates and accelerations, six per node.
    u: Vec<f64>,
    w: Vec<f64>,
    a: Vec<f64>,
    /// The first node's acceleration, m/s².
    base: [f64; 3],
    /// Axial forces, three per element, N.
    n: Vec<f64>,
    /// Sub-step that the error control would take next, s.
    step: f64,
    /// Length and error of the last accepted sub-step.
    last: [f64; 2],
    /// Tension by which errors are measured, N.
    tension: f64,
    /// Drum angle at the start, rad.
    first_angle: f64,
    counts: [u64; 3],
    ledger: Ledger,
}

/// Buffers, sized once.
#[derive(Clone, Debug, Default)]
struct Work {
    matrices: Matrices,
    force: Vec<f64>,
    mid: [Vec<f64>; 3],
    /// Factors of the mass matrix where it does not depend on the shape.
    constant_mass: Option<BlockTridiagonal>,
    /// The worst error, in tolerable ones, that the last communication step accepted for want of time.
    overrun: f64,
    /// Whether forces from outside jump where the communication step begins, so that the power at its begin is not that at the end of the last.
    jumped: bool,
    /// The outputs at the begin of a step, and where the tangent was taken.
    outputs: Outputs,
    tangent: Vec<f64>,
}

impl Simulation {
    /// Allocates everything that the scene needs. Nothing is solved yet.
    ///
    /// # Errors
    /// [`SimError::Start`] when the scene asks for something that this version cannot do.
    pub fn new(scene: &Scene) -> Result<Self, SimError> {
        let mut system = System::new(scene);
        let (n, nodes) = (system.size(), system.nodes());
        let zeros = || vec![0.0; n];
        let places: Vec<usize> = system.turning.iter().map(|s| s.at).collect();
        let mut matrices = Matrices::zeros(nodes);
        let mut constant_mass = None;
        if !system.mass_varies() {
            let mut straight: Vec<f64> = system.arc.iter().flat_map(|s| [*s, 0.0, 0.0, 1.0, 0.0, 0.0]).collect();
            straight.resize(n, 0.0);
            system.linearize(0.0, &straight, &zeros(), &zeros(), &mut matrices, &mut zeros());
            let [mut mass, ..] = matrices.whole();
            mass.factor().map_err(|e| SimError::Start(format!("the mass matrix is singular at node {}", e.row)))?;
            constant_mass = Some(mass);
        }
        let state = State { u: zeros(), w: zeros(), a: zeros(), n: vec![0.0; 3 * scene.elements.len()], ..State::default() };
        Ok(Self {
            scene: scene.clone(),
            method: Method::new(scene.solver.method, n, &places),
            backup: state.clone(),
            state,
            work: Work {
                matrices,
                force: zeros(),
                mid: [zeros(), zeros(), zeros()],
                constant_mass,
                overrun: 0.0,
                jumped: true,
                outputs: Outputs::default(),
                tangent: Vec::new(),
            },
            outputs: Outputs {
                sheaves: vec![Default::default(); scene.sheaves.len()],
                cable: crate::outputs::CableOutputs { points: vec![Vector3::zeros(); scene.points], ..Default::default() },
                ..Outputs::default()
            },
            compensation: scene.winch.as_ref().filter(|w| w.setpoint != Setpoint::External).map(|w| Compensation::new(w.setpoint)),
            last: None,
            system,
        })
    }

    /// Finds the start state under the first inputs and evaluates the outputs there. May be called again (inputs changed before the first
    /// step). The cable starts with the velocity of its first end: a ship under way tows it in its steady shape.
    ///
    /// # Errors
    /// [`SimError::Start`] when there is no such state.
    pub fn initialize(&mut self, time: f64, inputs: &Inputs) -> Result<(), SimError> {
        self.last = None;
        let scene = &self.scene;
        let system = &mut self.system;
        system.keeps_axial = false;
        system.begin = time;
        if let Some(turbulence) = &mut system.turbulence {
            turbulence.start = time;
        }
        system.ship.start(time, &inputs.ship);
        system.ship.advance(time, 1.0, &inputs.ship);
        system.current = std::array::from_fn(|i| Ramp::from(&inputs.current[i]));
        system.body_force = std::array::from_fn(|i| Ramp::from(&inputs.body_force[i]));
        let mut angle = 0.0;
        if let (FirstEnd::Winch { drive, .. }, Some(winch)) = (&mut system.first, &scene.winch) {
            angle = winch.angle;
            drive.start(time, angle);
        }
        let n = system.size();
        let state = &mut self.state;
        state.time = time;
        state.first_angle = angle;
        state.counts = [0; 3];
        state.w.fill(0.0);
        state.a.fill(0.0);
        let mass = system.cable_mass() + system.end_mass();
        let weight = (mass * scene.gravity).max(1e-9 * scene.cable.ea);
        match &scene.initial {
            Initial::Equilibrium => {
                let down = laid::direction(scene, system, time);
                let mut start = match system.far_end {
                    Some(_) => equilibrium::lay_between(system, time, &down),
                    None => equilibrium::lay_out(system, time, &down),
                }
                .map_err(SimError::Start)?;
                if system.load.is_some() {
                    // A load has weight only, whatever the cable does.
                    start[6 * system.arc.len() + 5] = -1.0;
                }
                state.u.copy_from_slice(&start);
                equilibrium::solve(system, time, &mut state.u, weight).map_err(SimError::Start)?;
                equilibrium::follow(system, time, &state.u, &mut state.w);
            }
            Initial::Released(direction) => {
                // F = m g k + T u with T = −m g u·k.
                let pull = system.end_mass() * scene.gravity;
                let force = Vector3::z() * pull - direction * (pull * direction.z);
                let inputs = system.body_force;
                for c in 0..3 {
                    system.body_force[c].value += force[c];
                }
                state.u.copy_from_slice(&equilibrium::lay_out(system, time, direction).map_err(SimError::Start)?);
                let found = equilibrium::solve(system, time, &mut state.u, weight);
                system.body_force = inputs;
                found.map_err(SimError::Start)?;
            }
            Initial::Straight(direction) => {
                for (x, s) in state.u.chunks_exact_mut(6).zip(&system.arc) {
                    for c in 0..3 {
                        (x[c], x[3 + c]) = (s * direction[c], direction[c]);
                    }
                }
                if system.load.is_some() {
                    let at = 6 * system.arc.len() + 3;
                    state.u[at..at + 3].copy_from_slice(direction.as_slice());
                }
                equilibrium::meet(system, time, &mut state.u).map_err(SimError::Start)?;
                equilibrium::glide(system, time, &mut state.w);
            }
            Initial::Shape(points) => {
                equilibrium::take_shape(system, time, points, &mut state.u, &mut state.w).map_err(SimError::Start)?;
                equilibrium::meet(system, time, &mut state.u).map_err(SimError::Start)?;
            }
        }
        system.reach(time, &mut state.u, &mut state.w, &mut state.a);
        debug_assert_eq!(n, state.u.len());
        state.tension = weight;
        state.step = self.scene.solver.step_max;
        self.set_tolerance();
        self.settle();
        self.system.save_axial(&mut self.state.n);
        self.observe();
        self.begin_compensation()?;
        self.observe_setpoint();
        // Errors are measured by the greater of weight and first tension.
        self.state.tension = weight.max(self.outputs.cable.tension_max);
        self.set_tolerance();
        self.system.keeps_axial = true;
        self.method.forget();
        self.state.step = self.first_step();
        self.state.last = [0.0; 2];
        // Where less has been done than the tension does over this, the defect's share of it says nothing.
        let floor = self.state.tension * self.scene.cable.diameter.max(1e-3 * self.scene.cable.length);
        self.state.ledger = Ledger::start(&self.system.tally, &self.state.w, &self.work.force, floor);
        self.outputs.solver = Default::default();
        self.outputs.status = Default::default();
        if self.is_finite() { Ok(()) } else { Err(SimError::Start(NOT_FINITE.into())) }
    }

    /// What the scene's tolerance means for the velocities.
    fn set_tolerance(&mut self) {
        let relative = self.scene.solver.tolerance;
        self.system.set_tolerance(self.method.strictness(relative) * relative, self.state.tension);
    }

    /// A first sub-step on the scale of the fastest axial wave through the cable.
    fn first_step(&self) -> f64 {
        let cable = &self.scene.cable;
        let wave = cable.length * (cable.mass_per_length / cable.ea).sqrt();
        wave.clamp(10.0 * self.scene.solver.step_min, self.scene.solver.step_max)
    }

    /// Accelerations of the start state.
    fn settle(&mut self) {
        let (s, k) = (&mut self.state, &mut self.work);
        self.system.linearize(s.time, &s.u, &s.w, &s.a, &mut k.matrices, &mut k.force);
        let [mut mass, ..] = k.matrices.whole();
        // The mass matrix is positive definite, so this cannot fail.
        if mass.factor().is_ok() {
            s.a.copy_from_slice(&k.force);
            mass.solve(&mut s.a);
        }
    }

    /// Whether the ledger's entry at the end of a communication step is that of the forces which balance it there: only where the accelerations
    /// are known before, and but for a far end, whose support does work.
    fn balance_tells(&self) -> bool {
        (self.method.carries_over() || self.work.constant_mass.is_none()) && self.system.far_end.is_none()
    }

    /// Accelerations and the ledger's entry at the end of a communication step, where the balance there does not tell. Where the mass matrix
    /// depends on the shape the method has carried the accelerations along; elsewhere it has been factored once for all.
    fn conclude(&mut self) {
        if self.balance_tells() {
            return;
        }
        let (s, k) = (&mut self.state, &mut self.work);
        self.system.force(s.time, &s.u, &s.w, None, &mut k.force);
        s.ledger.reach(&self.system.tally, &s.w, &k.force);
        if !self.method.carries_over()
            && let Some(mass) = &k.constant_mass
        {
            s.a.copy_from_slice(&k.force);
            mass.solve(&mut s.a);
        }
    }

    /// Outputs of the present state, whose accelerations are known.
    fn observe(&mut self) {
        let tells = self.balance_tells();
        let s = &mut self.state;
        let env = self.system.environment(s.time);
        s.base = env.base.map(|b| b.0[2]);
        self.system.balance(&env, &s.u, &s.w, &s.a, &mut self.work.force);
        if tells {
            s.ledger.reach(&self.system.tally, &s.w, &self.work.force);
        }
        observe(&self.system, &env, &s.u, &s.w, &self.work.force, &mut self.outputs);
        if let FirstEnd::Winch { geometry, .. } = &self.system.first {
            self.outputs.winch.payout = geometry.sense * (self.outputs.winch.angle - s.first_angle) * geometry.radius;
        }
        let solver = &mut self.outputs.solver;
        [solver.steps, solver.rejected, solver.iterations] = s.counts;
        solver.energy_error = s.ledger.error();
        let status = &mut self.outputs.status;
        if self.work.overrun > 0.0 {
            status.code = 1;
            status.message = format!(
                "in real time: the {} sub-steps of solver.tries_max did not suffice, errors of up to {:.1e} times solver.tolerance were \
                 accepted; more of them, a shorter communication step or fewer elements would help",
                self.scene.solver.tries_max, self.work.overrun
            );
        } else if solver.energy_error > DEGRADED {
            status.code = 1;
            status.message = format!(
                "energy and work disagree by {:.1e} of the work done; a smaller solver.tolerance or more elements would help",
                solver.energy_error
            );
        } else {
            status.code = 0;
            status.message.clear();
        }
        self.observe_setpoint();
    }

    /// Integrates to `time` (s) exactly, with `inputs` as of the present time.
    ///
    /// # Errors
    /// [`SimError::Step`]; the state is then as it was before the call.
    pub fn step_to(&mut self, time: f64, inputs: &Inputs) -> Result<(), SimError> {
        let begin = self.state.time;
        if time <= begin || !time.is_finite() {
            return Err(SimError::Step(format!("the end {time} s must lie after the present time {begin} s")));
        }
        self.backup.copy(&self.state);
        self.work.outputs.copy(&self.outputs);
        let mut kept = std::mem::take(&mut self.work.tangent);
        kept.clear();
        self.visit_tangent(&mut |x| kept.extend_from_slice(x));
        self.work.tangent = kept;
        let drives = self.drives();
        self.last = None;
        self.drive(begin, time - begin, inputs);
        match self.integrate(time).and_then(|()| self.arrive(time)) {
            Ok(()) => {
                self.last = Some((drives, inputs.clone()));
                Ok(())
            }
            Err(message) => {
                self.outputs.copy(&self.work.outputs);
                let kept = std::mem::take(&mut self.work.tangent);
                let mut rest = &kept[..];
                self.visit_tangent(&mut |x| {
                    let (these, after) = rest.split_at(x.len());
                    x.copy_from_slice(these);
                    rest = after;
                });
                self.work.tangent = kept;
                self.method.retake(&mut self.system);
                self.rewind(&drives);
                self.outputs.status.code = 2;
                self.outputs.status.message.clone_from(&message);
                Err(SimError::Step(message))
            }
        }
    }

    /// Commits the state at the end of a step, unless absurd inputs made something overflow.
    fn arrive(&mut self, time: f64) -> Result<(), String> {
        self.system.ship.commit(time);
        if let FirstEnd::Winch { drive, .. } = &mut self.system.first {
            drive.commit(time);
        }
        self.system.save_axial(&mut self.state.n);
        self.conclude();
        self.observe();
        if self.is_finite() { Ok(()) } else { Err(format!("at t = {time} s: {NOT_FINITE}")) }
    }

    fn integrate(&mut self, end: f64) -> Result<(), String> {
        let solver = self.scene.solver;
        let mut taken = 0;
        // Tries left of this communication step, in real time.
        let (real_time, mut left) = (solver.tries_max > 0, solver.tries_max);
        self.work.overrun = 0.0;
        // Where nothing jumps the power at the begin is that at the end of the last communication step.
        let mut known = !self.work.jumped && self.method.carries_over();
        while self.state.time < end {
            let s = &mut self.state;
            let k = &mut self.work;
            let remaining = end - s.time;
            // Equal parts of what remains, none longer than the error control wants (a hundredth more saves a sliver).
            let mut parts = (remaining / (1.01 * s.step.min(solver.step_max))).ceil().max(1.0);
            if real_time {
                parts = parts.min(left as f64);
            }
            let mut h = remaining / parts;
            if !std::mem::take(&mut known) {
                self.method.begin(&mut self.system, s.time, [&s.u, &s.w, &s.a], &mut k.force);
                s.ledger.reach(&self.system.tally, &s.w, &k.force);
            }
            self.system.keep_axial();
            loop {
                self.system.attempt(s.time, h);
                let solves = self.method.counts()[0];
                let trial = self.method.attempt(&mut self.system, s.time, h, [&s.u, &s.w, &s.a], &k.force);
                s.counts[2] += self.method.counts()[0] - solves;
                let (error, why) = match trial {
                    Trial::Error(e) if e.is_finite() => (e, "the estimated error stays too large"),
                    Trial::Error(_) => (f64::INFINITY, "the solution is not finite"),
                    Trial::Singular(_) => (f64::INFINITY, "the system's matrix is singular"),
                    Trial::Stalled => (STALLED, "Newton's method does not converge"),
                };
                let order = self.method.estimate_order() as f64;
                let factor = (0.85 * error.powf(-1.0 / order)).clamp(0.2, 5.0);
                // The tries that are left must reach the end: with no room for shorter ones this one must do.
                left = left.saturating_sub(1);
                let shortest = if left > 0 { remaining / left as f64 } else { f64::INFINITY };
                if real_time && error > 1.0 && error.is_finite() && h <= 1.001 * shortest {
                    k.overrun = k.overrun.max(error);
                    s.last = [0.0; 2];
                    s.step = h * factor;
                    break;
                }
                if error <= 1.0 {
                    // Gustafsson's predictive control (Hairer & Wanner, IV.8): what the error did last it will do again.
                    let [h0, e0] = s.last;
                    let predicted = if h0 > 0.0 { factor * h / h0 * (e0 / error).powf(1.0 / order) } else { factor };
                    s.last = [h, error.max(1e-2)];
                    let wanted = h * factor.min(predicted.max(0.2));
                    // A step cut short by the communication point says nothing against longer ones.
                    s.step = if h < s.step { wanted.max(s.step) } else { wanted };
                    break;
                }
                s.counts[1] += 1;
                self.system.rewind();
                h *= factor.min(0.9);
                if real_time && left > 0 {
                    h = h.max(shortest);
                }
                s.step = h;
                if h < solver.step_min || real_time && left == 0 {
                    let node = match trial {
                        Trial::Singular(row) => row,
                        Trial::Error(_) | Trial::Stalled => self.worst_node(),
                    };
                    return Err(self.failure(end, node, why));
                }
            }
            taken += 1;
            let last = h >= remaining;
            let to = if last { end } else { s.time + h };
            let [u, w, a] = self.method.state();
            // Work by Simpson's rule, the state at mid-step from the cubic through both ends.
            let [mid_u, mid_w, mid_f] = &mut k.mid;
            midway(h, [&s.u, &s.w], [u, w], [&mut *mid_u, &mut *mid_w]);
            self.method.accept(&mut self.system);
            s.u.copy_from_slice(u);
            s.w.copy_from_slice(w);
            if self.method.carries_over() || self.system.mass_varies() {
                s.a.copy_from_slice(a);
            }
            self.system.force(s.time + 0.5 * h, mid_u, mid_w, None, mid_f);
            s.ledger.pass(h, &self.system.tally, mid_w, mid_f);
            self.system.reach(to, &mut s.u, &mut s.w, &mut s.a);
            s.time = to;
            s.counts[0] += 1;
            if reel::is_wound_up(&self.system, to, &s.u) {
                return Err(reel::message(to));
            }
            if taken >= solver.steps_max && s.time < end {
                let node = self.worst_node();
                return Err(self.failure(end, node, "solver.steps_max sub-steps were not enough"));
            }
        }
        Ok(())
    }

    /// The node with the greatest velocity error.
    fn worst_node(&self) -> usize {
        let size = |e: &[f64]| e[..3].iter().map(|x| x * x).sum::<f64>();
        let nodes = self.method.error().chunks_exact(6).enumerate();
        nodes.fold((0, -1.0), |best, (i, e)| if size(e) > best.1 || size(e).is_nan() { (i, size(e)) } else { best }).0
    }

    fn failure(&self, end: f64, node: usize, why: &str) -> String {
        let s = &self.state;
        let p: Vec<String> = (0..3)
            .map(|c| format!("{:.4}", s.u[6 * node.min(self.system.arc.len() - 1) + c] + self.system.environment(s.time).base[c].0[0]))
            .collect();
        format!(
            "at t = {:.6} s on the way to {end:.6} s, {:.4} m along the cable (node {node}, at ({}) m): {why} at sub-steps of {:.1e} s. \
             Try: smoother inputs (velocities beside poses), a shorter communication step, a softer contact stiffness, more damping, \
             or a larger solver.tolerance",
            s.time,
            self.system.arc_of(node),
            p.join(", "),
            s.step,
        )
    }

    /// Takes over the tunable parameters of a changed scene between two steps.
    ///
    /// # Errors
    /// [`SimError::State`] when the number of elements differs.
    pub fn retune(&mut self, scene: &Scene) -> Result<(), SimError> {
        if scene.elements.len() != self.scene.elements.len() {
            return Err(SimError::State("the number of elements cannot change during a run".into()));
        }
        self.scene = scene.clone();
        let fresh = System::new(scene);
        self.system.chain = fresh.chain;
        self.system.lump = fresh.lump;
        self.system.surfaces = fresh.surfaces;
        self.system.load = fresh.load;
        self.system.turning = fresh.turning;
        self.method.forget();
        if let (FirstEnd::Winch { drive, .. }, Some(winch)) = (&mut self.system.first, &scene.winch) {
            drive.retune(winch);
        }
        self.set_tolerance();
        Ok(())
    }

    /// Quantities of the last committed state.
    pub fn outputs(&self) -> &Outputs {
        &self.outputs
    }

    /// Linear solves, tangents and factorizations since this simulation was made, whatever states it was put into.
    pub fn effort(&self) -> [u64; 3] {
        self.method.counts()
    }

    /// Time of the last committed state, s.
    pub fn time(&self) -> f64 {
        self.state.time
    }

    /// Positions relative to the first node and slopes, six per node, m and 1.
    pub fn shape(&self) -> &[f64] {
        &self.state.u
    }

    /// Appends everything that the next step depends on: little-endian, no pointers, complete (a restored run is bit-identical).
    pub fn write_state(&self, bytes: &mut Vec<u8>) {
        self.clone().visit(&mut |x| bytes.extend_from_slice(&x.to_le_bytes()));
    }

    /// Takes over a state written by [`Self::write_state`] of a simulation of the same scene; leaves `self` untouched on error.
    ///
    /// # Errors
    /// [`SimError::State`] when the bytes do not fit this scene.
    pub fn read_state(&mut self, bytes: &[u8]) -> Result<(), SimError> {
        let mut expected = 0;
        self.visit(&mut |_| expected += 8);
        if bytes.len() != expected {
            return Err(SimError::State(format!("{} bytes do not fit this scene, which needs {expected}", bytes.len())));
        }
        let mut numbers = bytes.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap_or_default()));
        if !numbers.clone().all(f64::is_finite) {
            return Err(SimError::State("it holds numbers that are not finite".into()));
        }
        self.visit(&mut |x| *x = numbers.next().unwrap_or(f64::NAN));
        self.last = None;
        self.method.retake(&mut self.system);
        self.system.restore_axial(&self.state.n);
        self.outputs.status.message.clear();
        self.set_tolerance();
        Ok(())
    }

    /// Whether the numbers of state and outputs are finite.
    fn is_finite(&mut self) -> bool {
        let s = &self.state;
        // Without a branch, so that they go side by side.
        let all = |x: &[f64]| x.iter().fold(true, |all, x| all & x.is_finite());
        let mut finite = all(&s.u) && all(&s.w) && all(&s.a) && all(&s.n) && s.ledger.error().is_finite();
        self.outputs.visit(|x| finite &= x.is_finite());
        finite
    }

    /// Every number of the state and of the outputs, in a fixed order.
    fn visit(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let s = &mut self.state;
        let [h, error] = &mut s.last;
        for x in [&mut s.time, &mut s.step, h, error, &mut s.tension, &mut s.first_angle] {
            visit(x);
        }
        s.u.iter_mut().chain(&mut s.w).chain(&mut s.a).chain(&mut s.base).chain(&mut s.n).for_each(&mut *visit);
        for c in &mut s.counts {
            let mut x = *c as f64;
            visit(&mut x);
            // The largest count that a double holds exactly; only a forged state has more.
            *c = (x as u64).min(1 << 53);
        }
        s.ledger.visit(visit);
        self.system.ship.visit(visit);
        visit(&mut self.system.begin);
        for ramp in self.system.current.iter_mut().chain(&mut self.system.body_force) {
            visit(&mut ramp.value);
            visit(&mut ramp.rate);
        }
        if let Some(turbulence) = &mut self.system.turbulence {
            visit(&mut turbulence.start);
        }
        if let FirstEnd::Winch { drive, .. } = &mut self.system.first {
            drive.visit(visit);
        }
        if let Some(compensation) = &mut self.compensation {
            compensation.visit(visit);
        }
        self.outputs.visit(&mut *visit);
        self.visit_tangent(&mut |x| x.iter_mut().for_each(&mut *visit));
    }

    /// Where the tangent was taken that a method may keep from step to step, run by run.
    fn visit_tangent(&mut self, visit: &mut dyn FnMut(&mut [f64])) {
        if self.method.carries_over() {
            self.method.visit(visit);
            self.system.visit_origin(visit);
        }
    }
}

impl State {
    /// Without allocation.
    fn copy(&mut self, o: &Self) {
        self.u.copy_from_slice(&o.u);
        self.w.copy_from_slice(&o.w);
        self.a.copy_from_slice(&o.a);
        self.n.copy_from_slice(&o.n);
        (self.time, self.step, self.last, self.tension, self.first_angle) = (o.time, o.step, o.last, o.tension, o.first_angle);
        (self.counts, self.ledger, self.base) = (o.counts, o.ledger, o.base);
    }
}
