//! How a long run tells where it is.

/// Somebody who watches. Calls come from several threads.
pub trait Progress: Sync {
    /// A stage begins: what it is, and how many steps it has.
    fn begin(&self, what: &str, steps: u64);
    /// So many steps of the stage are done.
    fn at(&self, done: u64);
    /// So many of so many steps are done, where their number was not known at the beginning.
    fn of(&self, done: u64, steps: u64) {
        self.at(u64::from(done == steps));
    }
    /// The stage is over.
    fn end(&self);
    /// Something that a user should know and that ends nothing.
    fn note(&self, _: &str) {}
}

/// Nobody watches.
#[derive(Clone, Copy, Debug)]
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: u64) {}
    fn at(&self, _: u64) {}
    fn end(&self) {}
}
