//! Lights of one kind as lights of another.

use umbrage_core::glam::{DMat3, DVec2, DVec3};
use umbrage_core::{LightKind, LightShape};

/// A light of another kind in the same place, as large as before where both have an extent.
pub(crate) fn changed(shape: &LightShape, kind: LightKind, radius: f64) -> LightShape {
    let (away, is_parallel) = (shape.center().truncate(), shape.center().w == 0.0);
    let position = if is_parallel { away * radius * 2.0 } else { away };
    let size = if is_parallel || shape.radius() == 0.0 { radius * 0.04 } else { shape.radius() };
    let direction = match shape {
        LightShape::Spot { direction, .. }
        | LightShape::Directional { direction, .. }
        | LightShape::Disc { direction, .. }
        | LightShape::Rect { direction, .. } => *direction,
        _ => (-position).normalize_or(DVec3::NEG_Y),
    };
    match kind {
        LightKind::Point => LightShape::Point { position },
        LightKind::Spot => LightShape::Spot { position, direction, inner_angle_deg: 25.0, outer_angle_deg: 35.0 },
        LightKind::Directional => LightShape::Directional { direction, angle_deg: 0.0 },
        LightKind::Sun => LightShape::Directional { direction, angle_deg: 2.0 },
        LightKind::Sphere => LightShape::Sphere { position, radius: size },
        LightKind::Ellipsoid => LightShape::Ellipsoid {
            position,
            radii: DVec3::new(size, size * 0.5, size * 0.5),
            rotation: DMat3::IDENTITY,
        },
        LightKind::Disc => LightShape::Disc { position, direction, radius: size },
        LightKind::Rect => {
            let up = direction.any_orthonormal_vector();
            LightShape::Rect { position, direction, up, size: DVec2::splat(size * 1.4), texture: None }
        }
        LightKind::Line => {
            let half = direction.any_orthonormal_vector() * size;
            LightShape::Line { from: position - half, to: position + half }
        }
        // A sky is the scene's own; a light keeps its shape.
        LightKind::Environment => shape.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::Light;

    #[test]
    fn every_kind_becomes_every_other_and_can_shine() {
        for from in LightKind::ALL {
            let start = changed(&LightShape::Point { position: DVec3::new(1.0, 3.0, 2.0) }, from, 5.0);
            for to in LightKind::ALL {
                let light = Light::new(changed(&start, to, 5.0));
                assert_eq!(light.shape.kind(), to);
                assert!(light.usable().is_ok(), "{} to {}", from.name(), to.name());
            }
        }
    }

    #[test]
    fn a_soft_light_keeps_its_size() {
        let sphere = LightShape::Sphere { position: DVec3::Y, radius: 0.3 };
        let LightShape::Disc { radius, .. } = changed(&sphere, LightKind::Disc, 5.0) else { panic!("another kind") };
        assert_eq!(radius, 0.3);
    }
}
