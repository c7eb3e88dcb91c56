//! The scene of the example and of the tests, drawn without a window.

mod figure;
mod model;
mod picture;
mod set;

use bevy::app::App;
use bevy::asset::UnapprovedPathMode;
#[cfg(test)]
use bevy::camera::Hdr;
use bevy::camera::RenderTarget;
use bevy::core_pipeline::tonemapping::{DebandDither, Tonemapping};
use bevy::prelude::*;
use bevy::render::RenderPlugin;
use bevy::render::gpu_readback::{Readback, ReadbackComplete};
use bevy::render::pipelined_rendering::PipelinedRenderingPlugin;
use bevy::render::render_resource::{PollType, TextureFormat, TextureUsages};
use bevy::render::renderer::RenderDevice;
use bevy::time::TimeUpdateStrategy;
use bevy::window::ExitCondition;
use bevy_umbrage::{UmbrageCamera, UmbrageLight, UmbragePlugin, UmbrageTimes};
pub use picture::Picture;
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

/// Whose shadows lights have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadows {
    Umbrage,
    Bevy,
    None,
}

impl FromStr for Shadows {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        match name {
            "umbrage" => Ok(Self::Umbrage),
            "bevy" => Ok(Self::Bevy),
            "none" => Ok(Self::None),
            _ => Err(format!("`{name}`: shadows are umbrage, bevy or none")),
        }
    }
}

impl fmt::Display for Shadows {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Umbrage => "umbrage",
            Self::Bevy => "bevy",
            Self::None => "none",
        })
    }
}

/// What to draw.
#[derive(Clone, Debug)]
pub struct Wanted {
    pub size: (u32, u32),
    /// A glTF file; `None` for the figure made in code.
    pub model: Option<PathBuf>,
    /// The techniques of umbrage's lights.
    pub sun: String,
    pub lamp: String,
    pub format: TextureFormat,
}

impl Default for Wanted {
    fn default() -> Self {
        let (sun, lamp) = ("cascaded:kernel=disc:radius-m=0.025".into(), "pcss:faces=midpoint".into());
        Self { size: (640, 480), model: None, sun, lamp, format: TextureFormat::Rgba16Float }
    }
}

/// The two lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    Sun,
    Lamp,
}

/// An app that draws into a picture, frame by frame.
pub struct Stage {
    app: App,
    pub size: (u32, u32),
    pub camera: Entity,
    pub sun: Entity,
    pub lamp: Entity,
    picture: Handle<Image>,
    wanted: Wanted,
    arrived: Entity,
}

/// The last picture that came back from the GPU.
#[derive(Component, Default)]
struct Arrived(Vec<u8>);

/// Seconds from one frame to the next, whatever they took.
const STEP: Duration = Duration::from_millis(40);

impl Stage {
    pub fn new(wanted: &Wanted) -> Result<Self> {
        let mut app = App::new();
        let window = WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
        let plugins = DefaultPlugins
            .set(window)
            .set(RenderPlugin { synchronous_pipeline_compilation: true, ..default() })
            .set(AssetPlugin { unapproved_path_mode: UnapprovedPathMode::Allow, ..default() })
            .disable::<PipelinedRenderingPlugin>();
        app.add_plugins((plugins, UmbragePlugin, figure::WalkPlugin));
        app.insert_resource(TimeUpdateStrategy::ManualDuration(STEP));
        app.insert_resource(GlobalAmbientLight { brightness: 60.0, ..default() });
        app.insert_resource(ClearColor(Color::linear_rgb(0.10, 0.13, 0.18)));
        app.finish();
        app.cleanup();
        let world = app.world_mut();
        let mut image = Image::new_target_texture(wanted.size.0, wanted.size.1, wanted.format, None);
        image.texture_descriptor.usage |= TextureUsages::COPY_SRC;
        let picture = world.resource_mut::<Assets<Image>>().add(image);
        let camera = world.spawn((
            UmbrageCamera,
            RenderTarget::Image(picture.clone().into()),
            Tonemapping::None,
            DebandDither::Disabled,
            set::camera(),
        ));
        let camera = camera.id();
        let (sun, lamp) = set::build(world);
        let arrived = world.spawn(Arrived::default()).observe(arrive).id();
        let (size, wanted) = (wanted.size, wanted.clone());
        let mut stage = Self { app, size, camera, sun, lamp, picture, wanted, arrived };
        stage.put_fox()?;
        stage.choose(Shadows::Umbrage);
        Ok(stage)
    }

    pub fn world(&mut self) -> &mut World {
        self.app.world_mut()
    }

    fn put_fox(&mut self) -> Result<()> {
        let Some(path) = self.wanted.model.clone() else {
            figure::spawn(self.world());
            return Ok(());
        };
        let model = model::spawn(self.world(), path.clone());
        // Files arrive when they arrive; nothing is timed before.
        for _ in 0..2000 {
            if self.world().get::<model::Ready>(model).is_some() {
                return Ok(());
            }
            self.frame();
        }
        Err(format!("{} was not loaded", path.display()).into())
    }

    /// One frame, until the GPU is done with it.
    pub fn frame(&mut self) {
        self.app.update();
        let device = self.app.world().resource::<RenderDevice>().wgpu_device().clone();
        device.poll(PollType::wait_indefinitely()).expect("the device answers");
    }

    /// From now on time stands still.
    pub fn freeze(&mut self) {
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO));
    }

    /// So many frames of movement, then time stands still again.
    #[cfg(test)]
    pub fn walk(&mut self, frames: u32) {
        self.app.insert_resource(TimeUpdateStrategy::ManualDuration(STEP));
        (0..frames).for_each(|_| self.frame());
        self.freeze();
    }

    /// Gives both lights shadows of a kind.
    pub fn choose(&mut self, kind: Shadows) {
        let (sun, lamp) = (self.sun, self.lamp);
        for (light, technique) in [(sun, self.wanted.sun.clone()), (lamp, self.wanted.lamp.clone())] {
            let mut light = self.world().entity_mut(light);
            light.remove::<UmbrageLight>();
            if kind == Shadows::Umbrage {
                light.insert(UmbrageLight::parse(&technique).expect("a technique"));
            }
            if let Some(mut sun) = light.get_mut::<DirectionalLight>() {
                sun.shadow_maps_enabled = kind == Shadows::Bevy;
            }
            if let Some(mut lamp) = light.get_mut::<PointLight>() {
                lamp.shadow_maps_enabled = kind == Shadows::Bevy;
            }
        }
    }

    /// Hides all lights but these.
    pub fn light_only(&mut self, lights: &[Source]) {
        for (entity, source) in [(self.sun, Source::Sun), (self.lamp, Source::Lamp)] {
            let visibility = if lights.contains(&source) { Visibility::Inherited } else { Visibility::Hidden };
            self.world().entity_mut(entity).insert(visibility);
        }
    }

    #[cfg(test)]
    /// Without the step through high dynamic range where `is` is false.
    pub fn high_dynamic_range(&mut self, is: bool) {
        let mut camera = self.app.world_mut().entity_mut(self.camera);
        match is {
            true => camera.insert(Hdr),
            false => camera.remove::<Hdr>(),
        };
    }

    /// The present moment with shadows of a kind.
    pub fn picture(&mut self, kind: Shadows) -> Result<Picture> {
        self.choose(kind);
        self.look()
    }

    /// The present moment.
    pub fn look(&mut self) -> Result<Picture> {
        (0..3).for_each(|_| self.frame());
        let (arrived, picture) = (self.arrived, self.picture.clone());
        self.world().entity_mut(arrived).insert((Arrived::default(), Readback::texture(picture)));
        for _ in 0..50 {
            self.frame();
            let mut entity = self.world().entity_mut(arrived);
            let data = entity.get_mut::<Arrived>().map(|mut arrived| std::mem::take(&mut arrived.0));
            if let Some(data) = data.filter(|data| !data.is_empty()) {
                entity.remove::<Readback>();
                return Ok(Picture::new(self.size, self.wanted.format, &data));
            }
        }
        Err("the picture did not come back from the GPU".into())
    }

    /// Milliseconds on the GPU by light and pass, in words.
    pub fn gpu_times(&self) -> String {
        let times = self.app.world().resource::<UmbrageTimes>().latest();
        let of = |t: &umbrage::PassTime| format!("{} {} {:.2} ms", t.owner, t.pass, t.time_ms);
        times.iter().map(of).collect::<Vec<_>>().join(", ")
    }
}

fn arrive(read: On<ReadbackComplete>, mut arrived: Query<&mut Arrived>) {
    if let Ok(mut arrived) = arrived.get_mut(read.entity) {
        arrived.0.clone_from(&read.data);
    }
}
