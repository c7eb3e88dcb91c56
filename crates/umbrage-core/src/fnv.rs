//! A hash that is the same on every machine and in every version, for names of what is kept.

use std::fmt::{self, Write};

/// The hash of Fowler, Noll and Vo with 128 bits (FNV-1a).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fnv(u128);

impl Default for Fnv {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Fnv {
    /// Of these bytes alone.
    pub fn of(bytes: &[u8]) -> u128 {
        let mut hash = Self::default();
        hash.add(bytes);
        hash.0
    }

    /// Of all that was added.
    pub fn value(&self) -> u128 {
        self.0
    }

    /// Takes in more bytes.
    pub fn add(&mut self, bytes: &[u8]) {
        const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
        for byte in bytes {
            self.0 = (self.0 ^ u128::from(*byte)).wrapping_mul(PRIME);
        }
    }

    /// Takes in a text, such as the debug text of plain data, which names every number to the last
    /// bit.
    pub fn text(&mut self, text: fmt::Arguments<'_>) {
        // Taking text in can't fail.
        let _ = self.write_fmt(text);
    }
}

impl Write for Fnv {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.add(text.as_bytes());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_hash_is_the_published_one() {
        assert_eq!(Fnv::of(b""), 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d);
        assert_eq!(Fnv::of(b"a"), 0xd228_cb69_6f1a_8caf_7891_2b70_4e4a_8964);
    }
}
