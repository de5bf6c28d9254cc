//! Scene files with random damage.

use super::harness::random::{Random, rounds};
use fairlead::scene::file::SceneFile;
use fairlead::sim::Simulation;
use model_description::scenes::SCENES;

/// What a careless or evil hand may put in the place of a value.
const VALUES: [&str; 24] = [
    "nan",
    "inf",
    "-inf",
    "-0.0",
    "0",
    "1e400",
    "-1",
    "1e-320",
    "9223372036854775807",
    "-9223372036854775808",
    "0x7fffffff",
    "true",
    "\"\"",
    "\"flume\"",
    "[]",
    "[[]]",
    "{}",
    "[nan, 0.0, 1.0]",
    "[0.0, 0.0, 0.0]",
    "[1e308, 1e308, 1e308]",
    "1979-05-27",
    "'''\n'''",
    "100000",
    "\"\\u0000\"",
];

/// One change; several make a damaged file.
fn damage(text: &mut String, random: &mut Random) {
    let lines: Vec<&str> = text.lines().collect();
    let at = random.below(lines.len().max(1));
    let line = lines.get(at).copied().unwrap_or_default();
    let with = |replacement: Option<String>| {
        let mut lines: Vec<String> = lines.iter().map(|&l| l.to_owned()).collect();
        match replacement {
            Some(replacement) if at < lines.len() => lines[at] = replacement,
            _ if at < lines.len() => drop(lines.remove(at)),
            _ => {}
        }
        lines.join("\n")
    };
    *text = match random.below(8) {
        0 => with(None),
        1 => with(Some(format!("{line}\n{line}"))),
        // Another scene's line.
        2 => {
            let other: Vec<&str> = random.pick(SCENES).text.lines().collect();
            with(Some(format!("{line}\n{}", random.pick(&other))))
        }
        3..=5 => match line.split_once('=') {
            Some((key, _)) => with(Some(format!("{key}= {}", random.pick(&VALUES)))),
            None => with(Some(line.to_owned())),
        },
        // A number a few orders of magnitude off: valid more often than not.
        6 => match line.split_once('=').map(|(key, value)| (key, value.split('#').next().unwrap_or_default().trim().parse::<f64>())) {
            Some((key, Ok(number))) => with(Some(format!("{key}= {:e}", number * 10_f64.powf(6.0 * random.unit() - 3.0)))),
            _ => with(Some(line.to_owned())),
        },
        _ => {
            let mut bytes = text.clone().into_bytes();
            if !bytes.is_empty() {
                let at = random.below(bytes.len());
                bytes[at] = random.next() as u8;
            }
            String::from_utf8_lossy(&bytes).into_owned()
        }
    };
}

/// Every damaged file is either refused with a reason or is a scene; nothing panics.
#[test]
fn exact_damaged_scenes_are_refused_or_are_scenes() {
    let (mut refused, mut good) = (0, 0);
    for seed in 0..rounds(4000) {
        let mut random = Random::new(seed);
        let mut text = random.pick(SCENES).text.to_owned();
        for _ in 0..1 + random.below(4) {
            damage(&mut text, &mut random);
        }
        match SceneFile::parse(&text, "damaged.toml").and_then(|file| file.check(None)) {
            Ok(_) => good += 1,
            Err(errors) => {
                assert!(errors.to_string().contains("damaged.toml"), "seed {seed}: {errors}");
                refused += 1;
            }
        }
    }
    // Else the search looks at one side only.
    assert!(refused > good / 10 && good > refused / 10, "{refused} refused, {good} good");
}

/// Scenes that are strange but obey the rules: they start and run a little, or say why not.
#[test]
fn exact_strange_scenes_run_or_say_why_not() {
    let mut ran = 0;
    for seed in 0..rounds(150) {
        let mut random = Random::new(seed);
        let mut text = random.pick(SCENES).text.to_owned();
        for _ in 0..1 + random.below(3) {
            damage(&mut text, &mut random);
        }
        let Ok(scene) = SceneFile::parse(&text, "strange.toml").and_then(|file| file.check(None)) else { continue };
        // Large meshes cost time and find nothing new.
        if scene.elements.len() > 60 {
            continue;
        }
        let Ok(mut simulation) = Simulation::new(&scene) else { continue };
        let inputs = Default::default();
        if simulation.initialize(0.0, &inputs).is_ok() {
            let end = simulation.step_to(1e-3, &inputs);
            let outputs = format!("{:?}", simulation.outputs());
            assert!(!outputs.contains("NaN") && !outputs.contains("inf"), "seed {seed}, {end:?}: {outputs}");
            ran += 1;
        }
    }
    assert!(ran > 0, "none of the scenes ran");
}
