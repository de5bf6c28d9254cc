//! Rules of a scene file that involve several keys. They run on trees that have other faults too, and skip what is not there.

use super::problem::Problems;
use super::schema::{get, instances};
use model_description::keys::{Form, KEYS};
use std::path::{Component, Path};
use toml::{Table, Value};

/// How well the regions' lengths must sum to the cable's length.
const LENGTH_TOLERANCE: f64 = 1e-9;

/// Finds inconsistencies in a normalized tree.
pub(super) fn check(tree: &Table, problems: &mut Problems) {
    parts(tree, problems);
    stiffness(tree, problems);
    mesh(tree, problems);
    directions(tree, problems);
    ascending_tables(tree, problems);
    viscosity(tree, problems);
    noise(tree, problems);
    setpoint(tree, problems);
    turning_sheaves(tree, problems);
    initial(tree, problems);
    if let (Some(least), Some(greatest)) = (real(tree, "solver.step_min"), real(tree, "solver.step_max"))
        && least > greatest
    {
        problems.add_once("solver.step_min", format!("found {least}; expected at most solver.step_max = {greatest} s"));
    }
    if let (Some(tries), Some(method)) = (get(tree, "solver.tries_max").and_then(Value::as_integer), string(tree, "solver.method"))
        && tries > 0
        && method != "rodas4"
    {
        let message =
            format!("found {tries} with the method \"{method}\"; expected 0, or the method rodas4, whose work is known beforehand");
        problems.add_once("solver.tries_max", message);
    }
    if let (Some(gravity), Some(inertia)) = (real(tree, "load.length_gravity"), real(tree, "load.length_inertia"))
        && gravity > inertia
    {
        let message = format!("found {inertia}; a radius of gyration about the attachment is at least load.length_gravity = {gravity} m");
        problems.add_once("load.length_inertia", message);
    }
}

fn real(tree: &Table, name: &str) -> Option<f64> {
    get(tree, name)?.as_float()
}

fn string<'a>(tree: &'a Table, name: &str) -> Option<&'a str> {
    get(tree, name)?.as_str()
}

fn has(tree: &Table, name: &str) -> bool {
    get(tree, name).is_some()
}

fn parts(tree: &Table, problems: &mut Problems) {
    match (has(tree, "winch"), has(tree, "anchor")) {
        (true, true) => problems.add("anchor", "found beside [winch]; expected exactly one of [winch] and [anchor]"),
        (false, false) => problems.add("winch", "missing; expected exactly one of [winch] and [anchor], which hold the cable's first end"),
        _ => {}
    }
    let ends: Vec<_> = ["body", "load", "far_end"].into_iter().filter(|name| has(tree, name)).collect();
    if let [first, others @ ..] = ends.as_slice() {
        for other in others {
            problems.add(
                *other,
                format!("found beside [{first}]; expected at most one of [body], [load] and [far_end] at the cable's far end"),
            );
        }
    }
}

fn stiffness(tree: &Table, problems: &mut Problems) {
    if !has(tree, "cable") {
        return;
    }
    for (own, alternative, unit) in [("cable.EA", "cable.E", "a number > 0 in N"), ("cable.EI", "cable.I", "a number >= 0 in N.m2")] {
        match (has(tree, own), has(tree, alternative)) {
            (true, true) => problems.add_once(own, format!("found beside {alternative}; expected one of the two")),
            (false, false) => problems.add(own, format!("missing; expected {unit}, or {alternative} instead")),
            _ => {}
        }
    }
}

fn mesh(tree: &Table, problems: &mut Problems) {
    let given: Vec<&str> = ["mesh.elements", "mesh.regions", "mesh.error"].into_iter().filter(|key| has(tree, key)).collect();
    if given.is_empty() && has(tree, "mesh") {
        problems.add("mesh.elements", "missing; expected a whole number >= 1, or mesh.regions or mesh.error instead");
    }
    for key in given.iter().skip(1) {
        problems.add(*key, format!("found beside {}; expected one of the two", given[0]));
    }
    let Some(regions) = get(tree, "mesh.regions") else { return };
    let lengths = regions.as_array().map(|a| a.iter().map(|r| r.get("length").and_then(Value::as_float)));
    let sum: Option<f64> = lengths.and_then(Iterator::sum);
    if let (Some(sum), Some(length)) = (sum, real(tree, "cable.length"))
        && (sum - length).abs() > LENGTH_TOLERANCE * length
    {
        problems.add_once("mesh.regions", format!("the lengths sum to {sum}; expected cable.length = {length} m"));
    }
}

/// The values of all keys, with their dotted names.
fn values(tree: &Table) -> impl Iterator<Item = (Form, String, &Value)> {
    KEYS.iter().flat_map(move |key| {
        instances(tree, key.group()).into_iter().filter_map(|(path, table)| {
            let name = key.local_name();
            Some((key.form, super::schema::join(&path, name), get(table, name)?))
        })
    })
}

fn directions(tree: &Table, problems: &mut Problems) {
    for (form, name, value) in values(tree) {
        let zero = value.as_array().is_some_and(|a| a.iter().all(|v| v.as_float() == Some(0.0)));
        if matches!(form, Form::Vector(t) if t.name == "Direction") && zero {
            problems.add_once(&name, "found a zero vector; expected a direction [x, y, z] of any other length");
        }
    }
}

fn ascending_tables(tree: &Table, problems: &mut Problems) {
    for (form, name, value) in values(tree) {
        let first = value.as_array().and_then(|rows| rows.iter().map(|row| row.get(0)?.as_float()).collect::<Option<Vec<_>>>());
        let (Some(first), Form::Coefficient | Form::Rows(_)) = (first, form) else { continue };
        let ascends = first.windows(2).all(|w| w[0] < w[1]);
        // A profile may be written from the surface down as well.
        let descends = matches!(form, Form::Rows(_)) && first.windows(2).all(|w| w[0] > w[1]);
        if !ascends && !descends {
            let order = if matches!(form, Form::Rows(_)) { "ascend or descend" } else { "ascend" };
            problems.add_once(&name, format!("the first column is {first:?}; expected it to {order} strictly"));
        }
    }
}

fn viscosity(tree: &Table, problems: &mut Problems) {
    if !has(tree, "fluid") || has(tree, "fluid.viscosity") {
        return;
    }
    let of_reynolds =
        |(form, name, value): (Form, String, &Value)| (matches!(form, Form::Coefficient) && !value.is_float()).then_some(name);
    if let Some(name) = values(tree).find_map(of_reynolds) {
        problems.add("fluid.viscosity", format!("missing; {name} depends on the Reynolds number, so a number > 0 in Pa.s is expected"));
    }
}

/// Greatest number of samples in a cut-off period: keeps the filter's response to some ten thousand samples.
const OVERSAMPLING: f64 = 1e3;

fn noise(tree: &Table, problems: &mut Problems) {
    let deviations = get(tree, "fluid.current.noise.std_dev").and_then(Value::as_array);
    if let Some(x) = deviations.and_then(|a| a.iter().filter_map(Value::as_float).find(|x| *x < 0.0)) {
        problems.add_once("fluid.current.noise.std_dev", format!("found {x}; expected three numbers >= 0 in m/s"));
    }
    if let (Some(rate), Some(cutoff)) = (real(tree, "fluid.current.noise.sample_rate"), real(tree, "fluid.current.noise.cutoff")) {
        let (low, high) = (rate / OVERSAMPLING, 0.5 * rate);
        if !(low..high).contains(&cutoff) {
            let message = format!(
                "found {cutoff}; expected at least {low} and less than {high} Hz, a thousandth and half of fluid.current.noise.sample_rate"
            );
            problems.add_once("fluid.current.noise.cutoff", message);
        }
    }
}

/// Nothing but friction turns a sheave.
fn turning_sheaves(tree: &Table, problems: &mut Problems) {
    let Some(Value::Array(sheaves)) = tree.get("sheave") else { return };
    for (i, sheave) in sheaves.iter().enumerate() {
        let number = |key: &str| sheave.get(key).and_then(Value::as_float);
        if number("inertia").is_some() && number("friction").is_none_or(|f| f <= 0.0) {
            problems.add_once(
                &format!("sheave[{}].inertia", i + 1),
                "given without friction; expected sheave.friction above 0, since nothing else lets the cable turn the sheave",
            );
        }
    }
}

fn setpoint(tree: &Table, problems: &mut Problems) {
    let Some(source) = string(tree, "winch.setpoint") else { return };
    let needs: &[&str] = match source {
        "simplified_sheave" | "sheave" => &["ship"],
        "waterline" => &["ship", "fluid"],
        _ => &[],
    };
    for table in needs.iter().filter(|t| !has(tree, t)) {
        problems.add_once("winch.setpoint", format!("found \"{source}\", which needs a table [{table}]; expected one, or \"external\""));
    }
}

fn initial(tree: &Table, problems: &mut Problems) {
    if string(tree, "initial.state") == Some("released") && !has(tree, "body") && !has(tree, "load") {
        problems.add_once("initial.state", "found \"released\", which needs a [body] or a [load] to be released");
    }
    if string(tree, "initial.state") == Some("released") {
        // The released force T u with T = −m g u·k holds a rope taut only where u points down and things have weight.
        let z = get(tree, "initial.direction").and_then(|d| d.get(2)?.as_float());
        let (sign, wanted) = if string(tree, "ship.frame") == Some("ned") { (1.0, "> 0, z down") } else { (-1.0, "< 0, z up") };
        if let Some(z) = z.filter(|z| z * sign <= 0.0) {
            let message = format!("found {z} for its third number; a rope that hangs taut before it is released points down ({wanted})");
            problems.add_once("initial.direction", message);
        }
        if real(tree, "gravity") == Some(0.0) {
            problems.add_once("initial.state", "found \"released\" with gravity = 0; without weight nothing holds the rope taut");
        }
    }
    if let Some(file) = string(tree, "initial.file") {
        let inside = Path::new(file).components().all(|c| matches!(c, Component::Normal(_)));
        if file.is_empty() || !inside || file.contains(['\\', ':']) || file == "scene.toml" {
            let message =
                format!("found \"{file}\"; expected a file beside or below the scene file, as a relative path with forward slashes");
            problems.add_once("initial.file", message);
        }
    }
}
