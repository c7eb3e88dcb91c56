//! A server of static files on this machine, for trying a page: it knows no more than that takes.

use anyhow::{Context, Result};
use std::io::{BufRead, BufReader, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::{Component, Path, PathBuf};
use std::time::Duration;
use std::{fs, io, thread};

/// A request that takes longer is dropped.
const PATIENCE: Duration = Duration::from_secs(10);
/// Longer first lines are no requests of a browser for these files.
const LONGEST_LINE: u64 = 8192;

/// Hands out the files of a folder.
pub struct Server {
    folder: PathBuf,
    listener: TcpListener,
}

impl Server {
    /// Listens to this machine alone; port 0 is any free one.
    pub fn open(folder: &Path, port: u16) -> Result<Self> {
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port))
            .with_context(|| format!("can't listen on port {port}: give another one"))?;
        Ok(Self { folder: folder.to_path_buf(), listener })
    }

    /// Where it listens.
    pub fn port(&self) -> u16 {
        self.listener.local_addr().map_or(0, |address| address.port())
    }

    /// Answers for ever.
    pub fn run(self) {
        for stream in self.listener.incoming().flatten() {
            let folder = self.folder.clone();
            // Who hangs up gets no answer.
            thread::spawn(move || answer(&stream, &folder).ok());
        }
    }
}

fn answer(stream: &TcpStream, folder: &Path) -> io::Result<()> {
    stream.set_read_timeout(Some(PATIENCE))?;
    let mut request = String::new();
    BufReader::new(io::Read::take(stream, LONGEST_LINE)).read_line(&mut request)?;
    let file = asked(&request).map(|path| folder.join(path));
    let found = file.and_then(|file| Some((kind(&file), fs::read(&file).ok()?)));
    let (status, kind, bytes) = match found {
        Some((kind, bytes)) => ("200 OK", kind, bytes),
        None => ("404 Not Found", "text/plain", b"there is no such file".to_vec()),
    };
    let length = bytes.len();
    let mut stream = stream;
    write!(stream, "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {length}\r\n")?;
    write!(stream, "Cache-Control: no-cache\r\nConnection: close\r\n\r\n")?;
    stream.write_all(&bytes)
}

/// The file below the folder that a request is for; `None` where it is for something else.
fn asked(request: &str) -> Option<PathBuf> {
    let path = request.strip_prefix("GET /")?.split([' ', '?', '#']).next()?;
    let path = Path::new(if path.is_empty() { "index.html" } else { path });
    let is_below = path.components().all(|part| matches!(part, Component::Normal(_)));
    is_below.then(|| path.to_path_buf())
}

/// The media type that browsers insist on.
fn kind(file: &Path) -> &'static str {
    match file.extension().and_then(|extension| extension.to_str()) {
        Some("html") => "text/html; charset=utf-8",
        Some("js") => "text/javascript",
        Some("wasm") => "application/wasm",
        Some("css") => "text/css",
        Some("png") => "image/png",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    #[test]
    fn requests_stay_below_the_folder() {
        assert_eq!(asked("GET / HTTP/1.1\r\n"), Some("index.html".into()));
        assert_eq!(asked("GET /learn/pcf.html?a=b HTTP/1.1\r\n"), Some("learn/pcf.html".into()));
        for other in ["GET /../Cargo.toml HTTP/1.1", "GET //etc/passwd HTTP/1.1", "POST / HTTP/1.1", "", "GET"] {
            assert_eq!(asked(other), None, "{other}");
        }
    }

    #[test]
    fn a_file_arrives_as_it_is_and_others_are_missed() {
        let folder = env!("CARGO_MANIFEST_DIR");
        let server = Server::open(Path::new(folder), 0).unwrap();
        let port = server.port();
        thread::spawn(|| server.run());
        let get = |path: &str| {
            let mut stream = TcpStream::connect((Ipv4Addr::LOCALHOST, port)).unwrap();
            write!(stream, "GET /{path} HTTP/1.1\r\n\r\n").unwrap();
            let mut text = String::new();
            stream.read_to_string(&mut text).unwrap();
            text
        };
        let manifest = get("Cargo.toml");
        assert!(manifest.starts_with("HTTP/1.1 200 OK"), "{manifest}");
        assert!(manifest.ends_with(&fs::read_to_string(Path::new(folder).join("Cargo.toml")).unwrap()));
        assert!(get("nothing.html").starts_with("HTTP/1.1 404"));
    }
}
