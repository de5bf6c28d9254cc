use super::*;
use model_description::{Causality, Kind, Quantity, Variability};
use std::collections::HashSet;

fn flume() -> Model {
    Model::load(None).expect("the built-in scene is good")
}

fn model(text: &str) -> Result<Model, String> {
    Model::new(text.to_owned(), "test.toml", |file| Err(format!("no {file}")))
}

fn ned() -> Model {
    model(&SCENES[0].text.replace("frame = \"z_up\"", "frame = \"ned\"")).expect("good")
}

#[test]
fn exact_every_number_of_every_built_in_scene_is_a_parameter() {
    for scene in SCENES {
        let model = Model::built_in(scene).expect("good");
        assert_eq!(model.initial_scene.name, scene.name);
        let parameters: Vec<_> = model.variables.iter().filter(|v| v.causality == Causality::Parameter).collect();
        assert_eq!(parameters.len(), model.leaves.len(), "a leaf has no row in the table of keys");
        for (i, (parameter, leaf)) in parameters.iter().zip(&model.leaves).enumerate() {
            assert_eq!((&parameter.name, parameter.start.as_ref()), (&leaf.name, Some(&leaf.value)));
            assert_eq!(parameter.quantity, Quantity::Parameter(i));
        }
    }
}

#[test]
fn exact_variables_are_well_formed() {
    let model = flume();
    let (mut names, mut references) = (HashSet::new(), HashSet::new());
    for v in &model.variables {
        assert!(names.insert(&v.name), "{} twice", v.name);
        assert!(references.insert((v.kind, v.reference)), "{}: reference {} twice", v.name, v.reference);
        assert_eq!(v.start.is_some(), v.causality != Causality::Output, "{}", v.name);
        assert_eq!(v.declared_type.is_some(), v.kind == Kind::Real, "{}", v.name);
        assert!(v.kind == Kind::Real || v.variability != Variability::Continuous, "{}", v.name);
        assert!(!v.description.is_empty() && !v.description.ends_with('.'), "{}: {}", v.name, v.description);
    }
    for name in [
        "ship.x",
        "ship.roll_acceleration",
        "winch.setpoint_rate",
        "current.y",
        "winch.force.z",
        "ship.force_world.x",
        "cable.slack",
        "body.vz",
        "cable.point[25].z",
        "status.code",
        "solver.energy_error",
        "cable.EA",
        "winch.position[3]",
        "mesh.regions[2].elements",
        "fluid.current.profile[1,2]",
        "fluid.drag.amplification",
        "solver.steps_max",
        "solver.tries_max",
        "status.message",
        "winch.initial_angle",
    ] {
        assert!(names.contains(&name.to_owned()), "{name} is missing");
    }
    for name in ["outputs.points", "cable.E", "winch.max_rate", "anchor.tension", "body.force.x", "load.x", "time"] {
        assert!(!names.contains(&name.to_owned()), "{name} should not be there");
    }
}

#[test]
fn exact_references_do_not_depend_on_other_parts_of_the_scene() {
    let anchored = model(
        "name = \"a\"\n[cable]\nlength = 1\ndiameter = 1e-3\nmass_per_length = 1\nEA = 1\nEI = 0\n[mesh]\nelements = 2\n[anchor]\nposition = [0, 0, 0]\n",
    )
    .expect("good");
    let flume = flume();
    let of = |m: &Model, name: &str| m.variables.iter().find(|v| v.name == name).map(|v| v.reference);
    for name in ["cable.length", "cable.tension_max", "status.code", "solver.tolerance"] {
        assert_eq!(of(&anchored, name), of(&flume, name), "{name}");
        assert!(of(&flume, name).is_some(), "{name}");
    }
}

#[test]
fn exact_set_point_starts_where_the_drum_is() {
    let start = |m: &Model| m.variables.iter().find(|v| v.name == "winch.setpoint").and_then(|v| v.start.clone());
    assert_eq!(start(&flume()), Some(Value::Real(std::f64::consts::FRAC_PI_2)));
    let payout = model(&SCENES[0].text.replace("command = \"angle\"", "command = \"payout\"")).expect("good");
    assert_eq!(start(&payout), Some(Value::Real(0.0)));
}

#[test]
fn exact_a_built_in_set_point_is_an_output_and_no_input() {
    let of = |text: &str| {
        let model = model(text).expect("good");
        let signals = model.variables.iter().filter(|v| v.name.starts_with("winch.setpoint") || v.name.starts_with("winch.target"));
        signals.map(|v| (v.name.clone(), v.causality, v.unit)).collect::<Vec<_>>()
    };
    let external = of(SCENES[0].text);
    assert_eq!(external.len(), 2);
    assert!(external.iter().all(|(name, causality, _)| name.starts_with("winch.setpoint") && *causality == Causality::Input));
    for setpoint in ["simplified_sheave", "sheave", "waterline"] {
        let text = SCENES[0].text.replace("setpoint = \"external\"", &format!("setpoint = \"{setpoint}\""));
        let signals = |units: [&'static str; 2]| {
            ["winch.target", "winch.target_rate"]
                .into_iter()
                .zip(units)
                .map(|(n, u)| (n.to_owned(), Causality::Output, Some(u)))
                .collect::<Vec<_>>()
        };
        assert_eq!(of(&text), signals(["rad", "rad/s"]));
        assert_eq!(of(&text.replace("command = \"angle\"", "command = \"payout\"")), signals(["m", "m/s"]));
    }
}

#[test]
fn exact_changed_parameters_reach_the_scene_or_are_named() {
    let model = flume();
    let index = |name: &str| model.leaves.iter().position(|l| l.name == name).expect("there");
    let scene =
        model.scene(&[(index("winch.gain_rate"), Value::Real(7.0)), (index("mesh.regions[1].elements"), Value::Integer(3))]).expect("good");
    assert_eq!((scene.winch.map(|w| w.gain_rate), scene.elements.len()), (Some(7.0), 15));
    let error = model.scene(&[(index("cable.diameter"), Value::Real(-1.0)), (index("body.mass"), Value::Real(f64::NAN))]).unwrap_err();
    assert_eq!(
        error,
        "flume: body.mass: found nan; expected a number > 0 in kg\nflume: cable.diameter: found -1.0; expected a number > 0 in m"
    );
    let error = model.scene(&[(index("cable.length"), Value::Real(2.0))]).unwrap_err();
    assert!(error.contains("mesh.regions: the lengths sum to"), "{error}");
    let error = model.scene(&[(index("cable.length"), Value::Integer(2))]).unwrap_err();
    assert!(error.contains("cable.length: found Integer(2)"), "{error}");
}

#[test]
fn exact_ned_converts_at_the_border_only() {
    let (up, down) = (flume(), ned());
    let outputs =
        Outputs { body: crate::outputs::BodyOutputs { position: [1.0, 2.0, 3.0].into(), ..Default::default() }, ..Default::default() };
    let position = |m: &Model| [0, 1, 2].map(|c| m.output(Output::BodyPosition(c), &outputs));
    assert_eq!(position(&up), [1.0, 2.0, 3.0].map(Value::Real));
    assert_eq!(position(&down), [1.0, -2.0, -3.0].map(Value::Real));
    let value = |input: Input| match input {
        Input::Ship(c, order) => (10 * order + c + 1) as f64,
        _ => 5.0,
    };
    let inputs = down.inputs(&value, &|_, _| None);
    assert_eq!(inputs.ship.map(|c| c.value), [1.0, -2.0, -3.0, 4.0, -5.0, -6.0]);
    assert_eq!(inputs.ship[4], crate::sim::Channel { value: -5.0, first: Some(-15.0), second: Some(-25.0) });
    assert_eq!((inputs.current[0].value, inputs.current[1].value), (5.0, -5.0));
    // The scene's own vectors are turned too.
    let (up, down) = (up.initial_scene, down.initial_scene);
    let z = |s: &Scene| (s.winch.as_ref().map(|w| w.position.z), s.fluid.as_ref().map(|f| f.waterline));
    assert_eq!((z(&up), z(&down)), ((Some(-0.01735), Some(-0.46)), (Some(0.01735), Some(0.46))));
    let heights: Vec<_> = down.fluid.iter().flat_map(|f| f.current.iter().map(|row| row[0])).collect();
    assert!(heights.is_sorted(), "{heights:?}");
}

#[test]
fn exact_input_derivatives_beat_velocity_inputs() {
    let model = flume();
    let derivative = |input: Input, order: i32| match (input, order) {
        (Input::Ship(0, 0), 1) => Some(7.0),
        (Input::Ship(1, 1), 1) => Some(8.0),
        (Input::Current(0), 1) => Some(9.0),
        _ => None,
    };
    let inputs = model.inputs(&|_| 1.0, &derivative);
    assert_eq!((inputs.ship[0].first, inputs.ship[0].second), (Some(7.0), Some(1.0)));
    assert_eq!((inputs.ship[1].first, inputs.ship[1].second), (Some(1.0), Some(8.0)));
    assert_eq!((inputs.current[0].first, inputs.current[1].first), (Some(9.0), None));
    assert_eq!((inputs.winch.first, inputs.winch.second), (Some(1.0), None));
}

#[test]
fn exact_guid_follows_the_scene() {
    let guid = |text: &str| model(text).expect("good").guid;
    assert_eq!(guid(SCENES[0].text), flume().guid);
    assert_ne!(guid(SCENES[0].text), guid(&SCENES[0].text.replace("gravity = 9.81", "gravity = 9.82")));
}

#[test]
fn exact_missing_files_are_named() {
    let error = Model::load(Some(Path::new("no/such/folder"))).unwrap_err();
    assert!(error.contains("scene.toml: cannot be read"), "{error}");
}
