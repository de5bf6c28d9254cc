//! The built-in scenes.

/// A scene file compiled in.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// Its name, which is the FMU's too.
    pub name: &'static str,
    /// The TOML text.
    pub text: &'static str,
}

/// All built-in scenes; the first is what the library simulates without resources.
pub static SCENES: &[BuiltIn] = &[
    BuiltIn { name: "flume", text: include_str!("../scenes/flume.toml") },
    BuiltIn { name: "flume_noise", text: include_str!("../scenes/flume_noise.toml") },
    BuiltIn { name: "pulley_1", text: include_str!("../scenes/pulley_1.toml") },
    BuiltIn { name: "pulley_2", text: include_str!("../scenes/pulley_2.toml") },
    BuiltIn { name: "pulley_3", text: include_str!("../scenes/pulley_3.toml") },
    BuiltIn { name: "moving_pulley", text: include_str!("../scenes/moving_pulley.toml") },
    BuiltIn { name: "overboard", text: include_str!("../scenes/overboard.toml") },
];

/// The built-in scene of that name.
pub fn named(name: &str) -> Option<&'static BuiltIn> {
    SCENES.iter().find(|s| s.name == name)
}
