//! Writes every shader of library and renderer, with the modules that it needs, into a folder: for
//! `cargo xtask browser`.

use std::{env, error::Error, fs, path::PathBuf};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = PathBuf::from(env::args_os().nth(1).ok_or("name a folder")?);
    fs::create_dir_all(&folder)?;
    for shader in umbrage::shaders().iter().chain(umbrage_renderer::SHADERS) {
        fs::write(folder.join(format!("{}.wgsl", shader.name)), shader.text()?)?;
    }
    Ok(())
}
