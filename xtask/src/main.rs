//! fairlead's commands.
fn main() {}
