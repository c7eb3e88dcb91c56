//! What surfaces do with light: their shading normals and what they reflect.

use crate::geometry::Surface;
use crate::tracer::Tracer;
use crate::triangle::Triangle;
use std::borrow::Cow;
use umbrage_core::glam::{DMat3, DVec3, Vec2};
use umbrage_core::{Mesh, Scene, Texture};

/// The surfaces of a scene, by the tracer's numbers of triangles.
pub(super) struct Surfaces<'a> {
    tracer: &'a Tracer,
    /// As the tracer numbers them.
    instances: Vec<Looks<'a>>,
}

struct Looks<'a> {
    mesh: Cow<'a, Mesh>,
    world_from_mesh: DMat3,
    /// Relative to the tracer's centre.
    offset: DVec3,
    /// Turns normals; `None` where the mesh is made flat: a triangle's own is all there is.
    turn: Option<DMat3>,
    base_color: DVec3,
    texture: Option<&'a Texture>,
}

/// A point that reflects light.
#[derive(Clone, Copy)]
pub(super) struct Point {
    /// Relative to the tracer's centre.
    pub position: DVec3,
    /// Of the triangle, unit length.
    pub plane: DVec3,
    /// Shading normal, unit length, on the side that light is sent to.
    pub normal: DVec3,
    /// Share of the light that is reflected.
    pub albedo: DVec3,
    pub triangle: Option<u32>,
}

impl<'a> Surfaces<'a> {
    /// # Errors
    /// A material that reflects more than falls on it, or less than nothing.
    pub fn new(tracer: &'a Tracer, scene: &'a Scene) -> Result<Self, String> {
        let mut instances = Vec::with_capacity(scene.instances.len());
        for instance in scene.instances.iter().filter(|i| i.mesh < scene.meshes.len()) {
            let material = scene.materials.get(instance.material).cloned().unwrap_or_default();
            let base_color = material.base_color.truncate();
            if !base_color.to_array().into_iter().all(|c| (0.0..=1.0).contains(&c)) {
                return Err(format!(
                    "a material of model {} reflects {base_color} of the light; radiance needs base colours from 0 to 1",
                    instance.model
                ));
            }
            let world_from_mesh = instance.world_from_mesh.matrix3;
            let turn = world_from_mesh.inverse().transpose();
            instances.push(Looks {
                mesh: scene.posed_mesh(instance),
                world_from_mesh,
                offset: instance.world_from_mesh.translation - tracer.center,
                turn: turn.is_finite().then_some(turn),
                base_color: base_color.as_dvec3(),
                texture: material.texture.and_then(|t| scene.textures.get(t)).filter(|t| is_whole(t)),
            });
        }
        Ok(Self { tracer, instances })
    }

    /// The point that a pixel shows.
    pub fn seen(&self, surface: &Surface, to_eye: DVec3) -> Point {
        let position = surface.position - self.tracer.center;
        self.point(position, surface.normal, surface.triangle, to_eye)
    }

    /// The point where a ray along `direction` meets a triangle.
    pub fn met(&self, triangle: &Triangle, position: DVec3, direction: DVec3) -> Point {
        self.point(position, triangle.unit_normal(), Some(triangle.id), -direction)
    }

    fn point(&self, position: DVec3, plane: DVec3, triangle: Option<u32>, to_eye: DVec3) -> Point {
        let mut point = Point { position, plane, normal: plane, albedo: DVec3::ONE, triangle };
        let looks = triangle.and_then(|t| {
            let (instance, index) = self.tracer.place_of(t)?;
            Some((self.instances.get(instance)?, index))
        });
        if let Some((looks, index)) = looks {
            let corners = looks.mesh.indices.get(3 * index..3 * index + 3);
            let corners = corners.and_then(|c| Some([*c.first()?, *c.get(1)?, *c.get(2)?]));
            let shares = corners.and_then(|c| looks.shares(c, position));
            point.albedo = looks.albedo(corners.zip(shares));
            let smooth = corners.zip(shares).and_then(|(c, s)| looks.normal(c, s));
            point.normal = smooth.unwrap_or(plane);
        }
        if point.normal.dot(to_eye) < 0.0 {
            point.normal = -point.normal;
        }
        point
    }
}

fn is_whole(texture: &Texture) -> bool {
    let pixels = texture.width as usize * texture.height as usize;
    pixels > 0 && texture.rgba.len() >= pixels
}

impl Looks<'_> {
    /// Barycentric coordinates of a point of a triangle.
    fn shares(&self, corners: [u32; 3], position: DVec3) -> Option<[f64; 3]> {
        let at = |i: u32| Some(self.world_from_mesh * self.mesh.positions.get(i as usize)?.as_dvec3() + self.offset);
        let [a, b, c] = [at(corners[0])?, at(corners[1])?, at(corners[2])?];
        let normal = (b - a).cross(c - a);
        let area = normal.length_squared();
        let u = (c - b).cross(position - b).dot(normal) / area;
        let v = (a - c).cross(position - c).dot(normal) / area;
        (u.is_finite() && v.is_finite()).then_some([u, v, 1.0 - u - v])
    }

    fn normal(&self, corners: [u32; 3], shares: [f64; 3]) -> Option<DVec3> {
        let turn = self.turn?;
        let mut sum = DVec3::ZERO;
        for (corner, share) in corners.into_iter().zip(shares) {
            sum += self.mesh.normals.get(corner as usize)?.as_dvec3() * share;
        }
        // Normals of vertices are made unit length after the turn, too; only directions count.
        (turn * sum).try_normalize()
    }

    fn albedo(&self, place: Option<([u32; 3], [f64; 3])>) -> DVec3 {
        let uv = place.and_then(|(corners, shares)| {
            let mut sum = Vec2::ZERO;
            for (corner, share) in corners.into_iter().zip(shares) {
                sum += *self.mesh.uvs.get(corner as usize)? * share as f32;
            }
            sum.is_finite().then_some(sum)
        });
        match (self.texture, uv) {
            (Some(texture), Some(uv)) => self.base_color * texture.color(uv).as_dvec3(),
            _ => self.base_color,
        }
    }
}
