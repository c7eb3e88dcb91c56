//! The scene as rays see it.

use crate::bvh::Bvh;
use crate::cutout::{Cutouts, Holes};
use crate::triangle::{Ray, Triangle};
use glam::{DVec3, DVec4};
use umbrage_core::{Bounds, Instance, Scene};

/// Rays end and start this share of the largest coordinate away from light and surface.
///
/// All arithmetic on hits is in double precision and a ray never meets the triangle that it starts
/// on, so this only has to step over a second triangle at the very same place; it shifts no shadow
/// that anybody can see.
pub(crate) const CLEARANCE: f64 = 1e-9;

/// Traces rays through a scene; keeps its own copy of what it needs.
pub struct Tracer {
    /// What all positions inside are relative to, so that a scene far from the origin is as exact
    /// as one at it.
    pub(crate) center: DVec3,
    /// Largest coordinate relative to the centre, metres.
    pub(crate) scale: f64,
    pub(crate) instances: Vec<InstanceFlags>,
    /// Instance of every triangle number.
    instance_of: Vec<u32>,
    /// Which triangle of its mesh each number is.
    index_of: Vec<u32>,
    all: Bvh,
    /// Where some triangles cast no shadow: those that do.
    casters: Option<Bvh>,
    pub(crate) cutouts: Cutouts,
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Number among those of [`Scene::instances`] whose mesh is there.
    pub instance: u32,
    /// Index of the triangle in the instance's mesh.
    pub triangle: u32,
    /// Shares of its corners, which sum to 1.
    pub barycentric: [f64; 3],
    /// True where the ray comes from the side from which its corners go counter-clockwise.
    pub is_front: bool,
}

/// What the tracer knows of an instance.
#[derive(Clone, Copy)]
pub(crate) struct InstanceFlags {
    pub model: i32,
    pub casts: bool,
    pub receives: bool,
}

impl Tracer {
    /// Prepares a scene as its animations stand. Triangles without area, with corners that are not
    /// finite or indices out of range are left out.
    pub fn new(scene: &Scene) -> Self {
        let bounds = scene_bounds(scene);
        let mut tracer = Self {
            center: bounds.center(),
            scale: bounds.size().max_element() * 0.5,
            instances: Vec::new(),
            instance_of: Vec::new(),
            index_of: Vec::new(),
            all: Bvh::new(Vec::new()),
            casters: None,
            cutouts: Cutouts::default(),
        };
        let mut triangles = Vec::new();
        for instance in &scene.instances {
            tracer.add(scene, instance, &mut triangles);
        }
        let casts = |t: &Triangle| tracer.instance(t.id).casts;
        if !triangles.iter().all(casts) {
            tracer.casters = Some(Bvh::new(triangles.iter().filter(|t| casts(t)).cloned().collect()));
        }
        tracer.all = Bvh::new(triangles);
        tracer
    }

    fn add(&mut self, scene: &Scene, instance: &Instance, triangles: &mut Vec<Triangle>) {
        if instance.mesh >= scene.meshes.len() {
            return;
        }
        let mesh = &*scene.posed_mesh(instance);
        let holes = self.cutouts.holes(scene, instance, mesh);
        let number = self.instances.len() as u32;
        let Instance { casts, receives, model, .. } = *instance;
        self.instances.push(InstanceFlags { model: i32::try_from(model).unwrap_or(i32::MAX), casts, receives });
        if matches!(holes, Holes::All) {
            return;
        }
        // The centre is taken off the translation first, where nothing is lost.
        let offset = instance.world_from_mesh.translation - self.center;
        let place =
            |i: u32| mesh.positions.get(i as usize).map(|p| instance.world_from_mesh.matrix3 * p.as_dvec3() + offset);
        for (index, indices) in (0..).zip(mesh.triangles()) {
            let [Some(a), Some(b), Some(c)] = indices.map(place) else { continue };
            let Some(mut triangle) = Triangle::new([a, b, c], self.instance_of.len() as u32, Triangle::OPAQUE) else {
                continue;
            };
            if let Holes::Some(mask) = holes {
                triangle.cutout = self.cutouts.add(mesh, indices, mask);
            }
            self.instance_of.push(number);
            self.index_of.push(index);
            triangles.push(triangle);
        }
    }

    /// Number of triangles that rays can meet.
    pub fn triangle_count(&self) -> usize {
        self.instance_of.len()
    }

    /// True where a casting triangle blocks the straight way from the world point `from` to `to`: a
    /// point with w = 1, or with w = 0 a direction to go without end. Triangles within 10⁻⁹ of the
    /// scene's size of either end do not block; a point that is not finite is never blocked.
    pub fn blocked(&self, from: DVec3, to: DVec4) -> bool {
        let direction = to.truncate() - from * to.w;
        let clear = CLEARANCE * self.scale / direction.length();
        let t_max = if to.w == 0.0 { f64::INFINITY } else { 1.0 - clear };
        let ray = Ray { origin: from - self.center, direction, t_min: clear, t_max };
        self.casting().is_blocked(&ray, None, &self.cutouts)
    }

    /// The first casting triangle on the way from the world point `from` along `direction`; `None`
    /// where there is none. Triangles within 10⁻⁹ of the scene's size do not count, nor does
    /// anything for a way that is not finite.
    pub fn hit(&self, from: DVec3, direction: DVec3) -> Option<Hit> {
        let t_min = CLEARANCE * self.scale / direction.length();
        let ray = Ray { origin: from - self.center, direction, t_min, t_max: f64::INFINITY };
        let (triangle, _) = self.casting().first(&ray, None, &self.cutouts)?;
        Some(Hit {
            instance: self.instance_of[triangle.id as usize],
            triangle: self.index_of[triangle.id as usize],
            barycentric: triangle.seen_from(ray.origin).barycentric(direction),
            is_front: triangle.unit_normal().dot(direction) < 0.0,
        })
    }

    /// The triangles that cast shadows.
    pub(crate) fn casting(&self) -> &Bvh {
        self.casters.as_ref().unwrap_or(&self.all)
    }

    /// The first triangle along the way `origin + t · direction`, t over `t_min`, with its t.
    /// `origin` is relative to the centre.
    pub(crate) fn first(&self, origin: DVec3, direction: DVec3, t_min: f64) -> Option<(&Triangle, f64)> {
        self.all.first(&Ray { origin, direction, t_min, t_max: f64::INFINITY }, None, &self.cutouts)
    }

    /// The instance that a triangle belongs to, among those with a mesh, and its index there.
    pub(crate) fn place_of(&self, triangle: u32) -> Option<(usize, usize)> {
        let at = triangle as usize;
        Some((*self.instance_of.get(at)? as usize, *self.index_of.get(at)? as usize))
    }

    /// The instance that a triangle belongs to.
    pub(crate) fn instance(&self, triangle: u32) -> InstanceFlags {
        self.instances[self.instance_of[triangle as usize] as usize]
    }
}

/// The box around the corners that rays can meet.
fn scene_bounds(scene: &Scene) -> Bounds {
    scene.instances.iter().fold(Bounds::EMPTY, |bounds, instance| {
        if instance.mesh >= scene.meshes.len() {
            return bounds;
        }
        let mesh = scene.posed_mesh(instance);
        let corners = mesh.indices.iter().filter_map(|&i| mesh.positions.get(i as usize));
        bounds.union(Bounds::of(corners.map(|p| p.as_dvec3())).transformed(&instance.world_from_mesh))
    })
}
