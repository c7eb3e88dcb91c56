//! A window with a scene that a camera circles; keys choose the technique that shadows it.
//!
//!     cargo run --release -p umbrage-renderer --example window
//!     cargo run --release -p umbrage-renderer --example window -- --frames 9
//!
//! The second needs no display: it draws frames, each with the next technique, and prints how
//! bright they are.

#[cfg(not(target_family = "wasm"))]
#[path = "window/show.rs"]
pub(crate) mod show;

#[cfg(not(target_family = "wasm"))]
#[path = "window/on_screen.rs"]
mod on_screen;

/// Opens the window, or draws as many frames as `--frames` says.
#[cfg(not(target_family = "wasm"))]
pub fn main() -> show::Result<()> {
    let arguments: Vec<String> = std::env::args().collect();
    match arguments.iter().position(|argument| argument == "--frames") {
        None => on_screen::run(),
        Some(at) => {
            let count = arguments.get(at + 1).and_then(|count| count.parse().ok());
            let count = count.ok_or("--frames takes a number of frames, as in `--frames 9`")?;
            for (technique, brightness) in show::without_window(count, (160, 120))? {
                println!("{technique}: mean brightness {brightness:.3}");
            }
            Ok(())
        }
    }
}

/// Windows of browsers are another program's business.
#[cfg(target_family = "wasm")]
fn main() {}
