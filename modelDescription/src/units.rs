//! Units and physical types: each is written once here and referred to by the tables.

/// Another way to show a unit's values: display value = `factor` × value + 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplayUnit {
    /// Name.
    pub name: &'static str,
    /// Display units per unit.
    pub factor: f64,
}

/// A unit of the model description.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Name.
    pub name: &'static str,
    /// Exponents of the SI base units `kg`, `m`, `s` and of `rad`; all our units are coherent, so factor 1 and offset 0.
    pub base: &'static [(&'static str, i8)],
    /// Ways to show it.
    pub display: &'static [DisplayUnit],
}

const fn unit(name: &'static str, base: &'static [(&'static str, i8)], display: &'static [DisplayUnit]) -> Unit {
    Unit { name, base, display }
}

const fn shown(name: &'static str, factor: f64) -> DisplayUnit {
    DisplayUnit { name, factor }
}

const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// All units.
pub static UNITS: &[Unit] = &[
    unit("m", &[("m", 1)], &[shown("mm", 1e3)]),
    unit("m2", &[("m", 2)], &[shown("mm2", 1e6)]),
    unit("m3", &[("m", 3)], &[shown("l", 1e3)]),
    unit("m4", &[("m", 4)], &[shown("mm4", 1e12)]),
    unit("s", &[("s", 1)], &[shown("ms", 1e3)]),
    unit("1/s", &[("s", -1)], &[]),
    unit("Hz", &[("s", -1)], &[]),
    unit("1/s2", &[("s", -2)], &[]),
    unit("s/m", &[("s", 1), ("m", -1)], &[]),
    unit("m/s", &[("m", 1), ("s", -1)], &[shown("kn", 3600.0 / 1852.0)]),
    unit("m/s2", &[("m", 1), ("s", -2)], &[]),
    unit("rad", &[("rad", 1)], &[shown("deg", DEGREES)]),
    unit("rad/s", &[("rad", 1), ("s", -1)], &[shown("deg/s", DEGREES)]),
    unit("rad/s2", &[("rad", 1), ("s", -2)], &[shown("deg/s2", DEGREES)]),
    unit("kg", &[("kg", 1)], &[shown("t", 1e-3)]),
    unit("kg/m", &[("kg", 1), ("m", -1)], &[shown("g/m", 1e3)]),
    unit("kg/m3", &[("kg", 1), ("m", -3)], &[shown("g/cm3", 1e-3)]),
    unit("kg.m2", &[("kg", 1), ("m", 2)], &[]),
    unit("N", &[("kg", 1), ("m", 1), ("s", -2)], &[shown("kN", 1e-3)]),
    unit("N/m", &[("kg", 1), ("s", -2)], &[shown("kN/m", 1e-3)]),
    unit("N.m", &[("kg", 1), ("m", 2), ("s", -2)], &[shown("kN.m", 1e-3)]),
    unit("N.m2", &[("kg", 1), ("m", 3), ("s", -2)], &[shown("kN.m2", 1e-3)]),
    unit("N.s", &[("kg", 1), ("m", 1), ("s", -1)], &[shown("kN.s", 1e-3)]),
    unit("N.m2.s", &[("kg", 1), ("m", 3), ("s", -1)], &[]),
    unit("N.m.s/rad", &[("kg", 1), ("m", 2), ("s", -1), ("rad", -1)], &[]),
    unit("Pa", &[("kg", 1), ("m", -1), ("s", -2)], &[shown("GPa", 1e-9), shown("bar", 1e-5)]),
    unit("Pa.s", &[("kg", 1), ("m", -1), ("s", -1)], &[shown("mPa.s", 1e3)]),
];

/// A physical type: what a TypeDefinition says, and what a unit alone does not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Type {
    /// Name of the type definition.
    pub name: &'static str,
    /// Physical quantity, after Modelica's names.
    pub quantity: &'static str,
    /// Unit name; `None`: a pure number.
    pub unit: Option<&'static str>,
    /// Display unit that an importer should choose, where the unit itself is not what people read.
    pub display: Option<&'static str>,
    /// Least value that occurs.
    pub min: Option<f64>,
    /// Greatest value that occurs.
    pub max: Option<f64>,
    /// Typical magnitude, where there is one.
    pub nominal: Option<f64>,
}

const fn of(name: &'static str, quantity: &'static str, unit: &'static str) -> Type {
    Type { name, quantity, unit: Some(unit), display: None, min: None, max: None, nominal: None }
}

const fn number(name: &'static str, quantity: &'static str) -> Type {
    Type { name, quantity, unit: None, display: None, min: None, max: None, nominal: None }
}

impl Type {
    const fn display(mut self, unit: &'static str) -> Self {
        self.display = Some(unit);
        self
    }

    const fn not_negative(mut self) -> Self {
        self.min = Some(0.0);
        self
    }

    const fn between(mut self, min: f64, max: f64) -> Self {
        self.min = Some(min);
        self.max = Some(max);
        self
    }

    const fn nominal(mut self, nominal: f64) -> Self {
        self.nominal = Some(nominal);
        self
    }
}

macro_rules! types {
    ($($(#[$doc:meta])* $name:ident = $value:expr;)*) => {
        $($(#[$doc])* pub static $name: Type = $value;)*
        /// All types.
        pub static TYPES: &[&Type] = &[$(&$name),*];
    };
}

types! {
    /// A coordinate.
    POSITION = of("Position", "Position", "m");
    /// A length or distance.
    LENGTH = of("Length", "Length", "m").not_negative();
    /// A length of cable counted from the start.
    PAYOUT = of("Payout", "Length", "m");
    /// An area.
    AREA = of("Area", "Area", "m2").not_negative();
    /// A volume.
    VOLUME = of("Volume", "Volume", "m3").not_negative();
    /// A second moment of area.
    SECOND_MOMENT = of("SecondMomentOfArea", "SecondMomentOfArea", "m4").not_negative();
    /// A duration.
    DURATION = of("Duration", "Time", "s").not_negative();
    /// A frequency.
    FREQUENCY = of("Frequency", "Frequency", "Hz").not_negative();
    /// An angle.
    ANGLE = of("Angle", "Angle", "rad").display("deg").nominal(1.0);
    /// The angle of an arc.
    ARC_ANGLE = of("ArcAngle", "Angle", "rad").display("deg").not_negative().nominal(1.0);
    /// An opening angle.
    OPENING_ANGLE = of("OpeningAngle", "Angle", "rad").display("deg").between(0.0, std::f64::consts::PI).nominal(1.0);
    /// A velocity.
    VELOCITY = of("Velocity", "Velocity", "m/s").nominal(1.0);
    /// An acceleration.
    ACCELERATION = of("Acceleration", "Acceleration", "m/s2").nominal(1.0);
    /// An angular velocity.
    ANGULAR_VELOCITY = of("AngularVelocity", "AngularVelocity", "rad/s").display("deg/s").nominal(1.0);
    /// A greatest angular velocity.
    ANGULAR_SPEED = of("AngularSpeed", "AngularVelocity", "rad/s").display("deg/s").not_negative().nominal(1.0);
    /// An angular acceleration.
    ANGULAR_ACCELERATION = of("AngularAcceleration", "AngularAcceleration", "rad/s2").display("deg/s2").nominal(1.0);
    /// A greatest angular acceleration.
    ANGULAR_ACCELERATION_LIMIT = of("AngularAccelerationLimit", "AngularAcceleration", "rad/s2").display("deg/s2").not_negative();
    /// A mass.
    MASS = of("Mass", "Mass", "kg").not_negative();
    /// Mass per length.
    LINE_MASS = of("LineMass", "LinearMassDensity", "kg/m").not_negative();
    /// Mass per volume.
    DENSITY = of("Density", "Density", "kg/m3").not_negative();
    /// Moment of inertia.
    INERTIA = of("MomentOfInertia", "MomentOfInertia", "kg.m2").not_negative();
    /// A force.
    FORCE = of("Force", "Force", "N");
    /// A contact force, never adhesive.
    CONTACT_FORCE = of("ContactForce", "Force", "N").not_negative();
    /// A moment.
    MOMENT = of("Moment", "Torque", "N.m");
    /// Size of a moment.
    MOMENT_SIZE = of("MomentSize", "Torque", "N.m").not_negative();
    /// Moment per angular velocity.
    ROTARY_DAMPING = of("RotaryDamping", "RotationalDampingConstant", "N.m.s/rad").not_negative();
    /// Contact force per length of cable.
    LINE_LOAD = of("LineLoad", "LinearForceDensity", "N/m").not_negative();
    /// Young's modulus.
    MODULUS = of("YoungsModulus", "YoungsModulus", "Pa").display("GPa").not_negative();
    /// EA.
    AXIAL_STIFFNESS = of("AxialStiffness", "Force", "N").not_negative();
    /// EI.
    BENDING_STIFFNESS = of("BendingStiffness", "BendingStiffness", "N.m2").not_negative();
    /// Axial force per strain rate.
    AXIAL_DAMPING = of("AxialDamping", "AxialDamping", "N.s").not_negative();
    /// Bending moment per curvature rate.
    BENDING_DAMPING = of("BendingDamping", "BendingDamping", "N.m2.s").not_negative();
    /// Dynamic viscosity.
    VISCOSITY = of("DynamicViscosity", "DynamicViscosity", "Pa.s").not_negative();
    /// Acceleration per angle.
    POSITION_GAIN = of("PositionGain", "PositionGain", "1/s2").not_negative();
    /// Acceleration per angular velocity.
    RATE_GAIN = of("RateGain", "RateGain", "1/s").not_negative();
    /// Hunt and Crossley's D.
    CONTACT_DAMPING = of("ContactDamping", "ContactDamping", "s/m").not_negative();
    /// Hunt and Crossley's k; its unit N/m^(1+n) depends on the exponent, so it has none in FMI.
    CONTACT_STIFFNESS = number("ContactStiffness", "ContactStiffness").not_negative();
    /// A coefficient without unit that cannot be negative.
    COEFFICIENT = number("Coefficient", "Coefficient").not_negative();
    /// A component of a direction, of any length.
    DIRECTION = number("Direction", "Direction");
    /// A Reynolds number.
    REYNOLDS = number("ReynoldsNumber", "ReynoldsNumber").not_negative();
    /// A level difference in decibels, which FMI's base units do not know.
    LEVEL = number("Level", "LevelDifference");
    /// A share of something.
    RATIO = number("Ratio", "Ratio");
}

/// The unit of that name.
pub fn unit_named(name: &str) -> Option<&'static Unit> {
    UNITS.iter().find(|u| u.name == name)
}

/// The type of that name.
pub fn type_named(name: &str) -> Option<&'static Type> {
    TYPES.iter().copied().find(|t| t.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn exact_every_type_has_its_unit_and_a_name_of_its_own() {
        let mut names = HashSet::new();
        for t in TYPES {
            assert!(names.insert(t.name), "{} twice", t.name);
            if let Some(u) = t.unit {
                let unit = unit_named(u).unwrap_or_else(|| panic!("{}: no unit {u}", t.name));
                if let Some(d) = t.display {
                    assert!(unit.display.iter().any(|s| s.name == d), "{}: {u} has no display unit {d}", t.name);
                }
            } else {
                assert_eq!(t.display, None, "{}: a display unit needs a unit", t.name);
            }
        }
    }

    #[test]
    fn exact_display_values_are_factor_times_value() {
        let factor = |u: &str, d: &str| unit_named(u).and_then(|u| u.display.iter().find(|s| s.name == d)).map(|d| d.factor).unwrap();
        assert_eq!(factor("N", "kN") * 2500.0, 2.5);
        assert_eq!(factor("m", "mm") * 0.00045, 0.45);
        assert_eq!(factor("kg", "t") * 1500.0, 1.5);
        assert!((factor("rad", "deg") * std::f64::consts::PI - 180.0).abs() < 1e-12);
        assert!((factor("m/s", "kn") * 0.514_444_444_444_444_5 - 1.0).abs() < 1e-12);
    }
}
