//! The program on the page; see `cargo xtask web`.

#[cfg(target_family = "wasm")]
fn main() {
    umbrage_viewer::web::run(&umbrage::Registry::default());
}

/// Elsewhere the laboratory is `umbrage view`.
#[cfg(not(target_family = "wasm"))]
fn main() {
    println!("this program is for browsers: `cargo xtask web` makes the page, `umbrage view` opens a window");
}
