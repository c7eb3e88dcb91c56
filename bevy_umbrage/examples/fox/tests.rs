//! Pictures of umbrage's shadows in Bevy, against Bevy's own light and against traced rays.

use crate::stage::{Picture, Shadows, Source, Stage, Wanted};
use crate::truth;
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy_umbrage::UmbrageLight;
use std::sync::{Mutex, MutexGuard, PoisonError};

const SIZE: (u32, u32) = (160, 120);

/// Apps of one process share pools of threads; one at a time is enough.
static ONE: Mutex<()> = Mutex::new(());

fn stage(wanted: Wanted) -> (Stage, MutexGuard<'static, ()>) {
    let guard = ONE.lock().unwrap_or_else(PoisonError::into_inner);
    let mut stage = Stage::new(&Wanted { size: SIZE, ..wanted }).expect("a stage");
    stage.frame();
    stage.freeze();
    (stage, guard)
}

fn largest_difference(a: &Picture, b: &Picture) -> f32 {
    let of = |(a, b): (&Vec3, &Vec3)| (*a - *b).abs().max_element() / (0.1 + b.max_element());
    a.pixels.iter().zip(&b.pixels).map(of).fold(0.0, f32::max)
}

/// Both lights as Bevy shades them and as umbrage does, nothing being in their way.
fn check_light(stage: &mut Stage, what: &str) {
    for lights in [&[Source::Sun][..], &[Source::Lamp]] {
        stage.light_only(lights);
        let bevys = stage.picture(Shadows::None).expect("a picture");
        let own = stage.picture(Shadows::Umbrage).expect("a picture");
        let difference = largest_difference(&own, &bevys);
        assert!(difference < 0.01, "{what}, {lights:?}: {difference}");
        stage.light_only(&[]);
        let dark = stage.look().expect("a picture");
        assert!(largest_difference(&dark, &bevys) > 0.5, "{what}, {lights:?} light something");
    }
}

fn unshadowed() -> Wanted {
    Wanted { sun: "none".into(), lamp: "none".into(), ..Wanted::default() }
}

#[test]
fn light_is_shaded_as_bevy_does() {
    let (mut stage, _guard) = stage(unshadowed());
    check_light(&mut stage, "sun and lamp");
    let lamp = stage.lamp;
    let place = Transform::from_xyz(-1.5, 1.9, 1.4).looking_at(Vec3::ZERO, Vec3::Y);
    let spot = SpotLight { intensity: 60_000.0, outer_angle: 0.7, inner_angle: 0.4, range: 9.0, ..default() };
    stage.world().entity_mut(lamp).remove::<PointLight>().insert((spot, place));
    check_light(&mut stage, "sun and spot");
}

#[test]
fn light_is_added_to_pictures_of_eight_bits() {
    let (mut stage, _guard) = stage(Wanted { format: TextureFormat::Rgba8UnormSrgb, ..unshadowed() });
    stage.high_dynamic_range(false);
    let bevys = stage.picture(Shadows::None).expect("a picture");
    let own = stage.picture(Shadows::Umbrage).expect("a picture");
    // Each light is rounded to 8 bits as it is added.
    let difference = largest_difference(&own, &bevys);
    assert!(difference < 0.04, "{difference}");
}

#[test]
fn shadows_follow_the_world() {
    let (mut stage, _guard) = stage(Wanted::default());
    let mut last: Option<Picture> = None;
    for (change, what) in CHANGES {
        change(stage.world());
        let picture = stage.picture(Shadows::Umbrage).expect("a picture");
        let truth = truth::picture(&mut stage, 64).expect("traced rays");
        let error = truth::error(&picture, &truth);
        assert!(error < 0.012, "{what}: {error}");
        if let Some(last) = last.replace(picture) {
            let before = truth::error(&last, &truth);
            assert!(before > 1.5 * error, "{what} changes the picture: {before}, {error}");
        }
    }
    let (lamp, sun) = (stage.lamp, stage.sun);
    let lit = stage.picture(Shadows::None).expect("a picture");
    for light in [lamp, sun] {
        stage.world().entity_mut(light).remove::<UmbrageLight>();
    }
    let given_back = stage.look().expect("a picture");
    assert!(largest_difference(&given_back, &lit) < 0.01, "Bevy lights with what umbrage no longer does");
}

type Change = fn(&mut World);

const CHANGES: [(Change, &str); 9] = [
    (|_| (), "nothing"),
    (move_block, "the block is elsewhere"),
    (|world| _ = named(world, "globe").insert(NotShadowCaster), "the globe casts nothing"),
    (|world| _ = named(world, "globe").remove::<NotShadowCaster>(), "it does again"),
    (swell_globe, "the globe has another mesh"),
    (|world| named(world, "column").despawn(), "a column is gone"),
    (close_lattice, "the lattice lets no light through"),
    (|world| _ = named(world, "fox").insert(Visibility::Hidden), "the fox is hidden"),
    (|world| _ = named(world, "floor").insert(NotShadowReceiver), "nothing falls on the floor"),
];

fn named<'w>(world: &'w mut World, name: &str) -> EntityWorldMut<'w> {
    let mut names = world.query::<(Entity, &Name)>();
    let found = names.iter(world).find(|(_, n)| n.as_str() == name).map(|(entity, _)| entity);
    world.entity_mut(found.expect("the set has one"))
}

fn move_block(world: &mut World) {
    if let Some(mut place) = named(world, "block").get_mut::<Transform>() {
        place.translation = Vec3::new(-0.3, 0.25, 1.5);
    }
}

fn swell_globe(world: &mut World) {
    let mesh = named(world, "globe").get::<Mesh3d>().expect("a mesh").0.clone();
    let mut meshes = world.resource_mut::<Assets<Mesh>>();
    *meshes.get_mut(&mesh).expect("a mesh") = Sphere::new(0.5).into();
}

fn close_lattice(world: &mut World) {
    let material = named(world, "lattice").get::<MeshMaterial3d<StandardMaterial>>().expect("a material").0.clone();
    let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
    materials.get_mut(&material).expect("a material").alpha_mode = AlphaMode::Opaque;
}

#[test]
fn a_walking_figure_has_the_shadow_of_its_moment() {
    let (mut stage, _guard) = stage(Wanted::default());
    let mut pictures = Vec::new();
    for moment in 0..2 {
        let picture = stage.picture(Shadows::Umbrage).expect("a picture");
        let truth = truth::picture(&mut stage, 64).expect("traced rays");
        let error = truth::error(&picture, &truth);
        assert!(error < 0.012, "moment {moment}: {error}");
        pictures.push(truth);
        stage.walk(25);
    }
    let moved = truth::error(&pictures[0], &pictures[1]);
    assert!(moved > 0.03, "the figure walks: {moved}");
}
