//! What stands around the fox.

use bevy::asset::RenderAssetUsages;
use bevy::light::{CascadeShadowConfigBuilder, NotShadowCaster, SunDisk};
use bevy::prelude::*;
use bevy::render::render_resource::{Extent3d, TextureDimension, TextureFormat};

/// Where all is seen from.
pub fn camera() -> Transform {
    Transform::from_xyz(2.6, 1.9, 4.3).looking_at(Vec3::new(0.0, 0.55, 0.0), Vec3::Y)
}

const LAMP: Vec3 = Vec3::new(-1.5, 1.7, 1.4);

/// Builds it; the sun and the lamp come back.
pub fn build(world: &mut World) -> (Entity, Entity) {
    let lattice = world.resource_mut::<Assets<Image>>().add(lattice());
    let mut surface = |color: Color, roughness: f32, metallic: f32| {
        let material = StandardMaterial { base_color: color, perceptual_roughness: roughness, metallic, ..default() };
        world.resource_mut::<Assets<StandardMaterial>>().add(material)
    };
    let stone = surface(Color::linear_rgb(0.42, 0.40, 0.37), 0.9, 0.0);
    let red = surface(Color::linear_rgb(0.5, 0.12, 0.08), 0.4, 0.0);
    let brass = surface(Color::linear_rgb(0.8, 0.6, 0.25), 0.35, 1.0);
    let fence = world.resource_mut::<Assets<StandardMaterial>>().add(StandardMaterial {
        base_color: Color::linear_rgb(0.25, 0.35, 0.22),
        base_color_texture: Some(lattice),
        alpha_mode: AlphaMode::Mask(0.5),
        double_sided: true,
        cull_mode: None,
        ..default()
    });
    let glow = world
        .resource_mut::<Assets<StandardMaterial>>()
        .add(StandardMaterial { emissive: LinearRgba::rgb(900.0, 700.0, 400.0), ..default() });
    let mut mesh = |mesh: Mesh| Mesh3d(world.resource_mut::<Assets<Mesh>>().add(mesh));
    let floor = mesh(Plane3d::default().mesh().size(14.0, 14.0).build());
    let column = mesh(Cylinder::new(0.16, 1.8).into());
    let block = mesh(Cuboid::new(0.7, 0.5, 0.7).into());
    let globe = mesh(Sphere::new(0.28).into());
    let panel = mesh(Rectangle::new(1.6, 0.9).into());
    let bulb = mesh(Sphere::new(0.06).into());
    world.spawn((Name::new("floor"), floor, MeshMaterial3d(stone.clone())));
    for (x, z) in [(-1.9, -1.2), (-0.6, -1.9), (1.0, -1.7)] {
        let place = Transform::from_xyz(x, 0.9, z);
        world.spawn((Name::new("column"), column.clone(), MeshMaterial3d(stone.clone()), place));
    }
    let turned = Transform::from_xyz(1.7, 0.25, -0.3).with_rotation(Quat::from_rotation_y(0.5));
    world.spawn((Name::new("block"), block, MeshMaterial3d(red), turned));
    world.spawn((Name::new("globe"), globe, MeshMaterial3d(brass), Transform::from_xyz(1.7, 0.78, -0.3)));
    let turned = Transform::from_xyz(-1.5, 0.45, 0.3).with_rotation(Quat::from_rotation_y(0.9));
    world.spawn((Name::new("lattice"), panel, MeshMaterial3d(fence), turned));
    world.spawn((bulb, MeshMaterial3d(glow), Transform::from_translation(LAMP), NotShadowCaster));
    let cascades = CascadeShadowConfigBuilder { first_cascade_far_bound: 4.0, maximum_distance: 25.0, ..default() };
    let sun = world.spawn((
        DirectionalLight { illuminance: 2600.0, color: Color::linear_rgb(1.0, 0.95, 0.85), ..default() },
        // Four times as wide as the sun of the earth, so that penumbras show.
        SunDisk { angular_size: 0.037, intensity: 1.0 },
        cascades.build(),
        Transform::from_xyz(-1.6, 2.6, -2.6).looking_at(Vec3::ZERO, Vec3::Y),
    ));
    let sun = sun.id();
    let lamp = PointLight {
        intensity: 80_000.0,
        color: Color::linear_rgb(1.0, 0.75, 0.45),
        range: 12.0,
        radius: 0.06,
        ..default()
    };
    let lamp = world.spawn((lamp, Transform::from_translation(LAMP))).id();
    (sun, lamp)
}

/// A picture that is opaque on its bars.
fn lattice() -> Image {
    const SIZE: u32 = 128;
    let is_bar = |v: u32| v % 32 < 9 || v < 12 || v >= SIZE - 12;
    let alpha = |i: u32| if is_bar(i % SIZE) || is_bar(i / SIZE) { 255 } else { 0 };
    let data = (0..SIZE * SIZE).flat_map(|i| [255, 255, 255, alpha(i)]).collect();
    let size = Extent3d { width: SIZE, height: SIZE, depth_or_array_layers: 1 };
    let usage = RenderAssetUsages::default();
    Image::new(size, TextureDimension::D2, data, TextureFormat::Rgba8UnormSrgb, usage)
}
