//! Real spherical harmonics: light and transfer of radiance as a few numbers.
//!
//! `docs/harmonics.md` is the page of conventions, and each has a test here that fails where it is
//! flipped: the functions are orthonormal over the sphere, without the Condon–Shortley phase (the
//! three linear ones are c·y, c·z and c·x with c = √(3 / 4π) > 0), numbered l (l + 1) + m, in the
//! world's own axes with z as the pole. [`Order`] n means n² functions, of the degrees below n.

mod basis;
mod cosine;
mod equirect;
mod light;
mod order;
mod quadrature;
mod rotation;
mod window;

pub use basis::evaluate;
pub use cosine::{clamped_cosine, unshadowed};
pub use equirect::project_equirect;
pub use light::{Light, project};
pub use order::{Order, WrongOrder, index};
pub use quadrature::quadrature;
pub use rotation::Rotation;
pub use window::Window;
