//! The table of variable families: one row, and the variable is in the interface, the XML and the documentation.

use crate::keys;
use crate::pattern::{components, expand};
use crate::units::{self as u, Type};
use crate::{Causality, Input, Kind, Quantity, Shape, Value, Variability, Variable};

/// Output quantities, one variant a family; a component is 0-based, and so are sheaves and points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// Force on the ship in ship axes: component.
    ShipForce(usize),
    /// Moment on the ship: component.
    ShipMoment(usize),
    /// Force on the ship in world axes: component.
    ShipForceWorld(usize),
    /// `winch.tension`.
    WinchTension,
    /// `winch.angle`.
    WinchAngle,
    /// `winch.rate`.
    WinchRate,
    /// `winch.torque`.
    WinchTorque,
    /// `winch.payout`.
    WinchPayout,
    /// `winch.target`.
    WinchTarget,
    /// `winch.target_rate`.
    WinchTargetRate,
    /// Force on the drum: component.
    WinchForce(usize),
    /// `anchor.tension`.
    AnchorTension,
    /// Force on the anchor: component.
    AnchorForce(usize),
    /// Force on a sheave: sheave, component.
    SheaveForce(usize, usize),
    /// Moment on a sheave: sheave, component.
    SheaveMoment(usize, usize),
    /// Magnitude of the force on a sheave.
    SheaveNormalForce(usize),
    /// Force on a flank: sheave, flank.
    SheaveFlankForce(usize, usize),
    /// Tension on the winch side of a sheave.
    SheaveTensionIn(usize),
    /// Tension on the far side of a sheave.
    SheaveTensionOut(usize),
    /// Contact arc on a sheave.
    SheaveWrapAngle(usize),
    /// Where contact starts on a sheave.
    SheaveContactBegin(usize),
    /// Where contact ends on a sheave.
    SheaveContactEnd(usize),
    /// Turn of the cable over a sheave.
    SheaveTurnAngle(usize),
    /// Greatest line load on a sheave.
    SheaveLineLoadMax(usize),
    /// Least line load on a sheave.
    SheaveLineLoadMin(usize),
    /// Whether a sheave is touched.
    SheaveInContact(usize),
    /// Whether the cable has left a sheave's groove.
    SheaveOutOfGroove(usize),
    /// Angle of a turning sheave.
    SheaveAngle(usize),
    /// Angular velocity of a turning sheave.
    SheaveRate(usize),
    /// `cable.tension_max`.
    CableTensionMax,
    /// `cable.tension_min`.
    CableTensionMin,
    /// `cable.slack`.
    CableSlack,
    /// `cable.point[k].*`: point, component.
    CablePoint(usize, usize),
    /// Position of the body: component.
    BodyPosition(usize),
    /// Velocity of the body: component.
    BodyVelocity(usize),
    /// `body.tension`.
    BodyTension,
    /// Position of the load's centre of gravity: component.
    LoadPosition(usize),
    /// Its velocity: component.
    LoadVelocity(usize),
    /// `load.tension`.
    LoadTension,
    /// `load.angle`.
    LoadAngle,
    /// Force of the cable on the fixed far end: component.
    FarEndForce(usize),
    /// `far_end.tension`.
    FarEndTension,
    /// Turbulence of the current: component.
    CurrentNoise(usize),
    /// `status.code`.
    StatusCode,
    /// `status.message`.
    StatusMessage,
    /// `solver.steps`.
    SolverSteps,
    /// `solver.rejected`.
    SolverRejected,
    /// `solver.iterations`.
    SolverIterations,
    /// `solver.energy_error`.
    SolverEnergyError,
}

/// For which parts of a scene a family exists.
#[derive(Clone, Copy)]
pub enum Occurs {
    /// In every scene, once.
    Always,
    /// Once, if.
    If(fn(&Shape) -> bool),
    /// For each sheave.
    EachSheave,
    /// For each sheave with a groove.
    EachGroove,
    /// For each sheave that turns.
    EachTurning,
    /// For each point of the cable.
    EachPoint,
}

impl Occurs {
    /// 0-based indices of the parts.
    fn parts(self, shape: &Shape) -> Vec<usize> {
        match self {
            Self::Always => vec![0],
            Self::If(condition) => (0..usize::from(condition(shape))).collect(),
            Self::EachSheave => (0..shape.sheaves.len()).collect(),
            Self::EachGroove => (0..shape.sheaves.len()).filter(|&i| shape.sheaves[i].groove).collect(),
            Self::EachTurning => (0..shape.sheaves.len()).filter(|&i| shape.sheaves[i].turns).collect(),
            Self::EachPoint => (0..shape.points).collect(),
        }
    }
}

/// Base type, with the physical type of a Real.
#[derive(Clone, Copy, Debug)]
pub enum Of {
    /// f64.
    Real(&'static Type),
    /// i32.
    Integer,
    /// bool.
    Boolean,
    /// UTF-8.
    Text,
}

/// Start value of an input.
#[derive(Clone, Copy, Debug)]
pub enum Start {
    /// 0.
    Zero,
    /// That of this parameter.
    Parameter(&'static str),
}

/// Which way a signal goes.
#[derive(Clone, Copy)]
pub enum Signal {
    /// Set by the importer: component -> quantity.
    Input(fn(usize) -> Input, Start),
    /// Read by the importer: part, component -> quantity.
    Output(fn(usize, usize) -> Output),
}

/// One row.
pub struct Family {
    /// Number that the value references start from; never reused, so that references stay the same from release to release.
    pub id: u32,
    /// Name pattern.
    pub name: &'static str,
    /// Condition on the scene.
    pub occurs: Occurs,
    /// Base type.
    pub of: Of,
    /// Causality and binding.
    pub signal: Signal,
    /// One sentence without a full stop; `{}` is the component.
    pub description: &'static str,
}

/// Value references of a family: `id` in the upper half.
pub(crate) const fn reference(id: u32, index: usize) -> u32 {
    (id << 16) + index as u32
}

const fn input(
    id: u32,
    name: &'static str,
    on: fn(&Shape) -> bool,
    t: &'static Type,
    make: fn(usize) -> Input,
    description: &'static str,
) -> Family {
    Family { id, name, occurs: Occurs::If(on), of: Of::Real(t), signal: Signal::Input(make, Start::Zero), description }
}

const fn output(
    id: u32,
    name: &'static str,
    occurs: Occurs,
    of: Of,
    make: fn(usize, usize) -> Output,
    description: &'static str,
) -> Family {
    Family { id, name, occurs, of, signal: Signal::Output(make), description }
}

use Occurs::{Always, EachGroove, EachPoint, EachSheave, EachTurning, If};
use Of::{Boolean, Integer, Real, Text};

const WINCH: Occurs = If(|s| s.winch);
const ANCHOR: Occurs = If(|s| s.anchor);
const SHIP: Occurs = If(|s| s.ship_derivatives.is_some());
const BODY: Occurs = If(|s| s.body);
const LOAD: Occurs = If(|s| s.load);
const FAR_END: Occurs = If(|s| s.far_end);

fn derivatives(shape: &Shape, order: usize) -> bool {
    shape.ship_derivatives.is_some_and(|n| n >= order)
}

fn built_in(shape: &Shape) -> bool {
    shape.winch && !shape.external_setpoint
}

/// All inputs and outputs.
#[rustfmt::skip] // one row a line
pub static FAMILIES: &[Family] = &[
    input(1, "ship.{x,y,z}", |s| derivatives(s, 0), &u::POSITION, |c| Input::Ship(c, 0), "Position of the ship frame's origin in the inertial frame, {}"),
    input(2, "ship.{roll,pitch,yaw}", |s| derivatives(s, 0), &u::ANGLE, |c| Input::Ship(3 + c, 0), "Attitude of the ship, {} (yaw first, then pitch, then roll)"),
    input(3, "ship.{vx,vy,vz}", |s| derivatives(s, 1), &u::VELOCITY, |c| Input::Ship(c, 1), "Time derivative of the ship frame's position in the inertial frame, {}"),
    input(4, "ship.{roll_rate,pitch_rate,yaw_rate}", |s| derivatives(s, 1), &u::ANGULAR_VELOCITY, |c| Input::Ship(3 + c, 1), "Time derivative of the attitude angle, {}"),
    input(5, "ship.{ax,ay,az}", |s| derivatives(s, 2), &u::ACCELERATION, |c| Input::Ship(c, 2), "Second time derivative of the ship frame's position in the inertial frame, {}"),
    input(6, "ship.{roll_acceleration,pitch_acceleration,yaw_acceleration}", |s| derivatives(s, 2), &u::ANGULAR_ACCELERATION, |c| Input::Ship(3 + c, 2), "Second time derivative of the attitude angle, {}"),
    Family { id: 7, name: "winch.setpoint", occurs: If(|s| s.external_setpoint && !s.payout_command), of: Real(&u::ANGLE), signal: Signal::Input(|_| Input::Setpoint, Start::Parameter("winch.initial_angle")), description: "Set-point of the drum angle, right-handed about the axis from \"up\"" },
    input(8, "winch.setpoint_rate", |s| s.external_setpoint && !s.payout_command, &u::ANGULAR_VELOCITY, |_| Input::SetpointRate, "Time derivative of the set-point"),
    input(9, "winch.setpoint", |s| s.external_setpoint && s.payout_command, &u::PAYOUT, |_| Input::Setpoint, "Set-point of the cable length paid out since the start"),
    input(10, "winch.setpoint_rate", |s| s.external_setpoint && s.payout_command, &u::VELOCITY, |_| Input::SetpointRate, "Time derivative of the set-point"),
    input(11, "current.{x,y}", |s| s.fluid, &u::VELOCITY, Input::Current, "Uniform current in the inertial frame, added to the scene's profile, {}"),
    input(12, "body.force.{x,y,z}", |s| s.body_force, &u::FORCE, Input::BodyForce, "External force on the body in the inertial frame, {}"),

    output(101, "ship.force.{x,y,z}", SHIP, Real(&u::FORCE), |_, c| Output::ShipForce(c), "Force of cable, winch and sheaves on the ship, ship axes, {}"),
    output(102, "ship.moment.{x,y,z}", SHIP, Real(&u::MOMENT), |_, c| Output::ShipMoment(c), "Moment of cable, winch and sheaves on the ship about the ship frame's origin, ship axes, {}"),
    output(103, "ship.force_world.{x,y,z}", SHIP, Real(&u::FORCE), |_, c| Output::ShipForceWorld(c), "Force of cable, winch and sheaves on the ship, inertial frame, {}"),
    output(110, "winch.tension", WINCH, Real(&u::FORCE), |_, _| Output::WinchTension, "Pull of the free span where the cable leaves the drum"),
    output(111, "winch.angle", WINCH, Real(&u::ANGLE), |_, _| Output::WinchAngle, "Angle of the cable's first node about the drum's axis, right-handed, from \"up\""),
    output(112, "winch.rate", WINCH, Real(&u::ANGULAR_VELOCITY), |_, _| Output::WinchRate, "Angular velocity of the drum relative to the ship"),
    output(113, "winch.torque", WINCH, Real(&u::MOMENT), |_, _| Output::WinchTorque, "Moment of the cable on the drum about its axis"),
    output(114, "winch.payout", WINCH, Real(&u::PAYOUT), |_, _| Output::WinchPayout, "Cable length paid out since the start"),
    output(115, "winch.force.{x,y,z}", WINCH, Real(&u::FORCE), |_, c| Output::WinchForce(c), "Force of the cable on the drum, ship axes, {}"),
    output(116, "winch.target", If(|s| built_in(s) && !s.payout_command), Real(&u::ANGLE), |_, _| Output::WinchTarget, "Set-point of the drum angle from the built-in heave compensation"),
    output(117, "winch.target_rate", If(|s| built_in(s) && !s.payout_command), Real(&u::ANGULAR_VELOCITY), |_, _| Output::WinchTargetRate, "Time derivative of the built-in set-point"),
    output(118, "winch.target", If(|s| built_in(s) && s.payout_command), Real(&u::PAYOUT), |_, _| Output::WinchTarget, "Set-point of the cable length paid out since the start from the built-in heave compensation"),
    output(119, "winch.target_rate", If(|s| built_in(s) && s.payout_command), Real(&u::VELOCITY), |_, _| Output::WinchTargetRate, "Time derivative of the built-in set-point"),
    output(120, "anchor.tension", ANCHOR, Real(&u::FORCE), |_, _| Output::AnchorTension, "Axial force of the cable at its anchor"),
    output(121, "anchor.force.{x,y,z}", ANCHOR, Real(&u::FORCE), |_, c| Output::AnchorForce(c), "Force of the cable on the anchor, ship axes, {}"),
    output(130, "sheave[i].force.{x,y,z}", EachSheave, Real(&u::FORCE), Output::SheaveForce, "Force of the cable on the sheave, ship axes, {}"),
    output(131, "sheave[i].moment.{x,y,z}", EachSheave, Real(&u::MOMENT), Output::SheaveMoment, "Moment of the cable on the sheave about its centre, ship axes, {}"),
    output(132, "sheave[i].normal_force", EachSheave, Real(&u::CONTACT_FORCE), |i, _| Output::SheaveNormalForce(i), "Magnitude of the cable's force on the sheave"),
    output(133, "sheave[i].flank_force[{1,2}]", EachGroove, Real(&u::CONTACT_FORCE), Output::SheaveFlankForce, "Normal force on groove flank {} (flank 1's normal points along the axis)"),
    output(134, "sheave[i].tension_in", EachSheave, Real(&u::FORCE), |i, _| Output::SheaveTensionIn(i), "Pull of the free span on the winch side"),
    output(135, "sheave[i].tension_out", EachSheave, Real(&u::FORCE), |i, _| Output::SheaveTensionOut(i), "Pull of the free span on the far side"),
    output(136, "sheave[i].wrap_angle", EachSheave, Real(&u::ARC_ANGLE), |i, _| Output::SheaveWrapAngle(i), "Contact arc"),
    output(137, "sheave[i].contact_begin", EachSheave, Real(&u::ANGLE), |i, _| Output::SheaveContactBegin(i), "Where contact starts, angle about the axis from \"up\""),
    output(138, "sheave[i].contact_end", EachSheave, Real(&u::ANGLE), |i, _| Output::SheaveContactEnd(i), "Where contact ends, angle about the axis from \"up\""),
    output(139, "sheave[i].turn_angle", EachSheave, Real(&u::ANGLE), |i, _| Output::SheaveTurnAngle(i), "Turn of the cable from the free span on one side to the free span on the other"),
    output(140, "sheave[i].line_load_max", EachSheave, Real(&u::LINE_LOAD), |i, _| Output::SheaveLineLoadMax(i), "Greatest line load in the contact arc"),
    output(141, "sheave[i].line_load_min", EachSheave, Real(&u::LINE_LOAD), |i, _| Output::SheaveLineLoadMin(i), "Least line load in the contact arc; near zero, the cable is about to lift off"),
    output(142, "sheave[i].in_contact", EachSheave, Boolean, |i, _| Output::SheaveInContact(i), "The cable touches the sheave"),
    output(143, "sheave[i].out_of_groove", EachGroove, Boolean, |i, _| Output::SheaveOutOfGroove(i), "The cable has climbed out of the groove"),
    output(144, "sheave[i].angle", EachTurning, Real(&u::ANGLE), |i, _| Output::SheaveAngle(i), "Angle by which the sheave has turned about its axis since the start, relative to the ship"),
    output(145, "sheave[i].rate", EachTurning, Real(&u::ANGULAR_VELOCITY), |i, _| Output::SheaveRate(i), "Angular velocity of the sheave relative to the ship"),
    output(150, "cable.tension_max", Always, Real(&u::FORCE), |_, _| Output::CableTensionMax, "Greatest axial force along the cable"),
    output(151, "cable.tension_min", Always, Real(&u::FORCE), |_, _| Output::CableTensionMin, "Least axial force along the cable"),
    output(152, "cable.slack", Always, Boolean, |_, _| Output::CableSlack, "Some part of the cable carries no tension"),
    output(153, "cable.point[i].{x,y,z}", EachPoint, Real(&u::POSITION), Output::CablePoint, "Point of the cable for drawing, equally spaced in arc length from the first end, inertial frame, {}"),
    output(160, "body.{x,y,z}", BODY, Real(&u::POSITION), |_, c| Output::BodyPosition(c), "Position of the body in the inertial frame, {}"),
    output(161, "body.{vx,vy,vz}", BODY, Real(&u::VELOCITY), |_, c| Output::BodyVelocity(c), "Velocity of the body in the inertial frame, {}"),
    output(162, "body.tension", BODY, Real(&u::FORCE), |_, _| Output::BodyTension, "Axial force of the cable at the body"),
    output(170, "load.{x,y,z}", LOAD, Real(&u::POSITION), |_, c| Output::LoadPosition(c), "Position of the load's centre of gravity in the inertial frame, {}"),
    output(171, "load.{vx,vy,vz}", LOAD, Real(&u::VELOCITY), |_, c| Output::LoadVelocity(c), "Velocity of the load's centre of gravity in the inertial frame, {}"),
    output(172, "load.tension", LOAD, Real(&u::FORCE), |_, _| Output::LoadTension, "Axial force of the cable at the load"),
    output(173, "load.angle", LOAD, Real(&u::ARC_ANGLE), |_, _| Output::LoadAngle, "Angle of the load's link from the vertical"),
    output(174, "far_end.force.{x,y,z}", FAR_END, Real(&u::FORCE), |_, c| Output::FarEndForce(c), "Force of the cable on what holds its far end, inertial frame, {}"),
    output(175, "far_end.tension", FAR_END, Real(&u::FORCE), |_, _| Output::FarEndTension, "Axial force of the cable at its far end"),
    output(176, "current.noise.{x,y,z}", If(|s| s.noise), Real(&u::VELOCITY), |_, c| Output::CurrentNoise(c), "Turbulence of the current in the inertial frame, part of what the water does, {}"),
    output(180, "status.code", Always, Integer, |_, _| Output::StatusCode, "0 fine, 1 degraded (results still usable, see status.message), 2 stopped (outputs keep the last good values)"),
    output(181, "status.message", Always, Text, |_, _| Output::StatusMessage, "Why the status code is not 0; empty when all is fine"),
    output(190, "solver.steps", Always, Integer, |_, _| Output::SolverSteps, "Accepted sub-steps since the start"),
    output(191, "solver.rejected", Always, Integer, |_, _| Output::SolverRejected, "Rejected sub-steps since the start"),
    output(192, "solver.iterations", Always, Integer, |_, _| Output::SolverIterations, "Linear solves since the start"),
    output(193, "solver.energy_error", Always, Real(&u::RATIO), |_, _| Output::SolverEnergyError, "Defect of the work and energy balance over the work done since the start"),
];

/// The variables of a scene of this shape with these numbers, in declaration order: parameters, inputs, outputs.
///
/// Numbers without a row in [`keys::KEYS`] are left out; a test makes sure that there are none.
pub fn variables(shape: &Shape, leaves: &[(String, Value)]) -> Vec<Variable> {
    let parameters = leaves.iter().enumerate().filter_map(|(index, (name, value))| parameter(index, name, value));
    let mut all: Vec<Variable> = parameters.collect();
    for family in FAMILIES {
        family.append(shape, leaves, &mut all);
    }
    all
}

fn parameter(index: usize, name: &str, value: &Value) -> Option<Variable> {
    let leaf = keys::leaf(name)?;
    let kind = match leaf.of {
        Of::Integer => Kind::Integer,
        _ => Kind::Real,
    };
    let declared = leaf.declared_type();
    Some(Variable {
        name: name.to_owned(),
        reference: leaf.reference,
        kind,
        causality: Causality::Parameter,
        variability: if leaf.tunable { Variability::Tunable } else { Variability::Fixed },
        start: Some(value.clone()),
        unit: declared.and_then(|t| t.unit),
        declared_type: declared.map(|t| t.name),
        description: leaf.description,
        quantity: Quantity::Parameter(index),
    })
}

impl Family {
    fn append(&self, shape: &Shape, leaves: &[(String, Value)], all: &mut Vec<Variable>) {
        let components = components(self.name);
        for part in self.occurs.parts(shape) {
            for (c, component) in components.iter().enumerate() {
                let (kind, declared) = match self.of {
                    Of::Real(t) => (Kind::Real, Some(t)),
                    Of::Integer => (Kind::Integer, None),
                    Of::Boolean => (Kind::Boolean, None),
                    Of::Text => (Kind::String, None),
                };
                let (causality, start, quantity) = match self.signal {
                    Signal::Input(make, start) => (Causality::Input, Some(start.value(leaves)), Quantity::Input(make(c))),
                    Signal::Output(make) => (Causality::Output, None, Quantity::Output(make(part, c))),
                };
                all.push(Variable {
                    name: expand(self.name, part + 1, component),
                    reference: reference(self.id, part * components.len() + c),
                    kind,
                    causality,
                    variability: if kind == Kind::Real { Variability::Continuous } else { Variability::Discrete },
                    start,
                    unit: declared.and_then(|t| t.unit),
                    declared_type: declared.map(|t| t.name),
                    description: self.description.replace("{}", component),
                    quantity,
                });
            }
        }
    }
}

impl Start {
    fn value(self, leaves: &[(String, Value)]) -> Value {
        match self {
            Self::Zero => Value::Real(0.0),
            Self::Parameter(name) => leaves.iter().find(|(n, _)| n == name).map_or(Value::Real(0.0), |(_, v)| v.clone()),
        }
    }
}
