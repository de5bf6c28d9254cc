//! The table of scene keys: all that a scene file may say, with types, units, ranges and defaults.
//!
//! The reader of scene files is driven by it, the documentation is written from it, and each number is an FMI parameter.

use crate::pattern::strip;
use crate::table::{Of, reference};
use crate::units::{self as u, Type};

/// Whether a key or table must be there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Presence {
    /// Always (if its table is there).
    Required,
    /// Must be there if this table is; may be there otherwise.
    RequiredWith(&'static str),
    /// May be left out.
    Optional,
    /// Taken to be this if left out.
    Default(Constant),
}

/// A default.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Constant {
    /// A number.
    Real(f64),
    /// A whole number.
    Integer(i64),
    /// A string.
    Text(&'static str),
    /// true or false.
    Flag(bool),
}

/// For which values of its neighbours a key is allowed. Names are relative to the key's table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// Always.
    Always,
    /// If this key is there.
    Given(&'static str),
    /// If this key has one of these values.
    Is(&'static str, &'static [&'static str]),
}

/// Allowed numbers; all must be finite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Range {
    /// Any.
    Any,
    /// > 0.
    Positive,
    /// ≥ 0.
    NotNegative,
    /// > first and < second.
    Inside(f64, f64),
}

impl Range {
    /// Whether a value is allowed.
    pub fn holds(self, value: f64) -> bool {
        value.is_finite()
            && match self {
                Self::Any => true,
                Self::Positive => value > 0.0,
                Self::NotNegative => value >= 0.0,
                Self::Inside(low, high) => low < value && value < high,
            }
    }

    /// In words, after "a number ".
    pub fn words(self) -> String {
        match self {
            Self::Any => String::new(),
            Self::Positive => " > 0".into(),
            Self::NotNegative => " >= 0".into(),
            Self::Inside(low, high) => format!(" between {low} and {high}, both excluded"),
        }
    }
}

/// A column of a table of numbers.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// What it holds.
    pub name: &'static str,
    /// Physical type.
    pub of: &'static Type,
    /// Allowed values.
    pub range: Range,
    /// Whether it may be changed at communication points.
    pub tunable: bool,
}

/// What a key holds.
#[derive(Clone, Copy, Debug)]
pub enum Form {
    /// A number.
    Real(&'static Type, Range),
    /// A whole number from the first to the second.
    Integer(i64, i64),
    /// One of these whole numbers.
    OneOf(&'static [i64]),
    /// Three numbers.
    Vector(&'static Type),
    /// Any number of rows of numbers.
    Rows(&'static [Column]),
    /// A number, a table over the Reynolds number, or the name of a correlation.
    Coefficient,
    /// One of these strings.
    Choice(&'static [&'static str]),
    /// true or false.
    Flag,
    /// Any string.
    Text,
    /// A C identifier.
    Identifier,
}

/// Names of the built-in correlations of a drag coefficient over the Reynolds number.
pub const CORRELATIONS: &[&str] = &["cylinder", "sphere"];

/// Columns of a drag coefficient's table.
pub const COEFFICIENT_COLUMNS: &[Column] = &[
    Column { name: "Reynolds number", of: &u::REYNOLDS, range: Range::Positive, tunable: false },
    Column { name: "coefficient", of: &u::COEFFICIENT, range: Range::NotNegative, tunable: false },
];

const PROFILE_COLUMNS: &[Column] = &[
    Column { name: "height z", of: &u::POSITION, range: Range::Any, tunable: false },
    Column { name: "velocity x", of: &u::VELOCITY, range: Range::Any, tunable: true },
    Column { name: "velocity y", of: &u::VELOCITY, range: Range::Any, tunable: true },
];

impl Form {
    /// What a user should have written, with the unit.
    pub fn expected(&self) -> String {
        match self {
            Self::Real(t, range) => format!("a number{}{}", range.words(), unit_words(t)),
            Self::Integer(low, i64::MAX) => format!("a whole number >= {low}"),
            Self::Integer(low, high) => format!("a whole number from {low} to {high}"),
            Self::OneOf(values) => list(values.iter().map(i64::to_string)),
            Self::Vector(t) => format!("three finite numbers [x, y, z]{}", unit_words(t)),
            Self::Rows(columns) => {
                let columns: Vec<_> = columns.iter().map(|c| format!("{}{}{}", c.name, c.range.words(), unit_words(c.of))).collect();
                format!("rows [[{}], ...] of finite numbers", columns.join(", "))
            }
            Self::Coefficient => {
                format!("a number >= 0, a table [[Re, C], ...] with Re > 0 and C >= 0, or {}", list(CORRELATIONS.iter().map(quoted)))
            }
            Self::Choice(values) => list(values.iter().map(quoted)),
            Self::Flag => "true or false".into(),
            Self::Text => "a string without control characters".into(),
            Self::Identifier => "a C identifier (letters, digits and _, no digit first, at most 63)".into(),
        }
    }
}

fn unit_words(t: &Type) -> String {
    t.unit.map_or(String::new(), |unit| format!(" in {unit}"))
}

fn quoted(s: &&str) -> String {
    format!("\"{s}\"")
}

fn list(words: impl Iterator<Item = String>) -> String {
    words.collect::<Vec<_>>().join(" or ")
}

/// A table of the scene file.
#[derive(Clone, Copy, Debug)]
pub struct Group {
    /// Dotted name; empty for the file's top level.
    pub name: &'static str,
    /// Whether it must be there; a table with defaults only is always taken to be there.
    pub presence: Presence,
    /// Whether it is an array of tables.
    pub repeated: bool,
    /// One sentence.
    pub description: &'static str,
}

const fn group(name: &'static str, presence: Presence, repeated: bool, description: &'static str) -> Group {
    Group { name, presence, repeated, description }
}

use Presence::{Default, Optional, Required, RequiredWith};
/// A group that is there even if the file does not mention it.
const IMPLIED: Presence = Default(Constant::Flag(true));

/// All tables.
#[rustfmt::skip] // one row a line
pub static GROUPS: &[Group] = &[
    group("", IMPLIED, false, "The scene"),
    group("cable", Required, false, "The cable's section"),
    group("mesh", Required, false, "Finite elements: elements of equal length, regions, or an error to grade them by"),
    group("mesh.regions", Optional, true, "Stretches of cable with elements of equal length, from the first end; they sum to cable.length"),
    group("fluid", Optional, false, "Water; without it, vacuum"),
    group("fluid.current.noise", Optional, false, "Turbulence of the current, uniform in space: white noise through a Chebyshev-II low-pass, added to profile and inputs; the same for the same seed and time. A static start does not feel it"),
    group("ship", Optional, false, "The ship's motion; without it, the ship's frame rests at the origin"),
    group("winch", Optional, false, "A driven drum at the cable's first end"),
    group("anchor", Optional, false, "A fixed point of the ship at the cable's first end, instead of a winch"),
    group("sheave", Optional, true, "Sheaves, in the order in which the cable passes them"),
    group("body", Optional, false, "A lump at the cable's far end"),
    group("load", Optional, false, "A rigid link hanging from the cable's far end, with weight and inertia; water does not act on it"),
    group("far_end", Optional, false, "A fixed far end"),
    group("initial", IMPLIED, false, "How a run starts"),
    group("solver", IMPLIED, false, "Numerical settings"),
    group("outputs", IMPLIED, false, "Which outputs there are"),
];

/// One key of the scene file.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Number that value references start from; never reused.
    pub id: u32,
    /// Dotted name, without indices.
    pub name: &'static str,
    /// What it holds.
    pub form: Form,
    /// Whether it must be there.
    pub presence: Presence,
    /// When it is allowed.
    pub when: When,
    /// Whether the parameter may be changed at communication points; of [`Form::Rows`] the columns say it.
    pub tunable: bool,
    /// Whether it decides which variables there are and so cannot be a parameter.
    pub structural: bool,
    /// Name of the parameter where the key's own name belongs to another variable.
    pub parameter: Option<&'static str>,
    /// One sentence without a full stop.
    pub description: &'static str,
}

const fn key(id: u32, name: &'static str, form: Form, presence: Presence, description: &'static str) -> Key {
    Key { id, name, form, presence, when: When::Always, tunable: false, structural: false, parameter: None, description }
}

impl Key {
    const fn when(mut self, when: When) -> Self {
        self.when = when;
        self
    }

    const fn tunable(mut self) -> Self {
        self.tunable = true;
        self
    }

    const fn structural(mut self) -> Self {
        self.structural = true;
        self
    }

    const fn parameter(mut self, name: &'static str) -> Self {
        self.parameter = Some(name);
        self
    }

    /// The innermost table that the key belongs to.
    pub fn group(&self) -> &'static Group {
        let holds = |g: &&Group| g.name.is_empty() || self.name.strip_prefix(g.name).is_some_and(|rest| rest.starts_with('.'));
        GROUPS.iter().filter(holds).max_by_key(|g| g.name.len()).unwrap_or(&GROUPS[0])
    }

    /// The name relative to its table.
    pub fn local_name(&self) -> &'static str {
        let group = self.group().name;
        if group.is_empty() { self.name } else { &self.name[group.len() + 1..] }
    }
}

use Form::{Choice, Coefficient, Flag, Identifier, Integer, OneOf, Real, Rows, Text, Vector};
use Range::{Any, Inside, NotNegative, Positive};
use When::{Given, Is};

const fn real(value: f64) -> Presence {
    Default(Constant::Real(value))
}

const fn text(value: &'static str) -> Presence {
    Default(Constant::Text(value))
}

const MAX: i64 = i32::MAX as i64;
const KELVIN_VOIGT: When = Is("damping.model", &["kelvin_voigt"]);
const LOADING_FUNCTIONS: When = Is("drag.law", &["loading_functions"]);
const CROSS_FLOW: When = Is("drag.law", &["cross_flow"]);

/// All keys, in the order of the parameters.
#[rustfmt::skip] // one row a line
pub static KEYS: &[Key] = &[
    key(1001, "name", Identifier, Required, "The FMU's model identifier"),
    key(1002, "description", Text, text(""), "Free text"),
    key(1003, "gravity", Real(&u::ACCELERATION, NotNegative), real(9.81), "Gravitational acceleration"),

    key(1010, "cable.length", Real(&u::LENGTH, Positive), Required, "Unstretched length of the cable"),
    key(1011, "cable.diameter", Real(&u::LENGTH, Positive), Required, "Diameter of the cable"),
    key(1012, "cable.mass_per_length", Real(&u::LINE_MASS, Positive), Required, "Mass per unstretched length"),
    key(1013, "cable.EA", Real(&u::AXIAL_STIFFNESS, Positive), Optional, "Axial stiffness; or give E"),
    key(1014, "cable.EI", Real(&u::BENDING_STIFFNESS, NotNegative), Optional, "Bending stiffness; or give E and I"),
    key(1015, "cable.E", Real(&u::MODULUS, Positive), Optional, "Young's modulus over the full circular section, for EA = E pi d^2/4 and EI = E I"),
    key(1016, "cable.I", Real(&u::SECOND_MOMENT, NotNegative), Optional, "Second moment of area, for EI = E I").when(Given("E")),
    key(1017, "cable.compression", Choice(&["none", "linear"]), text("none"), "Axial law when pushed: no force, or the same stiffness"),
    key(1018, "cable.strain", Choice(&["engineering", "green"]), text("engineering"), "Strain and curvature measures"),
    key(1019, "cable.damping.model", Choice(&["kelvin_voigt", "gradient_rate"]), text("kelvin_voigt"), "Internal damping: objective, or the thesis's"),
    key(1020, "cable.damping.axial", Real(&u::AXIAL_DAMPING, NotNegative), real(0.0), "Axial force per strain rate").when(KELVIN_VOIGT),
    key(1021, "cable.damping.bending", Real(&u::BENDING_DAMPING, NotNegative), real(0.0), "Bending moment per curvature rate").when(KELVIN_VOIGT),
    key(1022, "cable.damping.in_slack", Flag, Default(Constant::Flag(true)), "Whether axial damping also acts while the cable is slack").when(KELVIN_VOIGT),
    key(1023, "cable.damping.coefficient", Real(&u::AXIAL_DAMPING, NotNegative), Required, "Coefficient of the gradient-rate damping").when(Is("damping.model", &["gradient_rate"])),

    key(1040, "mesh.elements", Integer(1, 100_000), Optional, "Number of elements of equal length"),
    key(1043, "mesh.error", Real(&u::RATIO, Inside(0.0, 1.0)), Optional, "Relative error of tensions for which elements are chosen: short where the cable lies or will lie on drum and sheaves, longer away from them"),
    key(1044, "mesh.travel", Real(&u::LENGTH, NotNegative), Optional, "The most that is paid out or reeled in during a run, for mesh.error; two drum diameters if left out").when(Given("error")),
    key(1041, "mesh.regions.length", Real(&u::LENGTH, Positive), Required, "Unstretched length of the region"),
    key(1042, "mesh.regions.elements", Integer(1, 100_000), Required, "Number of elements of the region"),

    key(1050, "fluid.density", Real(&u::DENSITY, Positive), Required, "Density of the water"),
    key(1051, "fluid.viscosity", Real(&u::VISCOSITY, Positive), Optional, "Dynamic viscosity; needed by coefficients that depend on the Reynolds number"),
    key(1052, "fluid.waterline", Real(&u::POSITION, Any), Required, "Height z of the still water surface in the inertial frame"),
    key(1053, "fluid.drag.law", Choice(&["loading_functions", "cross_flow"]), Required, "Drag on the cable: Driscoll and Nahon's loading functions, or independent normal and tangential parts"),
    key(1054, "fluid.drag.cd", Coefficient, Required, "Drag coefficient of the loading functions").when(LOADING_FUNCTIONS).tunable(),
    key(1055, "fluid.drag.cd_normal", Coefficient, Required, "Drag coefficient across the cable, on the diameter").when(CROSS_FLOW).tunable(),
    key(1056, "fluid.drag.cd_tangential", Real(&u::COEFFICIENT, NotNegative), Required, "Drag coefficient along the cable, on the circumference").when(CROSS_FLOW).tunable(),
    key(1057, "fluid.drag.amplification", Real(&u::COEFFICIENT, NotNegative), real(1.0), "Amplification of the normal drag by vortex shedding").tunable(),
    key(1058, "fluid.added_mass", Real(&u::COEFFICIENT, NotNegative), real(1.0), "Added mass coefficient of the cable, across it"),
    key(1059, "fluid.current.profile", Rows(PROFILE_COLUMNS), Optional, "Current over height, linear between rows and constant beyond them"),
    key(1060, "fluid.current.noise.std_dev", Vector(&u::VELOCITY), Required, "Standard deviation along the inertial axes, each >= 0"),
    key(1061, "fluid.current.noise.seed", Integer(0, MAX), Default(Constant::Integer(1)), "Chooses the realization"),
    key(1062, "fluid.current.noise.sample_rate", Real(&u::FREQUENCY, Positive), real(100.0), "Samples per second; smooth in between"),
    key(1063, "fluid.current.noise.order", Integer(1, 20), Default(Constant::Integer(8)), "Order of the filter"),
    key(1064, "fluid.current.noise.cutoff", Real(&u::FREQUENCY, Positive), real(2.0), "Where the filter's stop band begins; with the other defaults half the power passes at 1.07 Hz"),
    key(1065, "fluid.current.noise.attenuation", Real(&u::LEVEL, Inside(1.0, 200.0)), real(80.0), "Attenuation of the stop band in dB"),
    key(1066, "fluid.current.noise.ramp", Real(&u::DURATION, NotNegative), real(2.0), "Time in which the noise grows smoothly out of the mean current after the start of the run; 0: it is there at once"),

    key(1070, "ship.input", Choice(&["pose", "pose_velocity", "pose_velocity_acceleration"]), Required, "Which derivatives of the ship's pose are inputs"),
    key(1071, "ship.frame", Choice(&["z_up", "ned"]), text("z_up"), "Frame of every inertial and ship quantity, in the scene file too"),

    key(1080, "winch.position", Vector(&u::POSITION), Required, "Centre of the drum, ship axes"),
    key(1081, "winch.axis", Vector(&u::DIRECTION), Required, "Axis of the drum, ship axes; any length but zero"),
    key(1082, "winch.radius", Real(&u::LENGTH, Positive), Required, "Radius of the drum's surface; the cable's centreline runs half a diameter further out"),
    key(1083, "winch.angle", Real(&u::ANGLE, Any), real(0.0), "Initial angle of the cable's first node about the axis, from \"up\"").parameter("winch.initial_angle"), // an output is called winch.angle
    key(1084, "winch.gain_position", Real(&u::POSITION_GAIN, NotNegative), Required, "Angular acceleration per angle off the set-point").tunable(),
    key(1085, "winch.gain_rate", Real(&u::RATE_GAIN, NotNegative), Required, "Angular acceleration per rate off the set-point's").tunable(),
    key(1086, "winch.max_rate", Real(&u::ANGULAR_SPEED, Positive), Optional, "Greatest rate of the drum; no limit if left out").tunable(),
    key(1087, "winch.max_acceleration", Real(&u::ANGULAR_ACCELERATION_LIMIT, Positive), Optional, "Greatest angular acceleration of the drum; no limit if left out").tunable(),
    key(1088, "winch.stiffness", Real(&u::CONTACT_STIFFNESS, Positive), Optional, "Contact stiffness of the drum in N/m^(1+exponent); no contact if left out"),
    key(1089, "winch.damping", Real(&u::CONTACT_DAMPING, NotNegative), real(0.0), "Contact damping of the drum (Hunt and Crossley)").when(Given("stiffness")),
    key(1090, "winch.exponent", Real(&u::COEFFICIENT, Inside(0.5, 5.0)), real(1.5), "Exponent of the drum's contact law").when(Given("stiffness")),
    key(1091, "winch.command", Choice(&["angle", "payout"]), text("angle"), "What the set-point is"),
    key(1092, "winch.end", Choice(&["pinned", "tangent"]), text("pinned"), "Slope of the cable's first node: free, or along the drum's tangent"),
    key(1093, "winch.direction", OneOf(&[-1, 1]), Default(Constant::Integer(-1)), "-1: the cable leaves towards negative angles, so that a decreasing angle pays out; 1: the mirror image"),
    key(1094, "winch.setpoint", Choice(&["external", "simplified_sheave", "sheave", "waterline"]), text("external"), "Source of the set-point: an input, or a built-in heave compensation. simplified_sheave pays out what the last sheave (or the drum's top) has moved against the cable's direction at the start, sheave against its present direction; waterline keeps the cable where it met the water at the start. The built-in ones need [ship], waterline [fluid] too"),

    key(1100, "anchor.position", Vector(&u::POSITION), Required, "Where the cable's first end is fixed, ship axes"),

    key(1110, "sheave.name", Text, text(""), "Free text, for messages"),
    key(1111, "sheave.position", Vector(&u::POSITION), Required, "Centre of the sheave, ship axes"),
    key(1112, "sheave.axis", Vector(&u::DIRECTION), Required, "Axis of the sheave, ship axes; any length but zero"),
    key(1113, "sheave.radius", Real(&u::LENGTH, Positive), Required, "Radius to the groove's root"),
    key(1114, "sheave.side", Choice(&["over", "under"]), text("over"), "The way the cable passes it"),
    key(1115, "sheave.groove_angle", Real(&u::OPENING_ANGLE, Inside(0.0, std::f64::consts::PI)), Optional, "Throat angle of the groove; a plain cylinder if left out"),
    key(1116, "sheave.groove_depth", Real(&u::LENGTH, Positive), Optional, "Depth of the groove; unlimited if left out").when(Given("groove_angle")),
    key(1117, "sheave.stiffness", Real(&u::CONTACT_STIFFNESS, Positive), Required, "Contact stiffness in N/m^(1+exponent)"),
    key(1118, "sheave.damping", Real(&u::CONTACT_DAMPING, NotNegative), real(0.0), "Contact damping (Hunt and Crossley)"),
    key(1119, "sheave.exponent", Real(&u::COEFFICIENT, Inside(0.5, 5.0)), real(1.5), "Exponent of the contact law"),
    key(1120, "sheave.friction", Real(&u::COEFFICIENT, NotNegative), real(0.0), "Coulomb friction coefficient"),
    key(1121, "sheave.inertia", Real(&u::INERTIA, Positive), Optional, "Moment of inertia about the axis; the sheave does not turn if left out"),
    key(1122, "sheave.bearing_friction", Real(&u::MOMENT_SIZE, NotNegative), real(0.0), "Friction of the bearing (Coulomb), a moment").when(Given("inertia")),
    key(1123, "sheave.bearing_damping", Real(&u::ROTARY_DAMPING, NotNegative), real(0.0), "Viscous friction of the bearing, moment per angular velocity").when(Given("inertia")),

    key(1130, "body.mass", Real(&u::MASS, Positive), Required, "Mass of the body"),
    key(1131, "body.volume", Real(&u::VOLUME, NotNegative), RequiredWith("fluid"), "Volume of the body"),
    key(1132, "body.drag_area", Real(&u::AREA, NotNegative), RequiredWith("fluid"), "Area that the drag coefficient refers to"),
    key(1133, "body.drag_coefficient", Coefficient, RequiredWith("fluid"), "Drag coefficient; its Reynolds number takes the diameter of a circle of the drag area").tunable(),
    key(1134, "body.added_mass", Real(&u::COEFFICIENT, NotNegative), real(0.5), "Added mass coefficient of the body"),
    key(1135, "body.force_input", Flag, Default(Constant::Flag(false)), "Whether an external force on the body is an input"),

    key(1140, "load.mass", Real(&u::MASS, Positive), Required, "Mass of the load"),
    key(1141, "load.length_inertia", Real(&u::LENGTH, Positive), Required, "Radius of gyration about the attachment"),
    key(1142, "load.length_gravity", Real(&u::LENGTH, Positive), Required, "Distance of the centre of gravity from the attachment"),

    key(1150, "far_end.position", Vector(&u::POSITION), Required, "Where the cable's far end is fixed, inertial frame"),

    key(1160, "initial.state", Choice(&["equilibrium", "released", "straight", "shape"]), text("equilibrium"), "How a run starts"),
    key(1161, "initial.direction", Vector(&u::DIRECTION), Required, "Direction of the cable down the free rope, inertial frame; any length but zero").when(Is("state", &["released", "straight"])),
    key(1162, "initial.file", Text, Required, "CSV with columns s, x, y, z and optionally tx, ty, tz and vx, vy, vz; path relative to the scene file").when(Is("state", &["shape"])),

    key(1170, "solver.method", Choice(&["rodas4", "tr_bdf2", "esdirk3", "esdirk4", "radau5"]), text("rodas4"), "Time integrator: rodas4 (Rosenbrock, a new tangent every sub-step), or implicit with kept factors: tr_bdf2 (order 2, cheap at 1 %), esdirk3, esdirk4; or radau5 (order 5, slow, an independent reference)"),
    key(1171, "solver.tolerance", Real(&u::RATIO, Inside(0.0, 1.0)), real(1e-3), "Relative accuracy asked of the tension").tunable(),
    key(1172, "solver.step_max", Real(&u::DURATION, Positive), real(0.1), "Greatest sub-step"),
    key(1173, "solver.step_min", Real(&u::DURATION, Positive), real(1e-9), "Smallest sub-step, below which a step has failed"),
    key(1174, "solver.steps_max", Integer(1, MAX), Default(Constant::Integer(100_000)), "Greatest number of sub-steps in one communication step"),
    key(1175, "solver.tries_max", Integer(0, MAX), Default(Constant::Integer(0)), "Real time: greatest number of sub-steps tried in one communication step; where they do not suffice for the tolerance the last ones are as long as must be, and status.code is 1. 0: no limit. Needs the method rodas4"),

    key(1180, "outputs.points", Integer(0, 10_000), Default(Constant::Integer(0)), "Number of points of the cable among the outputs, for drawing").structural(),
];

/// What a number of a scene is as a parameter.
#[derive(Clone, Debug)]
pub struct LeafRow {
    /// Value reference.
    pub reference: u32,
    /// [`Of::Real`] or [`Of::Integer`].
    pub of: Of,
    /// Whether it may be changed at communication points.
    pub tunable: bool,
    /// One sentence.
    pub description: String,
}

impl LeafRow {
    /// The physical type of a Real.
    pub fn declared_type(&self) -> Option<&'static Type> {
        match self.of {
            Of::Real(t) => Some(t),
            _ => None,
        }
    }
}

/// The key of that name, given without indices.
pub fn key_named(plain: &str) -> Option<&'static Key> {
    KEYS.iter().find(|k| k.name == plain)
}

/// The row of a number such as `sheave[1].position[3]`, if there is one.
pub fn leaf(name: &str) -> Option<LeafRow> {
    let (plain, indices) = strip(name)?;
    let key = KEYS.iter().find(|k| k.parameter.unwrap_or(k.name) == plain && !k.structural)?;
    let own = &indices[usize::from(key.group().repeated).min(indices.len())..];
    let (of, tunable, detail) = match (key.form, own) {
        (Real(t, _), []) => (Of::Real(t), key.tunable, String::new()),
        (Integer(..) | OneOf(_), []) => (Of::Integer, key.tunable, String::new()),
        (Vector(t), &[axis @ 1..=3]) => (Of::Real(t), key.tunable, format!(", {}", ["x", "y", "z"][axis - 1])),
        (Rows(columns), &[row, column]) => column_row(columns, row, column)?,
        (Coefficient, []) => (Of::Real(&u::COEFFICIENT), key.tunable, String::new()),
        (Coefficient, &[row, column]) => column_row(COEFFICIENT_COLUMNS, row, column)?,
        _ => return None,
    };
    let index = indices.iter().fold(0, |sum, i| 4 * sum + i);
    Some(LeafRow { reference: reference(key.id, index), of, tunable, description: format!("{}{detail}", key.description) })
}

fn column_row(columns: &[Column], row: usize, column: usize) -> Option<(Of, bool, String)> {
    let c = columns.get(column.checked_sub(1)?)?;
    Some((Of::Real(c.of), c.tunable, format!(", row {row}: {}", c.name)))
}
