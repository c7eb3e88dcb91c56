//! A frame: casters follow the world, then each light's shadows and what it adds.

use crate::convert;
use crate::extract::Changes;
use crate::light::{Lights, UmbrageLightInWorld};
use crate::mirror::Mirror;
use crate::normals::{NormalTarget, Normals};
use crate::shade::{Shade, Textures};
use bevy::core_pipeline::prepass::ViewPrepassTextures;
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::prelude::*;
use bevy::render::camera::{ExtractedCamera, TemporalJitter};
use bevy::render::renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery};
use bevy::render::view::{ExtractedView, ViewTarget};
use std::collections::hash_map::Entry;
use std::collections::{HashMap, HashSet};
use std::sync::{Arc, Mutex, PoisonError};
use umbrage::core::CameraView;
use umbrage::{Answer, Error, Gpu, Owner, PassTime, Receivers, Recorder, Settings, Technique, View, VisibilityTarget};

/// GPU times of umbrage's passes in the newest frame whose times have arrived; empty on devices
/// without timestamps. `Owner::Light` counts the lights with [`crate::UmbrageLight`] in the order
/// of their entities. A resource of both worlds.
#[derive(Resource, Clone, Debug, Default)]
pub struct UmbrageTimes(Arc<Mutex<Vec<PassTime>>>);

impl UmbrageTimes {
    /// Pass by pass.
    pub fn latest(&self) -> Vec<PassTime> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn set(&self, times: Vec<PassTime>) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = times;
    }
}

/// Everything on the GPU. Locked by nobody: what is inside may go to other threads, but not be
/// shared by them.
#[derive(Resource)]
pub struct Host(Mutex<State>);

impl FromWorld for Host {
    fn from_world(world: &mut World) -> Self {
        let device = world.resource::<RenderDevice>().wgpu_device().clone();
        let queue = wgpu::Queue::clone(world.resource::<RenderQueue>());
        let gpu = Gpu::new(device, queue);
        // A new device knows nothing of what the last one was sent.
        world.resource_mut::<Changes>().send_again();
        let (normals, shade) = (Normals::new(&gpu), Shade::new(&gpu));
        let (mirror, troubles) = (None, HashSet::new());
        let (views, techniques) = (HashMap::new(), HashMap::new());
        Self(Mutex::new(State { gpu, normals, shade, mirror, views, techniques, troubles }))
    }
}

struct State {
    gpu: Gpu,
    normals: Normals,
    shade: Shade,
    /// `None` until there is something, and where there can't be.
    mirror: Option<Mirror>,
    views: HashMap<Entity, Seen>,
    techniques: HashMap<(Entity, Entity), Made>,
    troubles: HashSet<String>,
}

/// A camera.
struct Seen {
    recorder: Recorder,
    visibility: VisibilityTarget,
    /// Bevy's textures, of which there may be several in turn.
    textures: Vec<Bound>,
}

struct Bound {
    views: [wgpu::TextureView; 3],
    normals: NormalTarget,
    receivers: Receivers,
    group: wgpu::BindGroup,
}

struct Made {
    settings: Settings,
    technique: Box<dyn Technique>,
}

/// Has casters follow the world.
pub fn prepare(mut host: ResMut<Host>, mut changes: ResMut<Changes>, lights: Res<Lights>) {
    let state = host.0.get_mut().unwrap_or_else(PoisonError::into_inner);
    state.techniques.retain(|(camera, light), _| lights.cameras.contains(camera) && lights.position(*light).is_some());
    state.views.retain(|camera, _| lights.cameras.contains(camera));
    if changes.is_empty() {
        return;
    }
    if state.mirror.is_none() {
        match Mirror::new(&state.gpu) {
            Ok(mirror) => state.mirror = Some(mirror),
            Err(error) => return state.report(format!("umbrage has no casters: {error}")),
        }
    }
    let errors = state.mirror.as_mut().map_or(Vec::new(), |mirror| mirror.follow(changes.take()));
    errors.iter().for_each(|error| state.report(format!("umbrage does not see a change: {error}")));
}

type Of<'a> = (
    &'a ExtractedView,
    &'a ExtractedCamera,
    &'a ViewTarget,
    &'a ViewPrepassTextures,
    Option<&'a TemporalJitter>,
    Option<&'a Tonemapping>,
);

/// Adds the lights that umbrage does to what a camera sees.
pub fn draw(
    view: ViewQuery<Of<'static>>,
    lights: Res<Lights>,
    times: Res<UmbrageTimes>,
    mut host: ResMut<Host>,
    mut context: RenderContext,
) {
    let (seen, camera, target, textures, jitter, tonemapping) = view.into_inner();
    let entity = seen.retained_view_entity.main_entity.id();
    if !lights.cameras.contains(&entity) {
        return;
    }
    if lights.lights.is_empty() {
        return times.set(Vec::new());
    }
    let state = host.0.get_mut().unwrap_or_else(PoisonError::into_inner);
    if camera.physical_viewport_size != camera.physical_target_size {
        return state.report(format!(
            "umbrage lights nothing for camera {entity}, whose viewport is a part of its target: give it a target of \
             its own"
        ));
    }
    if !camera.hdr && tonemapping.is_some_and(|method| *method != Tonemapping::None) {
        state.report(format!(
            "umbrage's light comes after camera {entity} has mapped tones: give it `Hdr`, or `Tonemapping::None`"
        ));
    }
    let picture = Picture { entity, camera: camera_view(seen, textures, jitter), exposure: camera.exposure, target };
    let done = state.draw(&picture, textures, &lights.lights, context.command_encoder());
    match done {
        Ok(passes) => times.set(passes),
        Err(error) => state.report(format!("umbrage lights nothing for camera {entity}: {error}")),
    }
}

/// What a camera draws.
struct Picture<'a> {
    entity: Entity,
    camera: CameraView,
    exposure: f32,
    target: &'a ViewTarget,
}

fn camera_view(seen: &ExtractedView, textures: &ViewPrepassTextures, jitter: Option<&TemporalJitter>) -> CameraView {
    let mut clip_from_view = seen.clip_from_view;
    if let Some(jitter) = jitter {
        let size = Vec2::new(textures.size.width as f32, textures.size.height as f32);
        jitter.jitter_projection(&mut clip_from_view, size);
    }
    let world_from_view = convert::affine(&seen.world_from_view.affine());
    CameraView::from_matrices(world_from_view.inverse(), convert::matrix(&clip_from_view))
}

impl State {
    fn draw(
        &mut self,
        picture: &Picture<'_>,
        textures: &ViewPrepassTextures,
        lights: &[UmbrageLightInWorld],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<Vec<PassTime>, Error> {
        let Self { gpu, normals, shade, mirror, views, techniques, .. } = self;
        let size = (textures.size.width, textures.size.height);
        let seen = match views.entry(picture.entity) {
            Entry::Occupied(old) if old.get().visibility.size == size => old.into_mut(),
            other => {
                let visibility = VisibilityTarget::new(gpu, size.0, size.1)?;
                let new = Seen { recorder: Recorder::new(gpu), visibility, textures: Vec::new() };
                other.insert_entry(new).into_mut()
            }
        };
        let Seen { recorder, visibility, textures: known } = seen;
        let Some(bound) = bound(known, gpu, (normals, shade), visibility, textures)? else { return Ok(Vec::new()) };
        let Some(mirror) = mirror else { return Ok(Vec::new()) };
        let times = recorder.times();
        let mut passes = recorder.begin(encoder);
        passes.owner(Owner::Host("all lights"));
        mirror.record(&mut passes)?;
        normals.record(&mut passes, &picture.camera, &bound.normals);
        let mut troubles = Vec::new();
        for (number, light) in lights.iter().enumerate() {
            passes.owner(Owner::Light(number));
            let view = View {
                camera: picture.camera,
                receivers: &bound.receivers,
                casters: mirror.casters(),
                light: &light.light,
                textures: &[],
            };
            let key = (picture.entity, light.entity);
            let shadows = technique(techniques, gpu, key, &light.technique)
                .and_then(|technique| technique.prepare(gpu, &view)?.record(&mut passes, visibility));
            match shadows {
                Ok(()) => shade.record(
                    (gpu, &mut passes),
                    (&view, &light.emission, picture.exposure),
                    &bound.group,
                    picture.target.get_color_attachment(),
                ),
                Err(error) => troubles.push(format!("umbrage leaves out light {}: {error}", light.entity)),
            }
        }
        passes.finish();
        troubles.into_iter().for_each(|trouble| self.report(trouble));
        Ok(times)
    }

    /// Once for each text: a frame has the same troubles as the last one.
    fn report(&mut self, trouble: String) {
        if !self.troubles.contains(&trouble) {
            error!("{trouble}");
            self.troubles.insert(trouble);
        }
    }
}

/// What reads Bevy's textures of this frame; `None` where the camera has no such prepass.
fn bound<'a>(
    known: &'a mut Vec<Bound>,
    gpu: &Gpu,
    (normals, shade): (&Normals, &Shade),
    visibility: &VisibilityTarget,
    textures: &ViewPrepassTextures,
) -> Result<Option<&'a Bound>, Error> {
    let (Some(depth), Some(deferred), Some(pass)) =
        (textures.depth_only_view(), textures.deferred_view(), &textures.deferred_lighting_pass_id)
    else {
        return Ok(None);
    };
    let views: [wgpu::TextureView; 3] = [depth, deferred, &pass.texture.default_view].map(|view| (**view).clone());
    if let Some(at) = known.iter().position(|bound| bound.views == views) {
        return Ok(Some(&known[at]));
    }
    if known.len() > 3 {
        known.clear();
    }
    let [depth, deferred, pass] = &views;
    let normals = normals.target(gpu, depth, deferred, visibility.size)?;
    let receivers = Receivers::new(gpu, depth, Some(&normals.view), visibility.size)?;
    let group = shade.bind(gpu, &Textures { depth, deferred, pass, visibility: &visibility.view });
    known.push(Bound { views, normals, receivers, group });
    Ok(known.last())
}

/// The technique of a light for a camera, made anew where settings changed that it can't change.
fn technique<'a>(
    techniques: &'a mut HashMap<(Entity, Entity), Made>,
    gpu: &Gpu,
    key: (Entity, Entity),
    settings: &Settings,
) -> Result<&'a mut dyn Technique, Error> {
    if settings.info().answer() == Answer::Radiance {
        let what = "Bevy's surfaces: it shades them itself, by its own model".into();
        return Err(Error::Unsupported { technique: settings.info().id.into(), what });
    }
    if let Some(made) = techniques.get_mut(&key)
        && made.settings != *settings
    {
        if made.settings.differs_live(settings) && made.technique.set(gpu, settings)? {
            made.settings = settings.clone();
        } else {
            techniques.remove(&key);
        }
    }
    let made = match techniques.entry(key) {
        Entry::Occupied(made) => made.into_mut(),
        Entry::Vacant(room) => room.insert(Made { settings: settings.clone(), technique: settings.make(gpu)? }),
    };
    Ok(&mut *made.technique)
}
