//! The `umbrage` command.
fn main() {}
