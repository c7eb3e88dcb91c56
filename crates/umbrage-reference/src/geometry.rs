//! What every pixel shows.

use crate::tracer::Tracer;
use glam::{DVec2, DVec3, Vec3};
use rayon::prelude::*;
use umbrage_core::{Camera, Image};

/// What every pixel's centre shows.
pub struct Geometry {
    /// Distance of the surface along the view direction, metres; 0 where there is nothing.
    pub depth: Image<f32>,
    /// Unit normal of the triangle, turned to the camera; zero where there is nothing.
    pub normal: Image<Vec3>,
    /// Model of the surface, [`umbrage_core::Instance::model`]; −1 where there is nothing.
    pub model: Image<i32>,
    /// True where the surface receives shadows.
    pub receives: Image<bool>,
    surfaces: Image<Option<Surface>>,
}

/// A point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Where it is in world space, metres; on the triangle to double precision.
    pub position: DVec3,
    /// Unit normal on the side that is looked at.
    pub normal: DVec3,
    /// True where the surface itself casts shadows: it hides light samples below its tangent plane.
    pub casts: bool,
    /// The tracer's number of the triangle, which never hides its own points; `None` where it is
    /// not known.
    pub triangle: Option<u32>,
}

/// One pixel of [`Geometry`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shown {
    /// Distance of the surface along the view direction, metres.
    pub depth: f64,
    /// Model of the surface, [`umbrage_core::Instance::model`].
    pub model: i32,
    /// True where the surface receives shadows.
    pub receives: bool,
    /// Where it is.
    pub surface: Surface,
}

impl Geometry {
    /// Of pixels that all show nothing.
    pub(crate) fn nothing(width: u32, height: u32) -> Self {
        Self {
            depth: Image::filled(width, height, 0.0),
            normal: Image::filled(width, height, Vec3::ZERO),
            model: Image::filled(width, height, -1),
            receives: Image::filled(width, height, false),
            surfaces: Image::filled(width, height, None),
        }
    }

    /// Sets what a pixel shows.
    pub(crate) fn show(&mut self, pixel: usize, shown: &Shown) {
        self.depth.data[pixel] = shown.depth as f32;
        self.normal.data[pixel] = shown.surface.normal.as_vec3();
        self.model.data[pixel] = shown.model;
        self.receives.data[pixel] = shown.receives;
        self.surfaces.data[pixel] = Some(shown.surface);
    }

    /// The surface that pixel (`x`, `y`) shows; `None` where it shows nothing, and outside the
    /// picture.
    pub fn surface(&self, x: u32, y: u32) -> Option<&Surface> {
        self.surfaces.get(x.into(), y.into())?.as_ref()
    }
}

impl Tracer {
    /// Looks through the centres of `width` × `height` pixels. Surfaces nearer than the near plane
    /// are not seen.
    pub fn geometry(&self, camera: &Camera, width: u32, height: u32) -> Geometry {
        self.geometry_where(camera, &Image::filled(width, height, true))
    }

    /// The same, for the pixels of a mask alone; the others show nothing.
    pub fn geometry_where(&self, camera: &Camera, mask: &Image<bool>) -> Geometry {
        let (width, height) = mask.size();
        let rows = (0..height).into_par_iter().flat_map_iter(|y| {
            (0..width).map(move |x| mask[(x, y)].then(|| self.look(camera, (x, y), (width, height))).flatten())
        });
        let shown: Vec<Option<Shown>> = rows.collect();
        Geometry {
            depth: picture(&shown, width, height, |s| s.map_or(0.0, |s| s.depth as f32)),
            normal: picture(&shown, width, height, |s| s.map_or(Vec3::ZERO, |s| s.surface.normal.as_vec3())),
            model: picture(&shown, width, height, |s| s.map_or(-1, |s| s.model)),
            receives: picture(&shown, width, height, |s| s.is_some_and(|s| s.receives)),
            surfaces: picture(&shown, width, height, |s| s.map(|s| s.surface)),
        }
    }

    /// What the centre of a pixel of a picture of this size shows: one ray; `None` where it shows
    /// nothing.
    pub fn look(&self, camera: &Camera, (x, y): (u32, u32), (width, height): (u32, u32)) -> Option<Shown> {
        let pixel = DVec2::new(f64::from(x), f64::from(y)) + 0.5;
        let (start, direction) = (camera.start(pixel, width, height), camera.ray(pixel, width, height));
        let (triangle, depth) = self.first(start - self.center, direction, camera.near)?;
        let instance = self.instance(triangle.id);
        let normal = triangle.unit_normal();
        let surface = Surface {
            position: start + direction * depth,
            normal: if normal.dot(direction) > 0.0 { -normal } else { normal },
            casts: instance.casts,
            triangle: Some(triangle.id),
        };
        Some(Shown { depth, model: instance.model, receives: instance.receives, surface })
    }
}

fn picture<T>(shown: &[Option<Shown>], width: u32, height: u32, f: impl Fn(Option<&Shown>) -> T) -> Image<T> {
    Image { width, height, data: shown.iter().map(|s| f(s.as_ref())).collect() }
}
