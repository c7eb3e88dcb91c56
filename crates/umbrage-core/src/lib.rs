//! Pure data and maths of umbrage: no file, no GPU, no clock.
//!
//! # Conventions
//!
//! | thing | convention |
//! |---|---|
//! | handedness, up | right-handed, +Y up |
//! | lengths, angles | metres; degrees where a name ends in `_deg`, else radians |
//! | colours | linear RGB |
//! | matrices | column vectors; `b_from_a` takes a point from space `a` to space `b` |
//! | precision | placement (camera, instances, lights) in `f64`, vertices within a mesh in `f32` |
//! | depth | reversed: 1 at the near plane, 0 at infinity |
//! | winding | counter-clockwise is the front |

pub mod adjacency;
pub mod bounds;
pub mod camera;
pub mod columns;
mod convex;
pub mod coverage;
pub mod environment;
pub mod facets;
mod fnv;
pub mod frustum;
pub mod harmonics;
pub mod image;
pub mod light;
mod light_check;
mod light_reach;
pub mod light_view;
pub mod lit_part;
pub mod material;
pub mod mesh;
pub mod mesh_check;
pub mod precision;
pub mod primitive;
pub mod rig;
pub mod sampling;
pub mod scene;
pub mod scene_tree;
pub mod scenes;
pub mod shadow_hull;
pub mod silhouette;
pub mod solid;
pub mod splits;
pub mod transfer;
mod view_body;
mod volume;
pub mod wedge;
mod weld;

pub use bounds::Bounds;
pub use camera::{Camera, CameraView, Parallel};
pub use environment::{Environment, Sky};
pub use fnv::Fnv;
pub use frustum::Frustum;
pub use image::Image;
pub use light::{Light, LightKind, LightKinds, LightShape};
pub use lit_part::{LitPart, lit_part};
pub use material::{Filter, Material, Sampling, Texture, Wrap};
pub use mesh::Mesh;
pub use rig::Rig;
pub use scene::{Instance, Pose, Scene};
pub use scene_tree::SceneTree;

pub use glam;
