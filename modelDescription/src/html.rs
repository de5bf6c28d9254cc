//! documentation/index.html, written from the same tables as the interface.

use crate::advice::{ADVICE, COMPENSATION, DERIVATIVES};
use crate::document::{LOG_CATEGORIES, STATUS_CODES};
use crate::keys::{Constant, GROUPS, KEYS, Presence};
use crate::notes::notes;
use crate::units::type_named;
use crate::{Causality, Document, Kind, Quantity, Value, Variability, Variable};
use std::fmt::Write;

/// The page.
pub fn page(d: &Document) -> String {
    let name = escape(d.name);
    let mut p = String::new();
    p += "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
    p += &format!("<title>{name} &ndash; fairlead</title>\n<style>{STYLE}</style>\n</head>\n<body>\n<h1>{name}</h1>\n");
    p += &format!("<p>{}</p>\n", escape(d.description));
    p += &format!(
        "<p>An FMI 2.0 co-simulation FMU of a marine cable, made by fairlead {}; GUID {}.</p>\n",
        escape(d.version),
        escape(d.guid)
    );
    p += CONTENTS;
    scene(&mut p, d);
    p += &format!("{USE}{FILES}");
    p += MODEL;
    p += if d.shape.ned { FRAMES_NED } else { FRAMES_Z_UP };
    p += SIGNS;
    p += STEPS;
    if d.shape.winch && !d.shape.external_setpoint {
        p += COMPENSATION;
    }
    p += DERIVATIVES;
    p += ADVICE;
    p += "<h2 id=\"variables\">Inputs and outputs</h2>\n";
    for (title, causality) in [("Inputs", Causality::Input), ("Outputs", Causality::Output)] {
        variables(&mut p, title, causality, d.variables);
    }
    p += "<h2 id=\"parameters\">Parameters</h2>\n<p>Every number of the scene. Fixed ones may be set before the start, tunable ones at ";
    p += "communication points too. A value that makes no sense is refused with its name and what was expected.</p>\n";
    variables(&mut p, "Scene", Causality::Parameter, d.variables);
    scene_file(&mut p);
    p += LIMITS;
    status(&mut p);
    p += "</body>\n</html>\n";
    p
}

const STYLE: &str = "
body { font: 16px/1.5 system-ui, sans-serif; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; color: #1a2530; }
h1, h2 { line-height: 1.2; } h2 { margin-top: 2.5rem; border-bottom: 1px solid #c5d0da; }
table { border-collapse: collapse; width: 100%; font-size: 0.9rem; margin: 0.5rem 0 1.5rem; }
th, td { text-align: left; vertical-align: top; padding: 0.25rem 0.6rem; border-bottom: 1px solid #e3e9ef; }
th { background: #f0f4f8; } td:first-child, code { font-family: ui-monospace, monospace; font-size: 0.85rem; }
caption { text-align: left; font-weight: bold; padding: 0.4rem 0; }
";

const CONTENTS: &str = "<p><a href=\"#about\">This scene</a> &middot; <a href=\"#use\">How to \
use it</a> &middot; <a href=\"#model\">Model</a> &middot; <a href=\"#frames\">Frames and signs</a> &middot; <a href=\"#steps\">Steps</a> &middot; \
<a href=\"#derivatives\">Derivatives</a> &middot; \
<a href=\"#variables\">Inputs and outputs</a> &middot; <a href=\"#parameters\">Parameters</a> &middot; <a href=\"#scene\">Scene file</a> &middot; \
<a href=\"#limits\">Limits</a> &middot; <a href=\"#status\">Errors and status</a></p>\n";

const USE: &str = "<h2 id=\"use\">How to use it</h2>
<ol>
<li>Set the parameters that shall differ from the scene's (<a href=\"#parameters\">all of them</a> have defaults).</li>
<li>Set the inputs for the start time while the FMU initializes: the cable's start shape is found for the ship's pose that is given there. Inputs that
nobody sets keep the start values listed below; that is a ship at rest, a winch that holds still and no current but the scene's.</li>
<li>At each communication point set the inputs of that time, then do the step. Give the ship's velocities, and accelerations where the FMU has
them, with its pose: a pose alone has to be continued from past samples, which costs accuracy (<a href=\"#derivatives\">how much</a>).</li>
<li>Look at <code>status.code</code> after each step, in particular if the importing tool ignores what a step returns.</li>
</ol>
<p>Feed <code>ship.force</code> and <code>ship.moment</code>, or <code>ship.force_world</code>, back to a ship that the cable shall pull at. Outputs have no
direct feed-through: they change at the end of a step only, so that a loop through the FMU is no algebraic one.</p>
";

const FILES: &str = "<p>In this archive besides: <code>resources/scene.toml</code>, the scene as a text that fairlead packs again after changes;
<code>terminalsAndIcons</code>, inputs and outputs grouped for tools that connect whole vectors; <code>documentation/licenses</code>. The groups are also
in <code>NAME_OspModelDescription.xml</code> for OSP, and all parameters in <code>NAME.ssv</code> for SSP, both written beside the FMU with
<code>cargo xtask package --osp --ssp</code>.</p>
";

const MODEL: &str = "<h2 id=\"model\">Model</h2>
<p>The cable is a chain of gradient-deficient elements of the absolute nodal coordinate formulation (Gerstmayr and Shabana 2006): geometrically
exact stretching and bending, no torsion. Water acts by buoyancy, drag, added mass and current on the submerged part only. The current may carry turbulence: seeded noise of a given spectrum, uniform in space. Contact with drums and
sheaves is a line contact after Hunt and Crossley, integrated over the arcs that touch. A V groove has two flanks; their force fades over the last
tenth of the groove's depth, and beside the rim, so that a cable can climb out and is then free. Friction on a sheave is Coulomb's, fading below a
slip of 1 mm/s. The cable's first node is driven exactly along the winch drum, or fixed at an anchor.</p>
<p>Tensions are the section's axial force. <code>winch.tension</code>, <code>tension_in</code> and <code>tension_out</code> are the pull of the free
span, N + &frac12;EI&kappa;&sup2; at the end of the contact arc. In water all of them are effective tensions.</p>
";

const FRAMES_Z_UP: &str = "<h2 id=\"frames\">Frames and signs</h2>
<p><b>This FMU uses z up.</b> Inertial frame: x and y horizontal, z up, origin anywhere; the still water surface is at
z = <code>fluid.waterline</code>. Ship frame: origin at the ship's reference point (centre of gravity), x forward, y to port, z up.
Positive roll is starboard down, positive pitch bow down, positive yaw bow to port.</p>
";

const FRAMES_NED: &str = "<h2 id=\"frames\">Frames and signs</h2>
<p><b>This FMU uses z down (NED).</b> Inertial frame: x north, y east, z down; the still water surface is at
z = <code>fluid.waterline</code>. Ship frame: origin at the ship's reference point (centre of gravity), x forward, y to starboard, z down. Every
inertial and ship quantity of the scene file, of the parameters, inputs and outputs is given in these frames.
Positive roll is starboard down, positive pitch bow up, positive yaw bow to starboard.</p>
";

const SIGNS: &str = "<p>Attitude: R = R<sub>z</sub>(yaw) R<sub>y</sub>(pitch) R<sub>x</sub>(roll) takes ship components to inertial ones. The rates are the
time derivatives of these three angles, not body rates. Velocities and accelerations are those of the ship frame's origin in the inertial frame.</p>
<p>Forces and moments are what the cable does to the thing named. Angles about a winch's or sheave's axis turn right-handed about it, from
&ldquo;up&rdquo;: the ship's upward direction made normal to the axis (the ship's x where the axis is vertical). <code>winch.payout</code> is
the length paid out since the start; with <code>winch.direction</code> = -1 the cable leaves the drum towards negative angles, so that a decreasing
angle pays out. <code>contact_begin</code> and <code>contact_end</code> bound the contact arc, <code>wrap_angle</code> is their difference,
<code>turn_angle</code> what the cable turns between the free spans (their directions taken three bending lengths
&radic;(EI/T), or an element's length, beyond the arc). <code>line_load_min</code> is the least load away from the arc's ends, where every load begins
at nothing. Groove flank 1 is the one whose normal points along the axis.</p>
";

const STEPS: &str = "<h2 id=\"steps\">Communication steps</h2>
<p>Any step size, in any order; the solver chooses its own sub-steps and ends exactly at the communication point. Within a step an input follows
its input derivatives where the importer sets them, else the velocity and acceleration inputs, else a smooth reconstruction from past samples.
Outputs are those of the last communication point. The state can be saved, restored and serialized at any communication point.</p>
";

const LIMITS: &str = "<h2 id=\"limits\">Limits</h2>
<ul>
<li>No torsion, no contact of the cable with itself or with the sea bed, one layer on the drum and no friction
there. A step that would bring the cable's far end nearer than an eighth of its radius to a drum with contact is refused:
all of the cable is reeled in.</li>
<li>The section is linearly elastic: EA and EI do not change with load. The drag of <code>cd = \"cylinder\"</code> is that of a smooth cylinder for Reynolds
numbers up to 2&middot;10<sup>5</sup>, of <code>\"sphere\"</code> up to 3&middot;10<sup>5</sup>, and is held constant beyond.</li>
<li>The water surface is still; waves act through the ship's motion only. The current's profile is horizontal and does not change along x and y; its turbulence is the same everywhere.</li>
<li>A cable without bending stiffness (EI = 0) has no defined shape where it is slack.</li>
<li>With <code>cable.compression = \"linear\"</code> a slack cable buckles at the mesh's wavelength; snap loads are then not to be trusted.</li>
<li>Pitch stays within &plusmn;90&deg; (Euler angles).</li>
</ul>
";

/// What the scene file says in its comments, and the picture of its start shape.
fn scene(p: &mut String, d: &Document) {
    let notes = notes(d.text);
    *p += "<h2 id=\"about\">This scene</h2>\n";
    if let Some(picture) = d.picture {
        *p += &format!("<p><img src=\"{}\" alt=\"The cable's start shape from the side\"></p>\n", escape(picture));
    }
    for paragraph in &notes.preface {
        *p += &format!("<p>{}</p>\n", escape(paragraph));
    }
    if !notes.remarks.is_empty() {
        *p += "<table>\n<caption>Remarks in the scene file</caption>\n<tr><th>Key</th><th>Value there</th><th>Remark</th></tr>\n";
        for r in &notes.remarks {
            *p += &format!("<tr><td>{}</td><td>{}</td><td>{}</td></tr>\n", escape(&r.key), escape(&r.value), escape(&r.text));
        }
        *p += "</table>\n";
    }
}

fn variables(p: &mut String, title: &str, causality: Causality, all: &[Variable]) {
    let mut rows = all.iter().filter(|v| v.causality == causality).peekable();
    if rows.peek().is_none() {
        return;
    }
    let parameter = causality == Causality::Parameter;
    let start = if causality == Causality::Output { "" } else { "<th>Start</th>" };
    let change = if parameter { "<th>Change</th>" } else { "" };
    *p += &format!(
        "<table>\n<caption>{title}</caption>\n<tr><th>Name</th><th>Unit</th><th>Type</th>{start}{change}<th>Description</th></tr>\n"
    );
    for v in rows {
        let unit = match (v.unit, v.declared_type.and_then(type_named).and_then(|t| t.display)) {
            (Some(unit), Some(display)) => format!("{unit} (shown in {display})"),
            (unit, _) => unit.unwrap_or_default().to_owned(),
        };
        let start = v.start.as_ref().map_or(String::new(), |s| format!("<td>{}</td>", plain(s)));
        let change = match v.variability {
            Variability::Tunable => "<td>tunable</td>",
            _ if parameter => "<td>fixed</td>",
            _ => "",
        };
        let mut description = escape(&v.description);
        if matches!(v.quantity, Quantity::Output(output) if v.kind == Kind::Real && !output.is_smooth()) {
            description += " (no derivatives)";
        }
        *p += &format!("<tr><td>{}</td><td>{unit}</td><td>{:?}</td>{start}{change}<td>{description}</td></tr>\n", escape(&v.name), v.kind);
    }
    *p += "</table>\n";
}

fn scene_file(p: &mut String) {
    *p += "<h2 id=\"scene\">Scene file</h2>\n<p><code>resources/scene.toml</code> is what this FMU was made from. All that a scene file may say:</p>\n";
    for group in GROUPS {
        let title = match (group.name, group.repeated) {
            ("", _) => "top level".to_owned(),
            (name, true) => format!("[[{name}]]"),
            (name, false) => format!("[{name}]"),
        };
        *p += &format!("<table>\n<caption><code>{title}</code>: {}</caption>\n", escape(group.description));
        *p += "<tr><th>Key</th><th>Expected</th><th>If left out</th><th>Description</th></tr>\n";
        for key in KEYS.iter().filter(|k| k.group().name == group.name) {
            let absent = match key.presence {
                Presence::Required => "an error".to_owned(),
                Presence::RequiredWith(other) => format!("an error with [{other}]"),
                Presence::Optional => "none".to_owned(),
                Presence::Default(constant) => default(constant),
            };
            let expected = escape(&key.form.expected());
            *p += &format!(
                "<tr><td>{}</td><td>{expected}</td><td>{absent}</td><td>{}</td></tr>\n",
                key.local_name(),
                escape(key.description)
            );
        }
        *p += "</table>\n";
    }
}

fn status(p: &mut String) {
    *p += "<h2 id=\"status\">Errors and status</h2>\n<p>A step that cannot be done is first tried with smaller sub-steps. If that fails, the state is that of \
the last communication point, and the log says when, where along the cable, why and what to try. Inputs that are no finite numbers are refused.</p>\n";
    *p += "<table>\n<caption><code>status.code</code></caption>\n<tr><th>Code</th><th>Name</th><th>Meaning</th></tr>\n";
    for (code, name, meaning) in STATUS_CODES {
        let _ = writeln!(p, "<tr><td>{code}</td><td>{name}</td><td>{meaning}</td></tr>");
    }
    *p += "</table>\n<table>\n<caption>Log categories</caption>\n<tr><th>Category</th><th>Meaning</th></tr>\n";
    for (name, meaning) in LOG_CATEGORIES {
        let _ = writeln!(p, "<tr><td>{name}</td><td>{}</td></tr>", escape(meaning));
    }
    *p += "</table>\n";
}

fn plain(value: &Value) -> String {
    match value {
        Value::Real(x) => x.to_string(),
        Value::Integer(i) => i.to_string(),
        Value::Boolean(b) => b.to_string(),
        Value::String(s) => escape(s),
    }
}

fn default(constant: Constant) -> String {
    match constant {
        Constant::Real(x) => x.to_string(),
        Constant::Integer(i) => i.to_string(),
        Constant::Text(s) => format!("\"{s}\""),
        Constant::Flag(b) => b.to_string(),
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
