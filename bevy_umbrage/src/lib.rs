//! Shadows of [umbrage](umbrage) in Bevy: every light may have a technique of its own.
//!
//! A [`UmbrageLight`] beside a `DirectionalLight`, `PointLight` or `SpotLight` takes that light
//! over from Bevy: colour, strength, range, radius and cone stay those of Bevy's component, Bevy
//! itself lights nothing with it any more, and what it gives off is added after Bevy's deferred
//! lighting, shaded as Bevy does and multiplied by the share of it that each pixel sees. A camera
//! with [`UmbrageCamera`] sees that.
//!
//! ```no_run
//! use bevy::prelude::*;
//! use bevy_umbrage::{UmbrageCamera, UmbrageLight, UmbragePlugin};
//! use bevy_umbrage::umbrage::{depth_maps::Kernel, techniques::pcf::Pcf};
//!
//! fn setup(mut commands: Commands) {
//!     commands.spawn(UmbrageCamera);
//!     let soft = Pcf { kernel: Kernel::Square7, ..Default::default() };
//!     commands.spawn((DirectionalLight::default(), UmbrageLight::from(soft)));
//!     let above = Transform::from_xyz(0.0, 3.0, 0.0);
//!     commands.spawn((PointLight::default(), above, UmbrageLight::default()));
//! }
//!
//! fn main() {
//!     App::new().add_plugins((DefaultPlugins, UmbragePlugin)).add_systems(Startup, setup).run();
//! }
//! ```

pub mod convert;
pub mod export;
mod extract;
mod frame;
mod light;
mod mirror;
mod normals;
mod shade;

use bevy::camera::Hdr;
use bevy::core_pipeline::core_3d::main_opaque_pass_3d;
use bevy::core_pipeline::prepass::{DeferredPrepass, DepthPrepass};
use bevy::core_pipeline::schedule::{Core3d, Core3dSystems};
use bevy::pbr::DefaultOpaqueRendererMethod;
use bevy::pbr::deferred::deferred_lighting;
use bevy::prelude::*;
use bevy::render::{ExtractSchedule, GpuResourceAppExt, Render, RenderApp, RenderSystems};
pub use frame::UmbrageTimes;
pub use light::UmbrageLight;
pub use umbrage;

/// Adds umbrage to an app that has Bevy's renderer. Opaque materials become deferred unless they
/// say otherwise: those drawn forward are not lit by a [`UmbrageLight`].
#[derive(Clone, Copy, Debug, Default)]
pub struct UmbragePlugin;

impl Plugin for UmbragePlugin {
    fn build(&self, app: &mut App) {
        app.insert_resource(DefaultOpaqueRendererMethod::deferred());
        app.add_observer(light::give_back);
        let times = UmbrageTimes::default();
        app.insert_resource(times.clone());
        let Some(render_app) = app.get_sub_app_mut(RenderApp) else { return };
        render_app
            .insert_resource(times)
            .init_resource::<extract::Changes>()
            .init_resource::<light::Lights>()
            .init_gpu_resource::<frame::Host>()
            .add_systems(ExtractSchedule, (extract::casters, light::extract))
            .add_systems(
                Render,
                (
                    light::take_over.after(RenderSystems::ExtractCommands).before(RenderSystems::CreateViews),
                    frame::prepare.in_set(RenderSystems::PrepareResources),
                ),
            )
            .add_systems(
                Core3d,
                frame::draw.after(deferred_lighting).before(main_opaque_pass_3d).in_set(Core3dSystems::MainPass),
            );
    }
}

/// A `Camera3d` that sees what lights with [`UmbrageLight`] give off. It needs Bevy's deferred
/// prepass with depth, one sample a pixel, and a picture that tones are mapped of after all light
/// is in it, and brings these with it. The camera shows its whole target, not a viewport in it.
#[derive(Component, Clone, Copy, Debug, Default)]
#[require(Camera3d, DepthPrepass, DeferredPrepass, Hdr, Msaa = Msaa::Off)]
pub struct UmbrageCamera;
