//! The pieces an atrium is put together from.

use super::super::{kit::*, shapes};
use crate::material::{Sampling, Texture};
use crate::{Mesh, primitive};
use glam::{DVec2, DVec3, Vec2};

/// How finely turned pieces are cut.
#[derive(Clone, Copy)]
pub struct Cut {
    /// Columns around.
    pub around: u32,
    /// Segments of a moulding's arc.
    pub arc: u32,
}

/// A cube as part of a mesh, standing on the height `y`.
fn block(y: f64, width: f64, height: f64) -> Mesh {
    primitive::cube().transformed(&standing(DVec3::Y * y, DVec3::new(width, height, width), 0.0))
}

/// A column from 0 to `height` with plinth, base, swelling shaft, capital and abacus; `r` is the
/// radius of the shaft's foot, metres.
pub fn column(height: f64, r: f64, cut: Cut) -> Mesh {
    let arc = |x: f64, y: f64, radius: f64, from: f64, to: f64| {
        shapes::arc(DVec2::new(x * r, y), radius * r, from, to, cut.arc)
    };
    let top = height - 0.3 * r;
    let mut profile = vec![DVec2::new(0.0, top)];
    profile.extend(arc(0.9, top, 0.4, 0.0, -90.0));
    profile.extend(arc(0.88, top - 0.6 * r, 0.09, 90.0, -90.0));
    let (neck, foot) = (top - 0.8 * r, 1.25 * r);
    let shaft_segments = 4 * cut.arc;
    profile.extend((0..=shaft_segments).map(|i| {
        let t = f64::from(i) / f64::from(shaft_segments);
        DVec2::new(r * (0.84 + 0.16 * (t * std::f64::consts::FRAC_PI_2).sin()), neck + (foot - neck) * t)
    }));
    profile.extend(arc(1.08, 1.05 * r, 0.12, 90.0, -90.0));
    profile.extend(arc(1.25, 0.75 * r, 0.12, 150.0, 210.0));
    profile.extend(arc(1.2, 0.48 * r, 0.18, 90.0, -90.0));
    profile.push(DVec2::new(0.0, 0.3 * r));
    let mut mesh = shapes::lathe("column", cut.around, &profile);
    mesh.append(&block(0.0, 2.8 * r, 0.3 * r));
    mesh.append(&block(top, 2.75 * r, 0.3 * r));
    mesh
}

/// A baluster of height 1 and greatest radius about 0.13, with square ends.
pub fn baluster(cut: Cut) -> Mesh {
    let mut profile = vec![DVec2::new(0.0, 0.9), DVec2::new(0.1, 0.9), DVec2::new(0.1, 0.86)];
    profile.extend(shapes::arc(DVec2::new(0.055, 0.8), 0.025, 90.0, -90.0, cut.arc));
    let belly = 3 * cut.arc;
    profile.extend((0..=belly).map(|i| {
        let t = f64::from(i) / f64::from(belly);
        let swell = (std::f64::consts::PI * t.powf(1.7)).sin();
        DVec2::new(0.05 + 0.075 * swell, 0.74 - 0.5 * t)
    }));
    profile.extend(shapes::arc(DVec2::new(0.065, 0.18), 0.03, 90.0, -90.0, cut.arc));
    profile.extend([DVec2::new(0.11, 0.13), DVec2::new(0.11, 0.1), DVec2::new(0.0, 0.1)]);
    let mut mesh = shapes::lathe("baluster", cut.around, &profile);
    mesh.append(&block(0.0, 0.26, 0.1));
    mesh.append(&block(0.9, 0.26, 0.1));
    mesh
}

/// One bay of an arcade wall above the springing line y = 0: a wall `width` × `height`, `thickness`
/// thick, with a round arch of `radius` cut out, and a raised band around the arch.
pub fn arch(width: f64, height: f64, radius: f64, thickness: f64, arc_segments: u32) -> Mesh {
    // A quarter of the segments goes up either side, half along the top, so that the corners are
    // met.
    let quarter = (arc_segments / 4).max(2);
    let half_circle = |radius| shapes::arc(DVec2::ZERO, radius, 0.0, 180.0, 4 * quarter);
    let corners = [(0.5, 0.0), (0.5, 1.0), (0.0, 1.0), (-0.5, 1.0), (-0.5, 0.0)];
    let corners = corners.map(|(x, y)| DVec2::new(x * width, y * height));
    let mut outer: Vec<DVec2> = corners
        .windows(2)
        .flat_map(|pair| (0..quarter).map(move |i| pair[0].lerp(pair[1], f64::from(i) / f64::from(quarter))))
        .collect();
    outer.push(corners[4]);
    let mut mesh = shapes::between("arch", &half_circle(radius), &outer, thickness);
    mesh.append(&shapes::between("band", &half_circle(radius - 0.03), &half_circle(radius + 0.2), thickness + 0.1));
    mesh
}

/// A leaf of a door 1 wide and 2 high with a round top, in the XY plane.
pub fn door(arc_segments: u32) -> Mesh {
    let mut outline = vec![DVec2::new(-0.5, 0.0), DVec2::new(0.5, 0.0)];
    outline.extend(shapes::arc(DVec2::new(0.0, 1.5), 0.5, 0.0, 180.0, arc_segments));
    shapes::prism("door", &outline, 1.0)
}

/// A basin of radius 2.3 with a shaft that carries a bowl and ends at height 2.3.
pub fn fountain(cut: Cut) -> Mesh {
    let point = DVec2::new;
    let mut profile = vec![point(0.0, 2.3), point(0.16, 2.3)];
    profile.extend(shapes::arc(point(0.12, 2.12), 0.1, 60.0, -70.0, cut.arc));
    // The bowl: its inside down, its rim, and its outside back to the shaft.
    profile.extend(shapes::arc(point(0.0, 2.72), 1.0, -80.0, -36.0, 2 * cut.arc));
    profile.extend([point(0.95, 2.14), point(0.95, 2.05)]);
    profile.extend(shapes::arc(point(0.0, 2.55), 1.05, -32.0, -78.0, 2 * cut.arc));
    profile.extend([point(0.13, 1.4), point(0.22, 0.9), point(0.24, 0.5)]);
    // The water level of the basin, and its wall.
    profile.extend([point(1.95, 0.48), point(1.95, 0.62)]);
    profile.extend(shapes::arc(point(2.12, 0.62), 0.14, 150.0, -60.0, 2 * cut.arc));
    profile.extend([point(2.1, 0.4), point(2.18, 0.12), point(2.35, 0.12), point(2.35, 0.0), point(0.0, 0.0)]);
    shapes::lathe("fountain", cut.around, &profile)
}

/// A pot of radius 0.55 and height 0.7.
pub fn pot(cut: Cut) -> Mesh {
    let mut profile = vec![DVec2::new(0.0, 0.62), DVec2::new(0.46, 0.62), DVec2::new(0.48, 0.7)];
    profile.extend(shapes::arc(DVec2::new(0.5, 0.66), 0.05, 70.0, -70.0, cut.arc));
    profile.extend([DVec2::new(0.48, 0.58), DVec2::new(0.32, 0.06), DVec2::new(0.36, 0.0), DVec2::ZERO]);
    shapes::lathe("pot", cut.around, &profile)
}

/// A clipped cypress of height 3.4 and radius 0.5.
pub fn cypress(cut: Cut) -> Mesh {
    let segments = 6 * cut.arc;
    let profile: Vec<DVec2> = (0..=segments)
        .map(|i| {
            let t = f64::from(i) / f64::from(segments);
            let ends = if i == 0 || i == segments { 0.0 } else { 1.0 };
            let ruffle = 1.0 + 0.06 * f64::from(i % 2);
            DVec2::new(ends * 0.5 * ruffle * (std::f64::consts::PI * t.powf(0.7)).sin().powf(0.75), 3.4 * (1.0 - t))
        })
        .collect();
    shapes::lathe("cypress", cut.around, &profile)
}

/// A floor of 1 × 1 whose texture repeats `repeats` times.
pub fn floor(repeats: Vec2) -> Mesh {
    let mut mesh = primitive::plane();
    mesh.name = "floor".into();
    mesh.uvs.iter_mut().for_each(|uv| *uv *= repeats);
    mesh
}

/// Two by two tiles of pale and dark stone with joints between.
pub fn tiles() -> Texture {
    const SIZE: u32 = 128;
    let mut rng = Rng::new(0x711e);
    let mut texel = |x: u32, y: u32| {
        let half = SIZE / 2;
        let joint = x % half < 2 || y % half < 2;
        let dark = (x / half + y / half) % 2 == 1;
        let base = match (joint, dark) {
            (true, _) => [120.0, 112.0, 102.0],
            (false, true) => [164.0, 132.0, 108.0],
            (false, false) => [222.0, 212.0, 196.0],
        };
        let grain = rng.range(-7.0, 7.0);
        let [r, g, b] = base.map(|c| (c + grain) as u8);
        [r, g, b, 255]
    };
    let rgba = (0..SIZE * SIZE).map(|i| texel(i % SIZE, i / SIZE)).collect();
    Texture { name: "tiles".into(), width: SIZE, height: SIZE, rgba, sampling: Sampling::default() }
}
