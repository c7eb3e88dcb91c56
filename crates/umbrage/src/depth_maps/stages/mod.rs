//! What techniques do between drawing their maps and looking them up.

mod bounds;
mod soft;
mod split_fit;
mod stage;
mod taps;

use crate::shader::Shared;
pub(crate) use bounds::BOUNDS_SHADER;
pub(crate) use soft::TapStage;
pub(crate) use split_fit::SPLIT_FIT_SHADER;
pub(super) use split_fit::SplitFitter;
pub use stage::Stage;
pub use taps::Noise;
pub(crate) use taps::{TESTS, Taps};

/// What the host has to agree on with the modules of this folder.
pub(super) const SHARED: [Shared; 2] = [taps::SHARED, bounds::SHARED];
