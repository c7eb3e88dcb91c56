//! Text in and out: encodings of files, and what may be shown on a terminal.

use crate::Error;
use std::borrow::Cow;
use std::path::Path;
use std::string::FromUtf8Error;

/// The text of a file: UTF-8 or UTF-16, with or without its mark, with `\n` after every line.
///
/// # Errors
/// UTF-32, or bytes that are no text in the encoding which their mark names.
pub(crate) fn decode(file: &Path, bytes: Vec<u8>) -> Result<String, Error> {
    decode_or(file, bytes, |e| Err(not_text(file, e.utf8_error())))
}

/// The same for files of a time before UTF-8: what is not UTF-8 is Latin-1, where every byte is a
/// letter, so that names stay apart.
pub(crate) fn decode_old(file: &Path, bytes: Vec<u8>) -> Result<String, Error> {
    decode_or(file, bytes, |e| Ok(e.into_bytes().into_iter().map(char::from).collect()))
}

fn decode_or(
    file: &Path,
    mut bytes: Vec<u8>,
    otherwise: impl FnOnce(FromUtf8Error) -> Result<String, Error>,
) -> Result<String, Error> {
    let text = match bytes.as_slice() {
        [0xff, 0xfe, 0, 0, ..] | [0, 0, 0xfe, 0xff, ..] => return Err(not_text(file, "it seems to be UTF-32")),
        [0xff, 0xfe, rest @ ..] => utf16(file, rest, u16::from_le_bytes)?,
        [0xfe, 0xff, rest @ ..] => utf16(file, rest, u16::from_be_bytes)?,
        // Without a mark, the zero in each letter of a plain alphabet tells.
        [a, 0, b, 0, ..] if *a != 0 && *b != 0 => utf16(file, &bytes, u16::from_le_bytes)?,
        [0, a, 0, b, ..] if *a != 0 && *b != 0 => utf16(file, &bytes, u16::from_be_bytes)?,
        _ => {
            let mark = if bytes.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
            bytes.drain(..mark);
            String::from_utf8(bytes).or_else(otherwise)?
        }
    };
    Ok(with_newlines(text))
}

fn utf16(file: &Path, bytes: &[u8], unit: fn([u8; 2]) -> u16) -> Result<String, Error> {
    let (pairs, rest) = bytes.as_chunks::<2>();
    let text: Result<String, _> = char::decode_utf16(pairs.iter().map(|pair| unit(*pair))).collect();
    match text {
        Ok(text) if rest.is_empty() => Ok(text),
        _ => Err(not_text(file, "it seems to be UTF-16, and is cut off or damaged")),
    }
}

fn not_text(file: &Path, what: impl std::fmt::Display) -> Error {
    Error::new(file, format!("is not UTF-8 text: {what}")).remedy("save it as UTF-8, or name another file")
}

/// Every end of a line as `\n`: those of old systems are a `\r` alone.
fn with_newlines(text: String) -> String {
    if !text.contains('\r') {
        return text;
    }
    text.replace("\r\n", "\n").replace('\r', "\n")
}

/// A text on one line of about `longest` characters at most: control characters, and those that
/// turn the direction of writing, are spelled out, since a terminal would obey them.
pub fn printable(text: &str, longest: usize) -> Cow<'_, str> {
    let is_short = text.len() <= longest || text.chars().nth(longest).is_none();
    if is_short && !text.contains(is_command) {
        return Cow::Borrowed(text);
    }
    let (mut line, mut written) = (String::new(), 0);
    for letter in text.chars() {
        if written >= longest {
            line.push('…');
            break;
        }
        let before = line.len();
        match is_command(letter) {
            true => line.extend(letter.escape_default()),
            false => line.push(letter),
        }
        // What is spelled out takes as many characters as bytes.
        written += if is_command(letter) { line.len() - before } else { 1 };
    }
    Cow::Owned(line)
}

/// True for what a terminal obeys instead of showing it.
fn is_command(letter: char) -> bool {
    letter.is_control() || matches!(letter, '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' | '\u{2028}' | '\u{2029}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_all_encodings_are_the_same() {
        let want = "o Würfel 🎲\nv 1 2 3\n";
        let utf16 = |unit: fn(u16) -> [u8; 2], mark: bool| -> Vec<u8> {
            mark.then_some(0xfeff).into_iter().chain(want.encode_utf16()).flat_map(unit).collect()
        };
        let marked = [b"\xef\xbb\xbf", want.as_bytes()].concat();
        for bytes in [
            want.into(),
            marked,
            want.replace('\n', "\r\n").into_bytes(),
            want.replace('\n', "\r").into_bytes(),
            utf16(u16::to_le_bytes, true),
            utf16(u16::to_be_bytes, true),
            utf16(u16::to_le_bytes, false),
            utf16(u16::to_be_bytes, false),
        ] {
            assert_eq!(decode(Path::new("a.obj"), bytes.clone()).unwrap(), want, "{bytes:?}");
            assert_eq!(decode_old(Path::new("a.obj"), bytes.clone()).unwrap(), want, "{bytes:?}");
        }
    }

    #[test]
    fn other_encodings_are_named_or_latin_1() {
        let latin = b"usemtl gr\xfcn".to_vec();
        assert!(decode(Path::new("a"), latin.clone()).unwrap_err().to_string().contains("UTF-8"));
        assert_eq!(decode_old(Path::new("a"), latin).unwrap(), "usemtl grün");
        for bytes in [&b"\xff\xfea\0b"[..], b"\xff\xfe\0\0a\0\0\0", b"\xfe\xff\xd8\0\0a"] {
            assert!(decode_old(Path::new("a"), bytes.to_vec()).unwrap_err().to_string().contains("UTF-"), "{bytes:?}");
        }
    }

    #[test]
    fn nothing_printable_commands_a_terminal_or_fills_it() {
        assert_eq!(printable("plain ü", 20), "plain ü");
        assert_eq!(printable("a\u{1b}[31m\u{7}\u{202e}\n", 99), "a\\u{1b}[31m\\u{7}\\u{202e}\\n");
        assert_eq!(printable("üüüüü", 3), "üüü…");
        // What is spelled out counts as it is written.
        assert_eq!(printable("\0\0\0\0\0", 8), "\\u{0}\\u{0}…");
    }
}
