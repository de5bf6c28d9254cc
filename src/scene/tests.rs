use super::file::SceneFile;
use super::*;
use model_description::keys::{Form, KEYS};
use nalgebra::Vector3;

/// The smallest scene.
const ANCHORED: &str = r#"
name = "small"
[cable]
length = 10
diameter = 0.01
mass_per_length = 0.1
EA = 1e5
EI = 0.5
[mesh]
elements = 4
[anchor]
position = [0, 0, 0]
"#;

/// Every table and nearly every key.
const FULL: &str = r#"
name = "full"
description = "all"
[cable]
length = 10
diameter = 0.01
mass_per_length = 0.1
E = 1e9
I = 1e-10
compression = "linear"
strain = "green"
damping = { model = "gradient_rate", coefficient = 0.1 }
[mesh]
regions = [{ length = 4, elements = 3 }, { length = 6, elements = 2 }]
[fluid]
density = 1025
viscosity = 1e-3
waterline = 1
drag = { law = "cross_flow", cd_normal = [[1, 10], [1000, 1.0]], cd_tangential = 0.01, amplification = 1.5 }
added_mass = 1
current = { profile = [[0, 1, 2], [-5, 3, 4]], noise = { std_dev = [0.1, 0.2, 0], seed = 3, cutoff = 5 } }
[ship]
input = "pose"
frame = "ned"
[winch]
position = [1, 2, 3]
axis = [0, 2, 0]
radius = 0.3
gain_position = 1
gain_rate = 2
max_rate = 3
stiffness = 1e6
command = "payout"
end = "tangent"
direction = 1
setpoint = "waterline"
[[sheave]]
position = [0, 0, 1]
axis = [0, 1, 0]
radius = 0.2
side = "under"
groove_angle = 0.8
stiffness = 1e6
[body]
mass = 1
volume = 1e-3
drag_area = 0.01
drag_coefficient = "sphere"
force_input = true
[initial]
state = "shape"
file = "shapes/a.csv"
[outputs]
points = 2
"#;

const CSV: &str = "# a comment\ns, x, y, z, vx, vy, vz\n0,0,0,0,1,2,3\n10,0,0,10,0,0,0\n";

fn problems(text: &str) -> Vec<String> {
    match SceneFile::parse(text, "s.toml").and_then(|f| f.check(Some(CSV))) {
        Ok(_) => vec![],
        Err(e) => e.to_string().lines().map(str::to_owned).collect(),
    }
}

#[test]
fn exact_full_scene_is_read() {
    let scene = SceneFile::parse(FULL, "s.toml").and_then(|f| f.check(Some(CSV))).expect("good");
    let area = std::f64::consts::PI * 0.01 * 0.01 / 4.0;
    assert!((scene.cable.ea / (1e9 * area) - 1.0).abs() < 1e-15, "{}", scene.cable.ea);
    assert_eq!((scene.cable.ei, scene.cable.compression, scene.cable.strain), (0.1, Compression::Linear, Strain::Green));
    assert_eq!(scene.cable.damping, Damping::GradientRate { coefficient: 0.1 });
    assert_eq!(scene.elements, [4.0 / 3.0, 4.0 / 3.0, 4.0 / 3.0, 3.0, 3.0]);
    let fluid = scene.fluid.expect("there");
    // NED in the file: z, y and what points along them change sign, and the profile is sorted upwards.
    assert_eq!((fluid.waterline, fluid.current), (-1.0, vec![[-0.0, 1.0, -2.0], [5.0, 3.0, -4.0]]));
    let drag = Drag::CrossFlow { normal: Coefficient::Table(vec![[1.0, 10.0], [1000.0, 1.0]]), tangential: 0.01, amplification: 1.5 };
    assert_eq!(fluid.drag, drag);
    let noise = Noise { std_dev: [0.1, 0.2, 0.0], seed: 3, sample_rate: 100.0, order: 8, cutoff: 5.0, attenuation: 80.0, ramp: 2.0 };
    assert_eq!(fluid.noise, Some(noise));
    assert_eq!(scene.ship, Some(Ship { derivatives: 0, ned: true }));
    let winch = scene.winch.expect("there");
    assert_eq!((winch.position, winch.axis), (Vector3::new(1.0, -2.0, -3.0), Vector3::new(0.0, -1.0, 0.0)));
    assert_eq!((winch.max_rate, winch.max_acceleration, winch.angle), (3.0, f64::INFINITY, 0.0));
    assert_eq!(winch.contact, Some(Contact { stiffness: 1e6, damping: 0.0, exponent: 1.5 }));
    assert!(winch.payout_command && winch.tangent_end && winch.direction == 1.0 && winch.setpoint == Setpoint::Waterline);
    let sheave = &scene.sheaves[0];
    assert_eq!(
        (sheave.name.as_str(), sheave.over, sheave.groove_angle, sheave.groove_depth),
        ("sheave[1]", false, Some(0.8), f64::INFINITY)
    );
    let body = scene.body.expect("there");
    assert_eq!((body.drag_coefficient, body.added_mass, body.force_input), (Coefficient::Sphere, 0.5, true));
    let Initial::Shape(points) = scene.initial else { panic!("a shape") };
    assert_eq!((points[0].velocity, points[1].position), (Vector3::new(1.0, -2.0, -3.0), Vector3::new(0.0, 0.0, -10.0)));
    assert_eq!(points[0].tangent, None);
    assert_eq!((scene.points, scene.solver.steps_max, scene.gravity), (2, 100_000, 9.81));
}

#[test]
fn exact_defaults_of_the_smallest_scene() {
    let scene = SceneFile::parse(ANCHORED, "s.toml").and_then(|f| f.check(None)).expect("good");
    assert_eq!(scene.elements, [2.5; 4]);
    assert_eq!((scene.cable.compression, scene.cable.strain), (Compression::None, Strain::Engineering));
    assert_eq!(scene.cable.damping, Damping::KelvinVoigt { axial: 0.0, bending: 0.0, in_slack: true });
    assert_eq!((scene.anchor, scene.initial, scene.points), (Some(Vector3::zeros()), Initial::Equilibrium, 0));
    let solver = Solver { method: Method::Rodas4, tolerance: 1e-3, step_max: 0.1, step_min: 1e-9, steps_max: 100_000, tries_max: 0 };
    assert_eq!(scene.solver, solver);
}

#[test]
fn exact_every_leaf_can_be_changed_and_has_a_row() {
    for text in [ANCHORED, FULL] {
        let file = SceneFile::parse(text, "s.toml").expect("good");
        let leaves = file.leaves();
        for (i, leaf) in leaves.iter().enumerate() {
            assert!(model_description::keys::leaf(&leaf.name).is_some(), "{} has no row", leaf.name);
            assert_eq!(file.with(&[(i, leaf.value.clone())]).as_ref(), Ok(&file), "{}", leaf.name);
        }
        assert!(leaves.iter().all(|l| l.name != "outputs.points"));
    }
    let names: Vec<_> = SceneFile::parse(FULL, "s.toml").expect("good").leaves().into_iter().map(|l| l.name).collect();
    for name in [
        "gravity",
        "cable.I",
        "mesh.regions[2].length",
        "fluid.drag.cd_normal[2,1]",
        "winch.axis[2]",
        "sheave[1].groove_angle",
        "sheave[1].position[3]",
        "fluid.current.profile[2,3]",
        "winch.direction",
        "solver.step_min",
        "body.added_mass",
    ] {
        assert!(names.iter().any(|n| n == name), "{name} is no parameter");
    }
}

#[test]
fn exact_problems_name_key_value_and_expectation() {
    let cases: &[(&str, &str, &str)] = &[
        ("[mesh]", "[mess]", "s.toml: mess: unknown key; did you mean mesh?"),
        ("diameter", "diametre", "s.toml: cable.diametre: unknown key; did you mean cable.diameter?"),
        ("name = \"small\"", "name = \"small\"\nEA = 3", "s.toml: EA: unknown key; did you mean cable.EA?"),
        ("length = 10", "length = \"ten\"", "s.toml: cable.length: found \"ten\"; expected a number > 0 in m"),
        ("length = 10", "", "s.toml: cable.length: missing; expected a number > 0 in m"),
        ("EA = 1e5", "EA = -1e5", "s.toml: cable.EA: found -100000.0; expected a number > 0 in N"),
        ("EA = 1e5", "EA = nan", "s.toml: cable.EA: found nan; expected a number > 0 in N"),
        ("EA = 1e5", "EA = inf", "s.toml: cable.EA: found inf; expected a number > 0 in N"),
        ("EA = 1e5", "", "s.toml: cable.EA: missing; expected a number > 0 in N, or cable.E instead"),
        ("EA = 1e5", "EA = 1e5\nE = 1", "s.toml: cable.EA: found beside cable.E; expected one of the two"),
        ("EA = 1e5", "EA = 1e5\nI = 1", "s.toml: cable.I: only allowed together with cable.E"),
        (
            "[anchor]\nposition = [0, 0, 0]",
            "",
            "s.toml: winch: missing; expected exactly one of [winch] and [anchor], which hold the cable's first end",
        ),
        (
            "position = [0, 0, 0]",
            "position = [0, 0]",
            "s.toml: anchor.position: found [0, 0]; expected three finite numbers [x, y, z] in m",
        ),
        ("elements = 4", "elements = 4.0", "s.toml: mesh.elements: found 4.0; expected a whole number from 1 to 100000"),
        ("elements = 4", "elements = 0", "s.toml: mesh.elements: found 0; expected a whole number from 1 to 100000"),
        ("elements = 4", "", "s.toml: mesh.elements: missing; expected a whole number >= 1, or mesh.regions or mesh.error instead"),
        (
            "elements = 4",
            "regions = [{ length = 4, elements = 1 }]",
            "s.toml: mesh.regions: the lengths sum to 4; expected cable.length = 10 m",
        ),
        (
            "elements = 4",
            "regions = [{ length = 10 }]",
            "s.toml: mesh.regions[1].elements: missing; expected a whole number from 1 to 100000",
        ),
        ("elements = 4", "elements = 4\nerror = 1e-2", "s.toml: mesh.error: found beside mesh.elements; expected one of the two"),
        ("elements = 4", "error = 2", "s.toml: mesh.error: found 2.0; expected a number between 0 and 1, both excluded"),
        ("elements = 4", "regions = 3", "s.toml: mesh.regions: found 3; expected an array of tables [[mesh.regions]]"),
        (
            "name = \"small\"",
            "name = \"7 seas\"",
            "s.toml: name: found \"7 seas\"; expected a C identifier (letters, digits and _, no digit first, at most 63)",
        ),
        (
            "[mesh]",
            "compression = \"non\"\n[mesh]",
            "s.toml: cable.compression: found \"non\"; did you mean \"none\"?; expected \"none\" or \"linear\"",
        ),
        ("[mesh]", "damping = 3\n[mesh]", "s.toml: cable.damping: found 3; expected a table [cable.damping]"),
        (
            "[mesh]",
            "damping.coefficient = 3\n[mesh]",
            "s.toml: cable.damping.coefficient: only allowed with cable.damping.model = \"gradient_rate\"",
        ),
        (
            "[mesh]",
            "[body]\nmass = 1\n[load]\nmass = 1\nlength_inertia = 1\nlength_gravity = 1\n[mesh]",
            "s.toml: load: found beside [body]; expected at most one of [body], [load] and [far_end] at the cable's far end",
        ),
        (
            "[mesh]",
            "[load]\nmass = 1\nlength_inertia = 1\nlength_gravity = 2\n[mesh]",
            "s.toml: load.length_inertia: found 1; a radius of gyration about the attachment is at least load.length_gravity = 2 m",
        ),
        (
            "[mesh]",
            "[initial]\nstate = \"straight\"\ndirection = [0, 0, 0]\n[mesh]",
            "s.toml: initial.direction: found a zero vector; expected a direction [x, y, z] of any other length",
        ),
        (
            "[mesh]",
            "[initial]\nstate = \"released\"\ndirection = [1, 0, -1]\n[mesh]",
            "s.toml: initial.state: found \"released\", which needs a [body] or a [load] to be released",
        ),
        (
            "[mesh]",
            "[load]\nmass = 1\nlength_inertia = 2\nlength_gravity = 1\n[initial]\nstate = \"released\"\ndirection = [1, 0, 0]\n[mesh]",
            "s.toml: initial.direction: found 0 for its third number; a rope that hangs taut before it is released points down (< 0, z up)",
        ),
        (
            "[mesh]",
            "[initial]\nstate = \"shape\"\nfile = \"../a.csv\"\n[mesh]",
            "s.toml: initial.file: found \"../a.csv\"; expected a file beside or below the scene file, as a relative path with forward slashes",
        ),
        (
            "[mesh]",
            "[solver]\nstep_max = 1e-10\n[mesh]",
            "s.toml: solver.step_min: found 0.000000001; expected at most solver.step_max = 0.0000000001 s",
        ),
        (
            "[mesh]",
            "[fluid]\ndensity = 1\nwaterline = 0\ndrag.law = \"loading_functions\"\ndrag.cd = \"cylinder\"\n[mesh]",
            "s.toml: fluid.viscosity: missing; fluid.drag.cd depends on the Reynolds number, so a number > 0 in Pa.s is expected",
        ),
        (
            "[mesh]",
            "[fluid]\ndensity = 1\nviscosity = 1\nwaterline = 0\ndrag.law = \"loading_functions\"\ndrag.cd = [[2, 1], [1, 1]]\n[mesh]",
            "s.toml: fluid.drag.cd: the first column is [2.0, 1.0]; expected it to ascend strictly",
        ),
        (
            "[mesh]",
            "[fluid]\ndensity = 1\nwaterline = 0\ndrag.law = \"cross_flow\"\ndrag.cd_normal = 1\ndrag.cd_tangential = 0\ncurrent.noise.std_dev = [0, -1, 0]\n[mesh]",
            "s.toml: fluid.current.noise.std_dev: found -1; expected three numbers >= 0 in m/s",
        ),
        (
            "[mesh]",
            "[fluid]\ndensity = 1\nwaterline = 0\ndrag.law = \"cross_flow\"\ndrag.cd_normal = 1\ndrag.cd_tangential = 0\ncurrent.noise = { std_dev = [0, 1, 0], cutoff = 50 }\n[mesh]",
            "s.toml: fluid.current.noise.cutoff: found 50; expected at least 0.1 and less than 50 Hz, a thousandth and half of fluid.current.noise.sample_rate",
        ),
        (
            "[mesh]",
            "[fluid]\ndensity = 1\nwaterline = 0\ndrag.law = \"loading_functions\"\n[mesh]",
            "s.toml: fluid.drag.cd: missing; expected a number >= 0, a table [[Re, C], ...] with Re > 0 and C >= 0, or \"cylinder\" or \"sphere\"",
        ),
        (
            "[mesh]",
            "[fluid]\ndensity = 1\nwaterline = 0\ndrag.law = \"loading_functions\"\ndrag.cd = 1\n[body]\nmass = 1\nvolume = 1\ndrag_coefficient = 1\n[mesh]",
            "s.toml: body.drag_area: missing; a scene with [fluid] needs a number >= 0 in m2",
        ),
        (
            "[mesh]",
            "[[sheave]]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = -1\nstiffness = 1\n[mesh]",
            "s.toml: sheave[1].radius: found -1.0; expected a number > 0 in m",
        ),
        (
            "[mesh]",
            "[[sheave]]\nname = \"stern\"\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1\nstiffness = 1\ngroove_angle = 0.8\ngroove_depth = 0.001\n[mesh]",
            "s.toml: sheave[1].groove_depth: the groove of sheave \"stern\" opens to 8.4559e-4 m at its depth of 0.001 m and angle of 0.8 rad, narrower than the cable; expected at least cable.diameter = 0.01 m",
        ),
        (
            "[mesh]",
            "[[sheave]]\nname = \"a\"\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1\nstiffness = 1\n[[sheave]]\nname = \"b\"\nposition = [0.5, 0, 0]\naxis = [0, -2, 0]\nradius = 0.2\nstiffness = 1\n[mesh]",
            "s.toml: sheave[2].position: \"b\" (radius 0.2 m) and \"a\" (radius 1 m) lie inside each other: their axes are 0.5000 m apart; expected at least 1.2000 m",
        ),
        (
            "[mesh]",
            "[[sheave]]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1\nstiffness = 1\ninertia = 0.1\n[mesh]",
            "s.toml: sheave[1].inertia: given without friction; expected sheave.friction above 0, since nothing else lets the cable turn the sheave",
        ),
        (
            "[mesh]",
            "[[sheave]]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1\nstiffness = 1\nfriction = 0.1\ninertia = 0.1\nbearing_friction = -1\n[mesh]",
            "s.toml: sheave[1].bearing_friction: found -1.0; expected a number >= 0 in N.m",
        ),
        (
            "[mesh]",
            "[[sheave]]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1\nstiffness = 1\nbearing_damping = 1\n[mesh]",
            "s.toml: sheave[1].bearing_damping: only allowed together with sheave[1].inertia",
        ),
        ("[mesh]", "[ship]\ninput = \"pose\"\n[mesh]\nelemnts = 2", "s.toml: mesh.elemnts: unknown key; did you mean mesh.elements?"),
    ];
    for (old, new, expected) in cases {
        assert!(ANCHORED.contains(old), "{old}");
        assert_eq!(problems(&ANCHORED.replacen(old, new, 1)).first().map(String::as_str), Some(*expected), "for {new}");
    }
}

#[test]
fn exact_built_in_set_points_need_a_ship_and_the_waterline_water() {
    let winch = "[winch]\nposition = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1\ngain_position = 1\ngain_rate = 1\nsetpoint = \"sheave\"\n";
    let scene = ANCHORED.replace("[anchor]\nposition = [0, 0, 0]\n", winch);
    assert_eq!(problems(&scene), ["s.toml: winch.setpoint: found \"sheave\", which needs a table [ship]; expected one, or \"external\""]);
    let sailing = scene.replace("[mesh]", "[ship]\ninput = \"pose\"\n[mesh]");
    assert_eq!(problems(&sailing), Vec::<String>::new());
    let dry = problems(&sailing.replace("\"sheave\"", "\"waterline\""));
    assert_eq!(dry, ["s.toml: winch.setpoint: found \"waterline\", which needs a table [fluid]; expected one, or \"external\""]);
}

#[test]
fn exact_all_problems_are_reported_at_once() {
    let text =
        ANCHORED.replace("diameter = 0.01", "diameter = -0.01\ncolour = \"red\"").replace("elements = 4", "") + "[winch]\nradius = 0\n";
    let found = problems(&text);
    for key in
        ["cable.diameter", "cable.colour", "mesh.elements", "anchor", "winch.radius", "winch.position", "winch.axis", "winch.gain_rate"]
    {
        assert!(found.iter().any(|p| p.starts_with(&format!("s.toml: {key}: "))), "{key} not in {found:#?}");
    }
}

#[test]
fn exact_syntax_errors_have_a_line() {
    assert!(problems("name = \"a\"\nlength = = 3\n")[0].starts_with("s.toml: line 2: not TOML: "));
    assert!(problems("PK\u{3}\u{4}")[0].starts_with("s.toml: line 1: not TOML: "));
    assert!(problems("name = \"a\"\nname = \"b\"\n")[0].starts_with("s.toml: line 2: not TOML: "));
}

#[test]
fn exact_start_shapes_are_checked_line_by_line() {
    let file = SceneFile::parse(FULL, "s.toml").expect("good");
    let cases = [
        ("", "1: the file is empty; expected a header s,x,y,z"),
        ("s,x,y\n0,0,0\n", "1: column z is missing; expected s,x,y,z and optionally tx,ty,tz and vx,vy,vz"),
        ("s,x,y,z,tx\n", "1: column ty is missing; expected s,x,y,z and optionally tx,ty,tz and vx,vy,vz"),
        ("s,x,y,z,x\n", "1: column x stands there twice"),
        ("s,x,y,z,q\n", "1: unknown column \"q\"; expected s,x,y,z and optionally tx,ty,tz and vx,vy,vz"),
        ("s,x,y,z\n0,0,0\n10,0,0,0\n", "2: found 3 values; expected 4, one for each column of the header"),
        ("s,x,y,z\n0,0,0,0\n5,nan,0,0\n10,0,0,0", "3: found \"nan\" in column x; expected a finite number"),
        ("s,x,y,z\n0,0,0,0\n0,0,0,0\n10,0,0,0", "3: found s = 0; expected the arc length to ascend strictly"),
        ("s,x,y,z\n0,0,0,0\n5,0,0,0\n", "1: s runs from 0 to 5; expected from 0 to cable.length = 10 m"),
        ("s,x,y,z\n", "1: there are no rows below the header"),
    ];
    for (csv, expected) in cases {
        let errors = file.check(Some(csv)).expect_err(csv);
        assert_eq!(errors.problems[0].message, format!("shapes/a.csv:{expected}"), "for {csv}");
        assert_eq!(errors.problems[0].key, "initial.file");
    }
}

#[test]
fn exact_every_choice_of_the_table_is_understood() {
    let wind = |key: &str| match key {
        "initial.state" | "cable.damping.model" | "fluid.drag.law" | "winch.setpoint" => false,
        _ => FULL.contains(key.rsplit('.').next().unwrap_or(key)),
    };
    for key in KEYS.iter().filter(|k| wind(k.name)) {
        let Form::Choice(values) = key.form else { continue };
        let name = key.local_name();
        for value in values {
            let lines: Vec<_> = FULL
                .lines()
                .map(|l| if l.starts_with(&format!("{name} =")) { format!("{name} = \"{value}\"") } else { l.into() })
                .collect();
            assert_eq!(problems(&lines.join("\n")), Vec::<String>::new(), "{} = {value}", key.name);
        }
    }
}
