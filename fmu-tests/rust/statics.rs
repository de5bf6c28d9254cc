//! Equilibria: elastica, elastic catenary, a cable in a shear flow, the straight tow.

mod bench;

use bench::{NYLON, Wire, at_rest, catenary, pull, root, run, settled, started, table, tip};
use fairlead::sim::{Channel, Inputs};
use fairlead::system::{FirstEnd, System};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// P2: a drum whose top is the origin holds the slope along x.
const CANTILEVER: Wire = Wire { length: 0.0464, ea: 222.660_379, laws: "compression = \"linear\"", ..NYLON };
const CLAMPED: &str = "[winch]\nposition = [0, 0, -0.100225]\naxis = [0, 1, 0]\nradius = 0.1\ngain_position = 1\ngain_rate = 1\n\
                       direction = 1\nend = \"tangent\"\n[body]\nmass = 1.33e-3\n";

fn elastica_tip() -> Vector3<f64> {
    let rows = table(include_str!("../references/p2_elastica.csv"));
    let last = rows.last().expect("rows");
    Vector3::new(last[1], 0.0, last[2])
}

#[test]
fn cross_elastica_of_p2() {
    let truth = elastica_tip();
    // Measured mesh error of three Gauss points for stretch and bending (the prototype's 1.3e-3, 5.3e-5, 1.2e-6) and 5 % room. The scene's
    // own clamp gives way by 1e-4 of the first element's turn, which outweighs the mesh from 32 elements on.
    for (elements, mesh, scene_bound) in [(8, 1.35e-3, 1.35e-3), (16, 5.6e-5, 5.6e-5), (32, 1.35e-6, 3.4e-6)] {
        let scene = CANTILEVER.scene(elements, CLAMPED);
        let error = |u: &[f64]| (tip(u) - truth).norm() / CANTILEVER.length;
        let whole = error(started(&scene, &Inputs::default()).shape());
        let mut system = System::new(&scene);
        if let FirstEnd::Winch { clamp, .. } = &mut system.first {
            *clamp *= 1e4;
        }
        let stiff = error(&settled(&mut system, &scene, [0.0; 3]));
        println!("elastica, {elements} elements: tip error over length {stiff:.2e}; with the scene's own clamp {whole:.2e}");
        assert!(stiff < mesh && whole < scene_bound, "{elements}: {stiff:e} {whole:e}");
    }
}

#[test]
fn exact_elastic_catenary() {
    let wire = Wire { length: 10.0, diameter: 0.01, mass_per_length: 1.0, ea: 2e4, ei: 0.0, laws: "" };
    let body = 1e-3;
    // Pulled sideways; pulled sideways and up, so that it sags below both ends.
    for force in [Vector3::new(30.0, 0.0, 0.0), Vector3::new(24.0, -18.0, 60.0)] {
        let (truth, first) = catenary(&wire, force - Vector3::z() * body * 9.81);
        let mut errors = vec![];
        for elements in [8, 16, 32] {
            let scene = wire.scene(elements, &format!("[anchor]\nposition = [1, 2, 3]\n[body]\nmass = {body:?}\n"));
            let sim = started(&scene, &pull(force.into()));
            let position = (sim.outputs().body.position - Vector3::new(1.0, 2.0, 3.0) - truth).norm() / wire.length;
            let reaction = (sim.outputs().anchor.force - first).norm() / first.norm();
            let tension = (sim.outputs().anchor.tension / first.norm() - 1.0).abs();
            println!("catenary, {elements} elements: tip {position:.1e} of the length, reaction {reaction:.1e}, tension {tension:.1e}");
            // Statics: the reaction is weight and pull, to the solver's 1e-10.
            assert!(reaction < 1e-9, "{reaction:e}");
            errors.push((position, tension));
        }
        let order = (errors[1].0 / errors[2].0).log2();
        println!("catenary: order {order:.1}");
        // Cubic elements: at least h⁴. 32 elements measured at 1e-8 and 2e-8.
        assert!(order > 4.5 && errors[2].0 < 3e-8, "{errors:?}");
        // The nodal tension is the reaction's component along the slope: its error is the square of the slope's.
        assert!(errors[0].1 < 6e-6 && errors[2].1 < 1e-9, "{errors:?}");
    }
}

/// P5 without waves: hung 0.46 m above the water in a flow that slows with depth.
const TOWED: Wire = Wire { length: 1.01, ei: 0.0, ..NYLON };
const SHEAR: &str = "[anchor]\nposition = [0, 0, 0.46]\n\
    [fluid]\ndensity = 1026\nwaterline = 0\nadded_mass = 1\ncurrent.profile = [[0, 0.3302, 0], [-0.5, 0.03655, 0]]\n\
    drag = { law = \"cross_flow\", cd_normal = 2.30, cd_tangential = 0.05 }\n\
    [body]\nmass = 1.33e-3\nvolume = 5.235987755982989e-7\ndrag_area = 7.853981633974483e-5\ndrag_coefficient = 0.45\n";

#[test]
fn cross_steady_shape_of_p5() {
    let rows = table(include_str!("../references/p5_steady.csv"));
    // Mesh error, measured 5.8e-4, 7.3e-5, 5.0e-7 m and, in tension, 1.8e-4, 8.1e-5, 5.0e-7: the drag sets in with a kink at the water's
    // surface inside an element. The reference is good to 1e-9.
    for (elements, far, pull_off) in [(10, 6.5e-4, 2e-4), (20, 8e-5, 9e-5), (101, 6e-7, 6e-7)] {
        let scene = TOWED.scene(elements, SHEAR);
        let (system, u) = at_rest(&scene, [0.0; 3]);
        let (mut position, mut tension) = (0.0f64, 0.0f64);
        for (i, s) in system.arc.iter().enumerate() {
            let Some(row) = rows.iter().find(|r| (r[0] - s).abs() < 1e-9) else { continue };
            let (x, z) = (u[6 * i] - row[1], u[6 * i + 2] + 0.46 - row[2]);
            position = position.max(x.hypot(z));
            // What the elements beyond hold: the force of element i on its first node, or of the last on its last.
            let f = |e: usize, k: usize| Vector3::from_fn(|c, _| system.forces[e][k + c]);
            let t = if i < elements { f(i, 0) } else { f(i - 1, 6) };
            tension = tension.max((t.norm() - row[3]).abs() / rows[0][3]);
        }
        println!("P5 steady, {elements} elements: position {position:.1e} m, tension {tension:.1e}");
        assert!(position < far && tension < pull_off, "{elements}: {position:e} {tension:e}");
    }
}

/// w cos φ = ½ρ d C U² f(φ), φ from the horizontal, f = sin² φ across or the loading function.
fn critical_angle(w: f64, c: f64, f: impl Fn(f64) -> f64) -> f64 {
    root(|phi| w * phi.cos() - c * f(phi), 1e-9, PI / 2.0)
}

#[test]
fn exact_critical_angle_of_a_long_tow() {
    let wire = Wire { length: 100.0, diameter: 0.02, mass_per_length: 1.0, ea: 1e8, ei: 0.0, laws: "" };
    let (rho, cd, speed) = (1025.0, 1.2, 1.5);
    let w = 9.81 * (wire.mass_per_length - rho * PI / 4.0 * wire.diameter.powi(2));
    let c = 0.5 * rho * wire.diameter * speed * speed;
    let f_p = |e: f64| 0.5 - 0.1 * e.cos() + 0.1 * e.sin() - 0.4 * (2.0 * e).cos() - 0.011 * (2.0 * e).sin();
    let f_q = |e: f64| 0.01 * (2.008 - 0.3858 * e + 1.9159 * e.powi(2) - 4.16147 * e.powi(3) + 3.5064 * e.powi(4) - 1.187299 * e.powi(5));
    let cross = critical_angle(w, c * cd, |p| p.sin().powi(2));
    let loading = critical_angle(w, c * cd, f_p);
    let cases = [
        ("drag = { law = \"cross_flow\", cd_normal = 1.2, cd_tangential = 0.03 }", cross, PI * 0.03 * c * cross.cos().powi(2)),
        ("drag = { law = \"loading_functions\", cd = 1.2 }", loading, c * cd * f_q(loading)),
    ];
    for (law, phi, along) in cases {
        let fluid = format!("[fluid]\ndensity = {rho:?}\nwaterline = 10\n{law}\n[anchor]\nposition = [0, 0, 0]\n");
        let check = |name: &str, tip: Vector3<f64>, tension: f64| {
            let angle = (-tip.z).atan2(tip.x);
            let expected = (w * phi.sin() + along) * wire.length;
            println!(
                "{name}: angle {:.6} deg, closed form {:.6} deg; tension {tension:.4} N, closed form {expected:.4} N",
                angle.to_degrees(),
                phi.to_degrees()
            );
            // A straight line is an exact state of the elements; what remains is the solver's 1e-10 of the weight, over a stiffness of weight/length.
            assert!((angle - phi).abs() < 1e-8, "{:e}", angle - phi);
            assert!((tip.norm() / wire.length - 1.0 - 0.5 * expected / wire.ea).abs() < 1e-9);
            assert!((tension / expected - 1.0).abs() < 1e-8, "{:e}", tension / expected - 1.0);
        };
        let anchored = wire.scene(10, &[&fluid, "[body]\nmass = 1e-9\nvolume = 0\ndrag_area = 0\ndrag_coefficient = 0\n"].concat());
        let mut flow = Inputs::default();
        flow.current[0].value = speed;
        let sim = started(&anchored, &flow);
        check("in a current", sim.outputs().body.position, sim.outputs().anchor.tension);

        // The same by a ship under way in still water, from the first moment on.
        let towed = wire.scene(10, &[&fluid, "[ship]\ninput = \"pose_velocity\"\n"].concat());
        let pose = |t: f64| {
            let mut inputs = Inputs { ship: [Channel { first: Some(0.0), ..Channel::default() }; 6], ..Inputs::default() };
            inputs.ship[0] = Channel { value: -speed * t, first: Some(-speed), second: None };
            inputs
        };
        let mut sim = started(&towed, &pose(0.0));
        run(&mut sim, 0.5, 5.0, pose, |_, _| {});
        check("behind a ship", sim.outputs().body.position + Vector3::x() * speed * 5.0, sim.outputs().anchor.tension);
    }
}
