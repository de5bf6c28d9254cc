//! Which quantity of the simulation each variable is, and the conversion to the user's frame and back.

use crate::outputs::{Outputs, SheaveOutputs};
use crate::scene::file::z_flipped;
use crate::sim::{Channel, Inputs};
use model_description::{Input, Output, Shape, Value};
use nalgebra::Vector3;

/// One output in the user's frame. What a scene does not have reads as zero.
pub(super) fn output(quantity: Output, o: &Outputs, ned: bool) -> Value {
    use Output::*;
    let of_frame = |v: &Vector3<f64>| if ned { z_flipped(*v) } else { *v };
    let component = |v: &Vector3<f64>, c: usize| Value::Real(of_frame(v).get(c).copied().unwrap_or_default());
    let count = |n: u64| Value::Integer(i32::try_from(n).unwrap_or(i32::MAX));
    let real = Value::Real;
    let none = SheaveOutputs::default();
    let sheave = |i: usize| o.sheaves.get(i).unwrap_or(&none);
    match quantity {
        ShipForce(c) => component(&o.ship.force, c),
        ShipMoment(c) => component(&o.ship.moment, c),
        ShipForceWorld(c) => component(&o.ship.force_world, c),
        WinchTension => real(o.winch.tension),
        WinchAngle => real(o.winch.angle),
        WinchRate => real(o.winch.rate),
        WinchTorque => real(o.winch.torque),
        WinchPayout => real(o.winch.payout),
        WinchTarget => real(o.winch.target),
        WinchTargetRate => real(o.winch.target_rate),
        WinchForce(c) => component(&o.winch.force, c),
        AnchorTension => real(o.anchor.tension),
        AnchorForce(c) => component(&o.anchor.force, c),
        SheaveForce(i, c) => component(&sheave(i).force, c),
        SheaveMoment(i, c) => component(&sheave(i).moment, c),
        SheaveNormalForce(i) => real(sheave(i).normal_force),
        SheaveFlankForce(i, flank) => real(sheave(i).flank_force.get(flank).copied().unwrap_or_default()),
        SheaveTensionIn(i) => real(sheave(i).tension_in),
        SheaveTensionOut(i) => real(sheave(i).tension_out),
        SheaveWrapAngle(i) => real(sheave(i).wrap_angle),
        SheaveContactBegin(i) => real(sheave(i).contact_begin),
        SheaveContactEnd(i) => real(sheave(i).contact_end),
        SheaveTurnAngle(i) => real(sheave(i).turn_angle),
        SheaveLineLoadMax(i) => real(sheave(i).line_load_max),
        SheaveLineLoadMin(i) => real(sheave(i).line_load_min),
        SheaveInContact(i) => Value::Boolean(sheave(i).in_contact),
        SheaveOutOfGroove(i) => Value::Boolean(sheave(i).out_of_groove),
        SheaveAngle(i) => real(sheave(i).angle),
        SheaveRate(i) => real(sheave(i).rate),
        CableTensionMax => real(o.cable.tension_max),
        CableTensionMin => real(o.cable.tension_min),
        CableSlack => Value::Boolean(o.cable.slack),
        CablePoint(k, c) => component(o.cable.points.get(k).unwrap_or(&Vector3::zeros()), c),
        BodyPosition(c) => component(&o.body.position, c),
        BodyVelocity(c) => component(&o.body.velocity, c),
        BodyTension => real(o.body.tension),
        LoadPosition(c) => component(&o.load.position, c),
        LoadVelocity(c) => component(&o.load.velocity, c),
        LoadTension => real(o.load.tension),
        LoadAngle => real(o.load.angle),
        FarEndForce(c) => component(&o.far_end.force, c),
        FarEndTension => real(o.far_end.tension),
        CurrentNoise(c) => component(&o.current_noise, c),
        StatusCode => Value::Integer(o.status.code),
        StatusMessage => Value::String(o.status.message.clone()),
        SolverSteps => count(o.solver.steps),
        SolverRejected => count(o.solver.rejected),
        SolverIterations => count(o.solver.iterations),
        SolverEnergyError => real(o.solver.energy_error),
    }
}

/// Inputs in z up. What the importer says of a derivative beats what another input says of it.
pub(super) fn inputs(shape: &Shape, value: &dyn Fn(Input) -> f64, derivative: &dyn Fn(Input, i32) -> Option<f64>) -> Inputs {
    // z down: y, z, pitch and yaw change sign; x and roll do not.
    let sign = |component: usize| if shape.ned && !component.is_multiple_of(3) { -1.0 } else { 1.0 };
    let plain = |present: bool, input: Input, component: usize| {
        let first = derivative(input, 1);
        let channel = Channel { value: value(input), first, second: first.and(derivative(input, 2)) };
        if present { scaled(channel, sign(component)) } else { Channel::default() }
    };
    Inputs {
        ship: std::array::from_fn(|c| {
            shape.ship_derivatives.map_or(Channel::default(), |n| scaled(ship(c, n, value, derivative), sign(c)))
        }),
        winch: if shape.external_setpoint { setpoint(value, derivative) } else { Channel::default() },
        current: std::array::from_fn(|c| plain(shape.fluid, Input::Current(c), c)),
        body_force: std::array::from_fn(|c| plain(shape.body_force, Input::BodyForce(c), c)),
    }
}

/// A pose component whose first `n` derivatives are inputs too.
fn ship(component: usize, n: usize, value: &dyn Fn(Input) -> f64, derivative: &dyn Fn(Input, i32) -> Option<f64>) -> Channel {
    let of = |order: usize| Input::Ship(component, order);
    let given = |order: usize| (order <= n).then(|| value(of(order)));
    let derived = |order: usize, times: i32| if order <= n { derivative(of(order), times) } else { None };
    let first = derived(0, 1).or_else(|| given(1));
    let second = derived(0, 2).or_else(|| derived(1, 1)).or_else(|| given(2));
    Channel { value: value(of(0)), first, second: first.and(second) }
}

/// The set-point; its rate is always an input.
fn setpoint(value: &dyn Fn(Input) -> f64, derivative: &dyn Fn(Input, i32) -> Option<f64>) -> Channel {
    Channel {
        value: value(Input::Setpoint),
        first: derivative(Input::Setpoint, 1).or_else(|| Some(value(Input::SetpointRate))),
        second: derivative(Input::Setpoint, 2).or_else(|| derivative(Input::SetpointRate, 1)),
    }
}

fn scaled(c: Channel, factor: f64) -> Channel {
    let scale = |x: f64| factor * x;
    Channel { value: scale(c.value), first: c.first.map(scale), second: c.second.map(scale) }
}
