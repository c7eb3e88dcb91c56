//! Numbers as bytes, lowest byte first, with a check at the end.

use bytemuck::Pod;
use umbrage_core::Fnv;

/// Bytes of the check.
const CHECK: usize = 16;

/// Collects bytes.
#[derive(Default)]
pub(crate) struct Writer(Vec<u8>);

impl Writer {
    pub fn raw(&mut self, bytes: &[u8]) {
        self.0.extend(bytes);
    }

    pub fn u64(&mut self, value: u64) {
        self.0.extend(value.to_le_bytes());
    }

    pub fn len(&mut self, value: usize) {
        self.u64(value as u64);
    }

    /// A list of 32-bit numbers with its length.
    pub fn words<T: Pod>(&mut self, values: &[T]) {
        let words: &[u32] = bytemuck::cast_slice(values);
        self.len(words.len());
        self.0.reserve(4 * words.len());
        words.iter().for_each(|word| self.0.extend(word.to_le_bytes()));
    }

    /// A list of bytes with its length.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.len(bytes.len());
        self.raw(bytes);
    }

    /// All, with the check over it.
    pub fn finished(mut self) -> Vec<u8> {
        let check = Fnv::of(&self.0);
        self.0.extend(check.to_le_bytes());
        self.0
    }
}

/// Takes bytes apart; `None` wherever there are too few.
pub(crate) struct Reader<'a>(&'a [u8]);

impl<'a> Reader<'a> {
    /// Of bytes whose check is right.
    pub fn new(bytes: &'a [u8]) -> Option<Self> {
        let (content, check) = bytes.split_last_chunk::<CHECK>()?;
        (u128::from_le_bytes(*check) == Fnv::of(content)).then_some(Self(content))
    }

    pub fn raw(&mut self, count: usize) -> Option<&'a [u8]> {
        let (first, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(first)
    }

    pub fn u64(&mut self) -> Option<u64> {
        let bytes: [u8; 8] = self.raw(8)?.try_into().ok()?;
        Some(u64::from_le_bytes(bytes))
    }

    pub fn len(&mut self) -> Option<usize> {
        usize::try_from(self.u64()?).ok()
    }

    /// A list of values of whole 32-bit numbers.
    pub fn words<T: Pod>(&mut self) -> Option<Vec<T>> {
        let count = self.len()?;
        let bytes = self.raw(count.checked_mul(4)?)?;
        let words: Vec<u32> = bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
        bytemuck::try_cast_slice(&words).ok().map(<[T]>::to_vec)
    }

    pub fn bytes(&mut self) -> Option<&'a [u8]> {
        let count = self.len()?;
        self.raw(count)
    }

    /// True where nothing is left.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}
