//! Changes to bytes: of pictures, and of whatever else.

use crate::dice::Dice;

/// Numbers that formats are afraid of.
const EDGES: [u32; 12] = [0, 1, 2, 0x7f, 0x80, 0xff, 0x7fff, 0xffff, 0x1_0000, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff];

/// Changes some bytes, more often near the start, where headers are.
pub fn change(dice: &mut Dice, bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let near = bytes.len().min(400);
    let end = if dice.is_one_in(2) { near } else { bytes.len() };
    if bytes.is_empty() {
        return bytes;
    }
    let at = dice.below(end);
    let length = 1 + dice.below(bytes.len() - at).min(64);
    match dice.below(6) {
        0 => bytes.truncate(at),
        1 => drop(bytes.drain(at..(at + length).min(end.max(at)))),
        2 => {
            let again = bytes[at..(at + length).min(bytes.len())].to_vec();
            bytes.splice(at..at, again);
        }
        3 => {
            let edge = dice.choose(&EDGES).unwrap_or(0);
            let word = if dice.is_one_in(2) { edge.to_le_bytes() } else { edge.to_be_bytes() };
            let width = dice.choose(&[1, 2, 4]).unwrap_or(4);
            for (to, from) in bytes[at..].iter_mut().zip(&word[..width]) {
                *to = *from;
            }
        }
        4 => {
            let mut part = bytes[at..(at + length).min(bytes.len())].to_vec();
            dice.change(&mut part);
            bytes.splice(at..(at + length).min(bytes.len()), part);
        }
        _ => bytes[at] ^= 1 << dice.below(8),
    }
    bytes
}

/// The start of one file and the end of another.
pub fn splice(dice: &mut Dice, bytes: &[u8], other: &[u8]) -> Vec<u8> {
    let from = dice.below(bytes.len());
    let to = dice.below(other.len());
    [&bytes[..from], &other[to..]].concat()
}

/// Changes the contents of a part of a PNG, or which parts there are, and mends the check sums, or
/// nothing behind them would ever be reached.
pub fn change_png(dice: &mut Dice, bytes: &[u8]) -> Vec<u8> {
    const START: usize = 8;
    if dice.is_one_in(10) || bytes.len() < START {
        return change(dice, bytes);
    }
    let mut parts = parts_of_png(&bytes[START..]);
    if parts.is_empty() {
        return change(dice, bytes);
    }
    let at = dice.below(parts.len());
    match dice.below(10) {
        0 => drop(parts.remove(at)),
        1 => parts.insert(at, parts[at].clone()),
        2 => parts.swap(0, at),
        3 => parts[at].0 = *dice.choose(&[b"tRNS", b"PLTE", b"acTL", b"iCCP", b"zTXt", b"IHDR"]).unwrap_or(b"IEND"),
        _ => parts[at].1 = change(dice, &parts[at].1),
    }
    let mut png = bytes[..START].to_vec();
    for (kind, data) in parts {
        png.extend((data.len() as u32).to_be_bytes());
        png.extend(kind);
        png.extend(&data);
        png.extend(crc(kind.iter().chain(&data)).to_be_bytes());
    }
    png
}

fn parts_of_png(mut rest: &[u8]) -> Vec<([u8; 4], Vec<u8>)> {
    let mut parts = Vec::new();
    while let Some((head, after)) = rest.split_first_chunk::<8>() {
        let [a, b, c, d, kind @ ..] = *head;
        let length = u32::from_be_bytes([a, b, c, d]) as usize;
        let Some(data) = after.get(..length) else { break };
        parts.push((kind, data.to_vec()));
        rest = after.get(length + 4..).unwrap_or_default();
    }
    parts
}

/// The check sum of a PNG's parts (W3C, "PNG specification", annex D).
fn crc<'a>(bytes: impl Iterator<Item = &'a u8>) -> u32 {
    !bytes.fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| if crc & 1 == 1 { 0xedb8_8320 ^ (crc >> 1) } else { crc >> 1 })
    })
}
