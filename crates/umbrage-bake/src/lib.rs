//! Bakes the transfer of radiance of a scene (`umbrage_core::transfer`): what each function of the
//! sky's light makes every point of every surface send out, with shadows and reflections.
//!
//! [`bake`] does it on all cores; [`Cache`] keeps the result by the content of meshes, materials
//! and settings, and continues a bake that was stopped. [`Storage`] keeps vectors in fewer bytes,
//! and [`radiance`] is what they make of a light. What T holds and what it does not (the point's
//! own albedo) is on the page `docs/harmonics.md`.
//!
//! ```
//! use umbrage_bake::{Settings, bake};
//! use umbrage_core::{harmonics, scenes};
//! use std::ops::ControlFlow;
//!
//! let scene = (scenes::find("contact").expect("it is built in").build)(0.05);
//! let settings = Settings { rays: 16, detail: 8.0, ..Settings::default() };
//! let transfer = bake(&scene, &settings, &|_, _| ControlFlow::Continue(()))?;
//! let sky = harmonics::project(settings.order, 0, |_| glam::Vec3::ONE);
//! let mut vector = [0.0; 25];
//! transfer.meshes[0].stored.read(0, &mut vector);
//! // Times the base colour this is what the point sends out.
//! let products = sky.coefficients().iter().zip(vector).map(|(l, t)| l.x * f64::from(t));
//! let radiance: f64 = products.sum();
//! assert!(radiance <= 1.001);
//! # Ok::<(), umbrage_bake::Error>(())
//! ```

mod albedo;
mod cache;
mod error;
mod file;
mod gather;
mod key;
mod radiance;
mod rays;
mod settings;
mod storage;
mod surface;
mod tessellate;
mod wire;
mod work;

pub use cache::{Cache, Kept};
pub use error::Error;
pub use key::Key;
pub use radiance::{cluster_radiance, radiance};
pub use settings::{BakedSides, Settings};
pub use storage::{Loss, Storage, vectors};
pub use tessellate::tessellated;
pub use work::{Watch, bake};
