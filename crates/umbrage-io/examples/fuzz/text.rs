//! Changes to OBJ, MTL and TOML by lines and words.

use crate::dice::Dice;

/// Words that mean something to one of the readers, and numbers at the ends of ranges.
const WORDS: [&str; 64] = [
    "v",
    "vt",
    "vn",
    "f",
    "fo",
    "o",
    "g",
    "s",
    "usemtl",
    "mtllib",
    "newmtl",
    "Kd",
    "Ks",
    "Ke",
    "Ns",
    "d",
    "Tr",
    "map_Kd",
    "map_d",
    "-s",
    "-o",
    "-mm",
    "-clamp",
    "#",
    "\\",
    "\\\n",
    "a.mtl",
    "a.png",
    "a.obj",
    "..",
    "/",
    "//",
    "1/1/1",
    "-1//-1",
    "0",
    "-0",
    "1",
    "-1",
    "4294967295",
    "4294967296",
    "-9223372036854775808",
    "1e15",
    "1.1e15",
    "1e-15",
    "1e-320",
    "1e999",
    "nan",
    "inf",
    "-inf",
    "0x10",
    "true",
    "[",
    "]",
    "[[model]]",
    "[[light]]",
    "[camera]",
    "{}",
    "=",
    "\"sphere\"",
    "'point'",
    "\u{feff}",
    "\u{0}",
    "\u{1b}[31m",
    "ü",
];

/// Marks and ends of lines.
const FORMS: [fn(&str) -> Vec<u8>; 5] = [
    |text| [b"\xef\xbb\xbf", text.as_bytes()].concat(),
    |text| text.replace('\n', "\r").into_bytes(),
    |text| text.replace('\n', "\r\n").into_bytes(),
    |text| [0xfeff].into_iter().chain(text.encode_utf16()).flat_map(u16::to_le_bytes).collect(),
    |text| text.encode_utf16().flat_map(u16::to_be_bytes).collect(),
];

/// Changes a line, a word or a number of a text; seldom its form or its bytes.
pub fn change(dice: &mut Dice, bytes: &[u8]) -> Vec<u8> {
    let Ok(text) = std::str::from_utf8(bytes) else { return crate::binary::change(dice, bytes) };
    match dice.below(30) {
        0 => return crate::binary::change(dice, bytes),
        1 => return dice.choose(&FORMS).map_or(Vec::new(), |form| form(text)),
        _ => {}
    }
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    let at = dice.below(lines.len());
    match dice.below(12) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, lines[at].clone()),
        2 => {
            let other = dice.below(lines.len());
            lines.swap(at, other);
        }
        3 => {
            let times = dice.choose(&[10, 100, 3000]).unwrap_or(10);
            lines.splice(at..at, vec![lines[at].clone(); times]);
        }
        _ => lines[at] = change_line(dice, &lines[at]),
    }
    lines.join("\n").into_bytes()
}

fn change_line(dice: &mut Dice, line: &str) -> String {
    let mut words: Vec<String> = line.split(' ').map(str::to_owned).collect();
    let at = dice.below(words.len());
    match dice.below(8) {
        0 => drop(words.remove(at)),
        1 => words.insert(at, words[at].clone()),
        2 => {
            let times = dice.choose(&[10, 1000, 20_000]).unwrap_or(10);
            words.splice(at..at, vec![words[at].clone(); times]);
        }
        3 => words.insert(at, dice.choose(&WORDS).unwrap_or_default().to_owned()),
        4 | 5 => words[at] = dice.choose(&WORDS).unwrap_or_default().to_owned(),
        _ => words[at] = change_word(dice, &words[at]),
    }
    words.join(" ")
}

/// A number stays one, mostly; what is around it stays.
fn change_word(dice: &mut Dice, word: &str) -> String {
    let kept = |c: char| !(c.is_ascii_digit() || "+-.eE".contains(c));
    let (before, rest) = word.split_at(word.find(|c| !kept(c)).unwrap_or(word.len()));
    let (middle, after) = rest.split_at(rest.find(kept).unwrap_or(rest.len()));
    let changed = match (middle.parse::<i64>(), middle.parse::<f64>()) {
        (Ok(mut whole), _) => {
            dice.change(&mut whole);
            whole.to_string()
        }
        (_, Ok(mut number)) => {
            dice.change(&mut number);
            format!("{number:?}")
        }
        _ => {
            let mut text = word.to_owned();
            dice.change(&mut text);
            return text;
        }
    };
    format!("{before}{changed}{after}")
}
