//! Assembly: the cable, its ends, water and contact as one second-order system in coordinates relative to the first node.
//!
//! r(p, t) = r_b(t) + u(p, t), where r_b is the first node's prescribed motion. So u(0) = 0 exactly at every time, the boundary's motion enters
//! only as the uniform inertia −M r̈_b and through the velocities that drag and contact see, and a ship far from the origin costs no digits.

pub mod contact;
mod cut;
mod elements;
mod environment;
mod far_end;
mod load;
mod matrices;
mod mixed;
mod points;
mod turning;
mod wetting;

use contact::Near;
pub use contact::SurfaceLoad;
use elements::{Axial, Axially};
pub use elements::{Chain, Each, ElementTangents, Tally, Wetness, gather};
pub use environment::Environment;
pub use far_end::FarEnd;
pub use load::RigidLoad;
pub use matrices::{Coupling, Matrices};
use mixed::AxialUnknown;
pub use points::ElementPoint;
pub use turning::TurningSheave;

use crate::cable::section::Section;
use crate::contact::surface::{Friction, Groove, Surface};
use crate::hydro::line::{Flow, LineInWater};
use crate::hydro::lump::LumpInWater;
use crate::hydro::turbulence::Turbulence;
use crate::integrator::{Problem, Stage};
use crate::math::jet::Jet;
use crate::math::lanes::{Kernel, Vec3, add_identity, add_outer, dot, widest};
use crate::scene::Scene;
use crate::ship::ShipDrive;
use crate::sim::Channel;
use crate::winch::{DrumGeometry, WinchDrive, reference_directions};

/// Stiffness of a `tangent` end over EI/L of the first element: its slope is held to about one over this.
const CLAMP: f64 = 1e4;

/// Slip speed below which friction fades, m/s: small beside a cable's working speeds, large enough for steps of milliseconds.
const SLIP_SPEED: f64 = 1e-3;

/// Where the first node goes.
#[derive(Clone, Debug)]
pub enum FirstEnd {
    /// On the drum.
    Winch {
        /// Its shape.
        geometry: DrumGeometry,
        /// Its rotation.
        drive: Box<WinchDrive>,
        /// Whether the cable feels it: it is the first of the surfaces.
        contact: bool,
        /// Stiffness that holds the slope, N·m; 0 when it is free.
        clamp: f64,
    },
    /// Fixed in ship axes.
    Anchor(Vec3<f64>),
}

/// The lump at the last node.
#[derive(Clone, Debug)]
pub struct Lump {
    /// kg.
    pub mass: f64,
    /// In water.
    pub water: Option<LumpInWater>,
}

/// An input that is linear in time over a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ramp {
    /// Value at the step's begin.
    pub value: f64,
    /// Its rate.
    pub rate: f64,
}

impl Ramp {
    fn at(&self, tau: f64) -> f64 {
        self.value + tau * self.rate
    }
}

impl From<&Channel> for Ramp {
    fn from(c: &Channel) -> Self {
        Self { value: c.value, rate: c.first.unwrap_or(0.0) }
    }
}

/// The assembled system.
#[derive(Clone, Debug)]
pub struct System {
    /// The elements.
    pub chain: Chain,
    /// Arc length of each node, m.
    pub arc: Vec<f64>,
    /// The first end.
    pub first: FirstEnd,
    /// The last end.
    pub lump: Lump,
    /// A rigid load there.
    pub load: Option<RigidLoad>,
    /// Or a fixed end.
    pub far_end: Option<FarEnd>,
    /// The ship.
    pub ship: ShipDrive,
    /// Time at which the present step began, s.
    pub begin: f64,
    /// Uniform current.
    pub current: [Ramp; 2],
    /// The current's turbulence.
    pub turbulence: Option<Turbulence>,
    /// Force on the body.
    pub body_force: [Ramp; 3],
    /// Forces of each element on its slots, of the last evaluation of the law, without contact.
    pub forces: Vec<[f64; 12]>,
    /// Drum and sheaves: what the cable can touch.
    pub surfaces: Vec<Surface>,
    /// The sheaves' names, and whether the cable passes over them (or under).
    pub names: Vec<String>,
    /// See `names`.
    pub over: Vec<bool>,
    /// What each of them feels, of the last evaluation.
    pub surface_loads: Vec<SurfaceLoad>,
    /// Those that turn.
    pub turning: Vec<TurningSheave>,
    /// Forces of drum and sheaves on the elements' slots, of the last evaluation.
    pub contact_forces: Vec<[f64; 12]>,
    /// Force of everything outside the cable on the last node, of the last evaluation, N.
    pub lump_force: Vec3<f64>,
    /// Couple-like force of the clamp on the first slope, N·m.
    pub clamp_force: Vec3<f64>,
    /// Sums of the last evaluation.
    pub tally: Tally,
    /// Static evaluation: the boundary's velocity is seen by the water, its acceleration and the winch's rate are not.
    pub frozen: bool,
    /// Whether a tangent begins a step: the axial forces are then unknowns of the state and no longer given by the shape alone.
    pub keeps_axial: bool,
    gravity: f64,
    /// Tolerable velocity error in the mass norm, kg·m²/s².
    tolerance: f64,
    matrices: Matrices,
    axial: Vec<Axial>,
    near: Near,
    crossed: Vec<usize>,
    /// Where the last tangent was taken.
    origin: Environment,
    /// At the stage in which Newton's method iterates.
    stage: Environment,
}

/// The outside world at an instant.
struct At<'a> {
    system: &'a System,
    t: f64,
}

impl Kernel for At<'_> {
    type Output = Environment;

    #[inline(always)]
    fn run(self) -> Environment {
        self.system.environment_at(self.t)
    }
}

impl System {
    /// From a checked scene.
    pub fn new(scene: &Scene) -> Self {
        let section = Section::new(&scene.cable);
        let water = scene.fluid.as_ref().map(|f| LineInWater::new(f, scene.cable.diameter, scene.gravity));
        let mut arc = vec![0.0];
        for l in &scene.elements {
            arc.push(arc[arc.len() - 1] + l);
        }
        let first = match (&scene.winch, &scene.anchor) {
            (Some(w), _) => {
                let geometry = DrumGeometry::new(w, scene.cable.diameter);
                FirstEnd::Winch {
                    geometry,
                    drive: Box::new(WinchDrive::new(w)),
                    contact: w.contact.is_some(),
                    clamp: if w.tangent_end { CLAMP * scene.cable.ei / scene.elements[0] } else { 0.0 },
                }
            }
            (None, anchor) => FirstEnd::Anchor(anchor.map_or([0.0; 3], Into::into)),
        };
        let lump = Lump {
            mass: scene.body.as_ref().map_or(0.0, |b| b.mass),
            water: scene.body.as_ref().and_then(|b| scene.fluid.as_ref().map(|f| LumpInWater::new(f, b, scene.gravity))),
        };
        let surfaces = surfaces(scene);
        let n = scene.elements.len();
        let chain = Chain::new(scene.elements.clone(), scene.cable.mass_per_length, section, water);
        let axial = chain.axial();
        Self {
            chain,
            arc,
            first,
            lump,
            load: scene.load.as_ref().map(RigidLoad::from),
            far_end: scene.far_end.map(|r| FarEnd::new(r.into())),
            ship: ShipDrive::default(),
            begin: 0.0,
            current: Default::default(),
            turbulence: scene.fluid.as_ref().and_then(|f| f.noise.as_ref()).map(Turbulence::new),
            body_force: Default::default(),
            forces: vec![[0.0; 12]; n],
            contact_forces: vec![[0.0; 12]; n],
            names: scene.sheaves.iter().map(|s| s.name.clone()).collect(),
            over: scene.sheaves.iter().map(|s| s.over).collect(),
            surface_loads: vec![SurfaceLoad::default(); surfaces.len()],
            turning: TurningSheave::all(scene, surfaces.len(), n + 1 + usize::from(scene.load.is_some())),
            surfaces,
            lump_force: [0.0; 3],
            clamp_force: [0.0; 3],
            tally: Tally::default(),
            frozen: false,
            keeps_axial: false,
            gravity: scene.gravity,
            tolerance: 1.0,
            matrices: Matrices::default(),
            axial,
            near: Near::new(n),
            crossed: Vec::with_capacity(n),
            origin: Environment::default(),
            stage: Environment::default(),
        }
    }

    /// Number of blocks of six unknowns: the cable's nodes, the load's, and those of turning sheaves.
    pub fn nodes(&self) -> usize {
        self.arc.len() + usize::from(self.load.is_some()) + self.turning.len().div_ceil(6)
    }

    /// Arc length of a block, the load's being the cable's end, m.
    pub fn arc_of(&self, node: usize) -> f64 {
        self.arc[node.min(self.arc.len() - 1)]
    }

    /// Mass of what hangs at the last node, kg.
    pub fn end_mass(&self) -> f64 {
        self.lump.mass + self.load.map_or(0.0, |l| l.mass)
    }

    /// Element and ξ of arc length `s`.
    pub fn element_at(&self, s: f64) -> (usize, f64) {
        let count = self.chain.lengths.len();
        let e = self.arc[1..count].partition_point(|x| *x <= s).min(count - 1);
        (e, ((s - self.arc[e]) / self.chain.lengths[e]).clamp(0.0, 1.0))
    }

    /// Mass of the cable, kg.
    pub fn cable_mass(&self) -> f64 {
        self.chain.mass_per_length * self.arc[self.arc.len() - 1]
    }

    /// Sets the tolerable velocity error so that it means an error of `relative` in a tension of size `tension`:
    /// an axial wave of velocity Δv carries ΔT = √(EA m_l) Δv.
    pub fn set_tolerance(&mut self, relative: f64, tension: f64) {
        let v = relative * tension / (self.chain.section.ea * self.chain.mass_per_length).sqrt();
        self.tolerance = v * v * self.cable_mass();
    }

    /// The outside world at `t`.
    pub fn environment(&self, t: f64) -> Environment {
        widest(At { system: self, t })
    }

    #[inline(always)]
    fn environment_at(&self, t: f64) -> Environment {
        let frame = self.ship.frame(t);
        let tau = t - self.begin;
        let (mut base, tangent) = match &self.first {
            FirstEnd::Winch { geometry, drive, .. } => {
                let mut phi = drive.angle(t);
                if self.frozen {
                    phi = Jet::constant(phi.0[0]);
                }
                let (rim, along) = geometry.rim(phi);
                (frame.point(&rim), frame.direction(&along).map(|j| j.0[0]))
            }
            FirstEnd::Anchor(s) => (frame.point(&s.map(Jet::constant)), [0.0; 3]),
        };
        if self.frozen {
            for b in &mut base {
                (b.0[2], b.0[3]) = (0.0, 0.0);
                // Between two fixed ends nothing is towed.
                if self.far_end.is_some() {
                    b.0[1] = 0.0;
                }
            }
        }
        Environment {
            time: t,
            far_end_acceleration: self.far_end.map_or([0.0; 3], |end| end.acceleration(t, &base)),
            base,
            tangent,
            frame,
            flow: self.flow(t),
            gravity: [0.0, 0.0, -self.gravity],
            body_force: std::array::from_fn(|c| self.body_force[c].at(tau)),
        }
    }

    /// The uniform part of the current at `t`; statics know neither turbulence nor rates.
    fn flow(&self, t: f64) -> Flow {
        let [x, y] = &self.current;
        let tau = t - self.begin;
        let mut flow = Flow { velocity: [x.at(tau), y.at(tau), 0.0], acceleration: [x.rate, y.rate, 0.0] };
        if self.frozen {
            flow.acceleration = [0.0; 3];
        } else if let Some(turbulence) = &self.turbulence {
            let [v, a] = turbulence.at(t);
            for c in 0..3 {
                flow.velocity[c] += v[c];
                flow.acceleration[c] += a[c];
            }
        }
        flow
    }

    /// Evaluates all forces; with `TANGENT` adds to the matrices, which the caller has cleared.
    fn evaluate<const TANGENT: bool>(
        &mut self,
        env: &Environment,
        u: &[f64],
        w: &[f64],
        a: Option<&[f64]>,
        axially: Axially,
        f: &mut [f64],
        m: &mut Matrices,
    ) {
        self.tally = self.chain.pass::<TANGENT>(env, u, w, a, axially, &mut self.axial, &mut self.forces, f, m);
        if self.chain.water.is_some() {
            self.cut::<TANGENT>(env, u, w, a, f, m);
        }
        if !self.surfaces.is_empty() {
            self.contact::<TANGENT>(env, u, w, f, m);
        }
        self.ends::<TANGENT>(env, u, w, a, f, m);
        self.turn::<TANGENT>(env, w, a, f, m);
        self.account_for_far_end(env, u, w);
    }

    /// The body at the last node and the clamp at the first.
    fn ends<const TANGENT: bool>(&mut self, env: &Environment, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64], m: &mut Matrices) {
        self.lumped::<TANGENT>(env, u, w, a, f, m);
        self.hang::<TANGENT>(env, u, w, a, f, m);
        if let FirstEnd::Winch { clamp, .. } = &self.first
            && *clamp > 0.0
        {
            // ½ k ‖r_p − t (t·r_p)‖²: holds the direction, leaves the stretch.
            let t = env.tangent;
            let p = [u[3], u[4], u[5]];
            let along = dot(&p, &t);
            self.clamp_force = std::array::from_fn(|c| -clamp * (p[c] - along * t[c]));
            for c in 0..3 {
                f[3 + c] += self.clamp_force[c];
            }
            if TANGENT {
                let mut k = [[0.0; 3]; 3];
                add_identity(&mut k, *clamp);
                add_outer(&mut k, -clamp, &t, &t);
                for r in 0..3 {
                    for c in 0..3 {
                        m.stiffness.add(0, 0, 3 + r, 3 + c, k[r][c]);
                    }
                }
            }
        }
    }

    /// The lump at the last node.
    fn lumped<const TANGENT: bool>(&mut self, env: &Environment, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64], m: &mut Matrices) {
        if self.load.is_some() {
            return;
        }
        let n = self.arc.len() - 1;
        let at = 6 * n;
        let mut force: Vec3<f64> = std::array::from_fn(|c| {
            let acc = env.base[c].0[2] + a.map_or(0.0, |a| a[at + c]);
            self.lump.mass * (env.gravity[c] - acc) + env.body_force[c]
        });
        let wn = [w[at], w[at + 1], w[at + 2]];
        let an = a.map_or([0.0; 3], |a| [a[at], a[at + 1], a[at + 2]]);
        self.tally.kinetic += 0.5 * self.lump.mass * dot(&wn, &wn);
        self.tally.accelerate(self.lump.mass * dot(&wn, &an));
        if TANGENT {
            for c in 0..3 {
                m.mass.add(n, n, c, c, self.lump.mass);
            }
        }
        if let (Some(lump), Some(line)) = (&self.lump.water, &self.chain.water) {
            let z = u[at + 2] + env.base[2].0[0];
            let v: Vec3<f64> = std::array::from_fn(|c| wn[c] + env.base[c].0[1]);
            let acc: Vec3<f64> = std::array::from_fn(|c| env.base[c].0[2] + a.map_or(0.0, |a| a[at + c]));
            let (mut vf, dvf) = line.profile(z);
            for c in 0..3 {
                vf[c] += env.flow.velocity[c];
            }
            let load = lump.load(z, &v, &acc, &vf, &dvf, &env.flow.acceleration);
            self.tally.kinetic += 0.5 * load.mass * dot(&wn, &wn);
            self.tally.accelerate(load.mass * dot(&wn, &an));
            self.tally.turning += 0.5 * load.mass_dz * v[2] * dot(&wn, &wn);
            for c in 0..3 {
                force[c] += load.f[c];
            }
            if TANGENT {
                for r in 0..3 {
                    m.mass.add(n, n, r, r, load.mass);
                    m.stiffness.add(n, n, r, 2, -load.dz[r]);
                    for c in 0..3 {
                        m.damping.add(n, n, r, c, -load.dv[r][c]);
                    }
                }
            }
        }
        for c in 0..3 {
            f[at + c] += force[c];
        }
        self.lump_force = force;
    }

    /// A step begins; its tries start from the axial forces as they are.
    pub fn keep_axial(&mut self) {
        self.axial.iter_mut().flatten().for_each(AxialUnknown::keep);
    }

    /// Every number beside u, w, a that the last tangent depends on, run by run, for snapshots.
    pub fn visit_origin(&mut self, visit: &mut dyn FnMut(&mut [f64])) {
        self.origin.visit(visit);
        self.axial.iter_mut().flatten().for_each(|a| visit(&mut a.origin.0));
    }

    /// Copies the state's axial forces, three per element (N), out of the system.
    pub fn save_axial(&self, to: &mut [f64]) {
        for (to, n) in to.iter_mut().zip(elements::axial_forces(&self.axial)) {
            *to = *n;
        }
    }

    /// Puts them back; they are then part of the state.
    pub fn restore_axial(&mut self, from: &[f64]) {
        self.keeps_axial = true;
        for (n, from) in elements::axial_forces_mut(&mut self.axial).zip(from) {
            *n = *from;
        }
    }

    fn force_at(&mut self, axially: Axially, t: f64, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]) {
        let env = self.environment(t);
        self.force_in(&env, axially, u, w, a, f);
    }

    fn force_in(&mut self, env: &Environment, axially: Axially, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]) {
        let mut none = std::mem::take(&mut self.matrices);
        self.evaluate::<false>(env, u, w, a, axially, f, &mut none);
        self.matrices = none;
        f[..3].fill(0.0);
        self.drive_far_end(env, a, f);
    }

    /// F, and M, D, K of F − M(u) a, in the environment of `origin`.
    fn tangent(&mut self, u: &[f64], w: &[f64], a: &[f64], m: &mut Matrices, f: &mut [f64]) {
        let env = self.origin;
        m.clear(self.turning.iter().map(|s| s.at));
        // The tangent wants F − M(u) a, the caller F: add M a back.
        let varies = self.mass_varies();
        self.evaluate::<true>(&env, u, w, varies.then_some(a), if self.keeps_axial { Axially::Begin } else { Axially::Law }, f, m);
        if varies {
            m.multiply_add([Some((1.0, a)), None, None], f);
            self.tally.inertial = [0.0; 2];
        }
        // Positions of the first node and of a fixed far end.
        m.pin(0);
        if self.far_end.is_some() {
            m.pin(self.arc.len() - 1);
        }
        f[..3].fill(0.0);
        self.drive_far_end(&env, None, f);
    }

    /// Forces with all inertia, nothing zeroed: rows of the first node hold what the support must balance.
    pub fn balance(&mut self, env: &Environment, u: &[f64], w: &[f64], a: &[f64], f: &mut [f64]) {
        let mut none = std::mem::take(&mut self.matrices);
        self.evaluate::<false>(env, u, w, Some(a), Axially::Law, f, &mut none);
        self.matrices = none;
    }
}

/// Drum (first, if the cable feels it) and sheaves.
fn surfaces(scene: &Scene) -> Vec<Surface> {
    let d = scene.cable.diameter;
    let basis = |axis: &nalgebra::Vector3<f64>| {
        let (up, side) = reference_directions(axis);
        [(*axis).into(), up.into(), side.into()]
    };
    let drum = scene.winch.iter().filter_map(|w| {
        let law = w.contact?;
        Some(Surface { centre: w.position.into(), basis: basis(&w.axis), radius: w.radius + 0.5 * d, law, groove: None, friction: None })
    });
    let sheaves = scene.sheaves.iter().map(|s| Surface {
        centre: s.position.into(),
        basis: basis(&s.axis),
        radius: s.radius + 0.5 * d,
        law: s.contact,
        groove: s.groove_angle.map(|a| Groove::new(a, s.groove_depth, d)),
        friction: (s.friction > 0.0).then_some(Friction { coefficient: s.friction, slip_speed: SLIP_SPEED }),
    });
    drum.chain(sheaves).collect()
}

impl Problem for System {
    fn size(&self) -> usize {
        6 * self.nodes()
    }

    fn force(&mut self, t: f64, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]) {
        self.force_at(Axially::Law, t, u, w, a, f);
    }

    fn stage_force(&mut self, stage: Stage, t: f64, u: &[f64], w: &[f64], a: Option<&[f64]>, f: &mut [f64]) {
        self.force_at(Axially::Stage(stage), t, u, w, a, f);
    }

    fn linearize(&mut self, t: f64, u: &[f64], w: &[f64], a: &[f64], m: &mut Matrices, f: &mut [f64]) {
        self.origin = self.environment(t);
        self.tangent(u, w, a, m, f);
    }

    fn relinearize(&mut self, u: &[f64], w: &[f64], a: &[f64], m: &mut Matrices, f: &mut [f64]) {
        self.axial.iter_mut().flatten().for_each(AxialUnknown::back_to_origin);
        self.keeps_axial = true;
        self.tangent(u, w, a, m, f);
    }
    fn time_derivative(&mut self, t: f64, scale: f64, u: &[f64], w: &[f64], force: &[f64], f: &mut [f64]) -> bool {
        let winch_moves = matches!(&self.first, FirstEnd::Winch { drive, .. } if drive.is_moving());
        let inputs_move = self.current.iter().chain(&self.body_force).any(|r| r.rate != 0.0);
        if !(self.ship.is_moving() || winch_moves || inputs_move || self.turbulence.is_some()) {
            return false;
        }
        // Elastic forces do not depend on time and cancel bit by bit, so a small difference loses nothing.
        let dt = (1e-4 * scale).max(1e-9);
        let tally = self.tally;
        self.force(t + dt, u, w, None, f);
        self.tally = tally;
        let i = 1.0 / dt;
        for (f, f0) in f.iter_mut().zip(force) {
            *f = (*f - f0) * i;
        }
        self.far_end_rate(t, f);
        true
    }

    fn mass_varies(&self) -> bool {
        self.chain.water.is_some() || self.load.is_some()
    }

    fn accept(&mut self, u: &[f64], w: &[f64], weights: &[f64]) {
        self.chain.accept(u, w, weights, &mut self.axial);
    }

    fn iterate(&mut self, first: bool, t: f64, u: &[f64], w: &[f64], a: &[f64], f: &mut [f64]) {
        if first {
            self.stage = self.environment(t);
        }
        let env = self.stage;
        self.force_in(&env, Axially::Iterate { first }, u, w, Some(a), f);
    }

    fn adopt(&mut self, u: &[f64], w: &[f64]) {
        self.chain.adopt(u, w, &mut self.axial);
    }

    fn settle(&mut self, u: &[f64], w: &[f64]) {
        self.chain.settle(u, w, &mut self.axial);
    }

    fn rewind(&mut self) {
        self.axial.iter_mut().flatten().for_each(AxialUnknown::rewind);
    }

    fn size_of(&self, energy: f64) -> f64 {
        (energy / self.tolerance).sqrt()
    }
}
