//! The scene's triangles in shared buffers, and the tree over what is placed.

use super::check::check;
use super::edges::{self, Edges, MeshEdges};
use super::material;
use super::moves::Moves;
use super::placed::{Batch, CASTS, Instance, Placed, RECEIVES, is_outward, moved_plane, rows};
use super::places::Places;
use super::planes::ScenePlanes;
use super::poses::Poses;
use super::sides::Sides;
use super::vertices::{MeshPart, Vertices};
use crate::fullscreen::{STORAGE, bind, layout};
use crate::{error::Error, gpu::Gpu, passes::Passes};
use std::sync::OnceLock;
use umbrage_core::glam::{DAffine3, DVec3, Vec4};
use umbrage_core::{Bounds, Mesh, Scene, scene_tree::SceneTree, solid::is_convex_solid};

/// Meshes and instances on the GPU: all that casts shadows, and all that shadows fall on (with
/// `casts` off where it casts none), since maps are fitted to that.
pub struct Casters {
    pub(super) origin: DVec3,
    pub(crate) bind_group: wgpu::BindGroup,
    pub(crate) positions: wgpu::Buffer,
    pub(crate) attributes: wgpu::Buffer,
    pub(crate) indices: wgpu::Buffer,
    /// The same with one vertex for all at its place: for draws that need nothing but places.
    pub(super) welded: wgpu::Buffer,
    pub(crate) instances: wgpu::Buffer,
    pub(super) textures: Vec<wgpu::BindGroup>,
    pub(super) batches: Vec<Batch>,
    pub(super) placed: Vec<Placed>,
    /// Where in `placed` each instance is.
    pub(super) place_of: Vec<u32>,
    /// The number of the instance at each place and the batch that it belongs to: what lists need,
    /// packed.
    pub(super) number_of: Vec<u32>,
    pub(super) batch_of: Vec<u32>,
    /// Boxes of the instances that cast shadows, by their place in `placed`.
    pub(super) casting: SceneTree,
    /// Boxes of those that shadows fall on.
    pub(super) receiving: SceneTree,
    /// Where receivers are that are no instances.
    pub(super) receiving_in: Vec<Bounds>,
    /// Places of those that do neither.
    pub(super) bystanders: Vec<u32>,
    pub(super) moves: Moves,
    /// Places of those that are convex bodies wound outwards.
    pub(super) solid: Places,
    /// Without appearance, for what is made of them on demand: those of the scene, then one for
    /// each posed instance.
    pub(super) meshes: Vec<MeshPart>,
    pub(super) poses: Poses,
    pub(super) edges: OnceLock<Edges>,
    pub(super) receiver_planes: OnceLock<ScenePlanes>,
    pub(super) bytes: u64,
}

impl Casters {
    /// Uploads a scene's meshes, instances, materials and textures.
    ///
    /// # Errors
    /// [`Error::Size`] beyond the adapter's limits; [`Error::Scene`] for an index that leads
    /// nowhere.
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, Error> {
        check(gpu, scene)?;
        let origin = scene.bounds().center();
        let mut vertices = Vertices::default();
        let (mut ranges, mut meshes) = (Vec::new(), Vec::new());
        for mesh in &scene.meshes {
            let part = vertices.add(mesh);
            ranges.push((part.indices(), part.base_vertex as i32, mesh.bounds(), mesh.plane(), is_convex_solid(mesh)));
            meshes.push(part);
        }
        let mut poses = Poses::new(scene);
        for (mesh, posed) in poses.meshes(scene) {
            let source = &meshes[mesh];
            let part = MeshPart { base_vertex: vertices.pose(&posed), mesh: source.mesh.clone(), ..*source };
            ranges.push((part.indices(), part.base_vertex as i32, poses.bounds(meshes.len()), None, false));
            meshes.push(part);
        }
        let mut order: Vec<usize> = (0..scene.instances.len()).collect();
        let key = |i: usize| {
            let instance = &scene.instances[i];
            let material = &scene.materials[instance.material];
            (material.alpha_cutoff.is_some(), material.texture, poses.mesh_of(i).unwrap_or(instance.mesh))
        };
        order.sort_by_key(|&i| key(i));
        let mut placed: Vec<Placed> = Vec::with_capacity(order.len());
        let mut batches: Vec<Batch> = Vec::new();
        let mut last = None;
        for &i in &order {
            let instance = &scene.instances[i];
            let (masked, texture, mesh) = key(i);
            let (range, base_vertex, bounds, plane, solid) = ranges[mesh].clone();
            if last != Some((masked, texture, mesh)) {
                last = Some((masked, texture, mesh));
                batches.push(Batch {
                    indices: range,
                    base_vertex,
                    texture: texture.map_or(0, |t| t + 1),
                    masked,
                    flat: plane.is_some(),
                    solid: solid && !masked,
                    members: placed.len()..placed.len(),
                });
            }
            placed.push(Placed {
                number: i as u32,
                mesh: mesh as u32,
                posed: mesh >= scene.meshes.len(),
                world_from_mesh: instance.world_from_mesh,
                sides: Sides::of(&instance.world_from_mesh),
                masked,
                mesh_bounds: bounds,
                bounds: bounds.transformed(&instance.world_from_mesh),
                mesh_plane: plane,
                plane: plane.map(|p| moved_plane(p, &instance.world_from_mesh)),
                casts: instance.casts,
                receives: instance.receives,
                data: Instance {
                    material: instance.material as u32,
                    flags: u32::from(instance.receives) * RECEIVES + u32::from(instance.casts) * CASTS,
                    model: instance.model as u32,
                    ..rows(&instance.world_from_mesh, origin)
                },
            });
            if let Some(batch) = batches.last_mut() {
                batch.members.end = placed.len();
            }
        }
        let mut data = vec![Instance::default(); placed.len()];
        placed.iter().for_each(|p| data[p.number as usize] = p.data);

        use wgpu::BufferUsages as Usage;
        let Vertices { positions, attributes, indices, welded } = vertices;
        let of_vertices = Usage::VERTEX | Usage::STORAGE | Usage::COPY_SRC;
        let positions = gpu.buffer("positions", &positions, of_vertices);
        let attributes = gpu.buffer("normals and texture coordinates", &attributes, of_vertices);
        let indices = gpu.buffer("indices", &indices, Usage::INDEX | Usage::STORAGE);
        let welded = gpu.buffer("welded indices", &welded, Usage::INDEX);
        poses.prepare(gpu, scene, &meshes, [&positions, &attributes])?;
        let instances = gpu.buffer("instances", &data, Usage::STORAGE | Usage::COPY_DST);
        let materials = gpu.buffer("materials", &material::all(scene), Usage::STORAGE);
        let bytes = [&positions, &attributes, &indices, &welded, &instances, &materials].iter().map(|b| b.size()).sum();
        let buffers = [instances.as_entire_binding(), materials.as_entire_binding()];
        let bind_group = bind(gpu, "casters", &Self::layout(gpu), &buffers);
        let textures = material::textures(gpu, scene)?;
        let mut place_of = vec![0; placed.len()];
        let (mut casting, mut receiving) = (SceneTree::new(scene.bounds()), SceneTree::new(scene.bounds()));
        let mut bystanders = Vec::new();
        let mut solid = Places::default();
        solid.clear(placed.len());
        for batch in batches.iter().filter(|b| b.solid) {
            let outward = batch.members.clone().filter(|place| is_outward(&placed[*place].world_from_mesh));
            outward.for_each(|place| solid.set(place as u32, true));
        }
        for (place, p) in (0..).zip(&placed) {
            place_of[p.number as usize] = place;
            if p.casts {
                casting.insert(place, p.bounds);
            }
            if p.receives {
                receiving.insert(place, p.bounds);
            }
            if !p.casts && !p.receives {
                bystanders.push(place);
            }
        }
        [&mut casting, &mut receiving].into_iter().for_each(SceneTree::put_in_order);
        Ok(Self {
            origin,
            bind_group,
            positions,
            attributes,
            indices,
            welded,
            instances,
            textures,
            moves: Moves::new(placed.len()),
            solid,
            number_of: placed.iter().map(|p| p.number).collect(),
            batch_of: (0..).zip(&batches).flat_map(|(i, b): (u32, &Batch)| b.members.clone().map(move |_| i)).collect(),
            batches,
            placed,
            place_of,
            casting,
            receiving,
            receiving_in: Vec::new(),
            bystanders,
            meshes,
            poses,
            edges: OnceLock::new(),
            receiver_planes: OnceLock::new(),
            bytes,
        })
    }

    /// Layout of the bind group that `casters/casters.wgsl` declares as group 1.
    pub(crate) fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        layout(gpu, "casters", wgpu::ShaderStages::VERTEX_FRAGMENT, &[STORAGE, STORAGE])
    }

    /// Moves an instance (by its place in [`Scene::instances`]); one small upload, nothing is
    /// rebuilt. A number that is not in the scene changes nothing, nor does a place that the
    /// instance has already: whoever has not moved lately is at rest, and maps of those at rest are
    /// kept.
    pub fn move_instance(&mut self, gpu: &Gpu, instance: usize, world_from_mesh: &DAffine3) {
        let Some(&place) = self.place_of.get(instance) else { return };
        let placed = &mut self.placed[place as usize];
        if placed.world_from_mesh == *world_from_mesh {
            return;
        }
        placed.world_from_mesh = *world_from_mesh;
        placed.sides = Sides::of(world_from_mesh);
        placed.bounds = placed.mesh_bounds.transformed(world_from_mesh);
        placed.plane = placed.mesh_plane.map(|p| moved_plane(p, world_from_mesh));
        let batch = &self.batches[self.batch_of[place as usize] as usize];
        self.solid.set(place, batch.solid && is_outward(world_from_mesh));
        let Instance { row0, row1, row2, .. } = rows(world_from_mesh, self.origin);
        placed.data = Instance { row0, row1, row2, ..placed.data };
        let at = instance as u64 * size_of::<Instance>() as u64;
        gpu.queue.write_buffer(&self.instances, at, bytemuck::bytes_of(&placed.data));
        self.note_moved(place);
    }

    /// Bends an instance that has a [`umbrage_core::Pose`] (by its place in [`Scene::instances`]):
    /// `joints` are what each of its joints does to the mesh as it was bound, see
    /// [`umbrage_core::Rig::joints_at`]; a missing one does nothing. Costs a box a joint; vertices
    /// follow on the GPU, see [`Casters::record_poses`]. Instances without a pose do not bend, and
    /// a matrix that is not finite changes nothing, nor does the pose that it has already.
    pub fn set_pose(&mut self, instance: usize, joints: &[DAffine3]) {
        let (Some(mesh), Some(&place)) = (self.poses.mesh_of(instance), self.place_of.get(instance)) else { return };
        if !self.poses.set(mesh, joints) {
            return;
        }
        let placed = &mut self.placed[place as usize];
        placed.mesh_bounds = self.poses.bounds(mesh);
        placed.bounds = placed.mesh_bounds.transformed(&placed.world_from_mesh);
        self.note_moved(place);
    }

    /// Moves the vertices of all instances that [`Casters::set_pose`] bent since the last time,
    /// once for everybody who draws them: to be called before the G-buffer is drawn and before
    /// techniques are recorded.
    pub fn record_poses(&mut self, passes: &mut Passes<'_>) {
        let lost: Vec<_> = self.poses.heal().filter_map(|i| self.place_of.get(i).copied()).collect();
        lost.into_iter().for_each(|place| self.note_moved(place));
        let edges = self.edges.get();
        let planes = edges.and_then(|edges| edges.pose.as_ref());
        self.poses.record(passes, planes, |mesh| edges.map(|edges| edges.of_mesh(mesh).planes()));
    }

    /// After the box of the instance at this place, or what is in it, has changed.
    pub(crate) fn note_moved(&mut self, place: u32) {
        let placed = &self.placed[place as usize];
        if placed.casts {
            self.casting.update(place, placed.bounds);
            self.moves.push(place);
        }
        if placed.receives {
            self.receiving.update(place, placed.bounds);
            if let Some(planes) = self.receiver_planes.get_mut() {
                planes.update(place, placed, self.solid.has(place));
            }
        }
    }

    /// What GPU world space is relative to: the middle of the scene when it was uploaded.
    pub fn origin(&self) -> DVec3 {
        self.origin
    }

    /// Number of instances.
    pub fn len(&self) -> usize {
        self.placed.len()
    }

    /// True without instances.
    pub fn is_empty(&self) -> bool {
        self.placed.is_empty()
    }

    /// GPU memory held, textures apart. Edges count from when a technique first asks for them.
    pub fn bytes(&self) -> u64 {
        self.bytes + self.poses.bytes() + self.edges.get().map_or(0, Edges::bytes)
    }

    /// Boxes around the instances that cast shadows.
    pub fn casting_bounds(&self) -> impl Iterator<Item = Bounds> + '_ {
        self.placed.iter().filter(|p| p.casts).map(|p| p.bounds)
    }

    /// Says where shadows are asked for besides on the instances: boxes around particles, panes and
    /// fog that a shader of the host's own shades, see [`crate::Inline`]. They take the place of
    /// those given before. Maps cover what the camera sees of them, and then have fewer texels for
    /// the rest. Boxes that are empty or not finite count for nothing.
    pub fn receive_in(&mut self, boxes: &[Bounds]) {
        let is_finite = |b: &&Bounds| b.min.is_finite() && b.max.is_finite() && !b.is_empty();
        self.receiving_in.clear();
        self.receiving_in.extend(boxes.iter().filter(is_finite));
    }

    /// The boxes of [`Casters::receive_in`].
    pub(crate) fn receiving_in(&self) -> &[Bounds] {
        &self.receiving_in
    }

    /// A box around everything that shadows fall on.
    pub(crate) fn receivers_bounds(&self) -> Bounds {
        self.receiving_in.iter().fold(self.receiving.content(), |all, one| all.union(*one))
    }

    /// A box around everything.
    pub(crate) fn all_bounds(&self) -> Bounds {
        let bystanders = self.bystanders.iter().map(|place| self.placed[*place as usize].bounds);
        bystanders.fold(self.casting.content().union(self.receivers_bounds()), Bounds::union)
    }

    /// The instances that cast shadows, for queries; its numbers are those of [`Casters::placed`].
    pub(crate) fn casting(&self) -> &SceneTree {
        &self.casting
    }

    /// The instances that shadows fall on, with the same numbers.
    pub(crate) fn receiving(&self) -> &SceneTree {
        &self.receiving
    }

    /// Which casters moved when.
    pub(crate) fn moves(&self) -> &Moves {
        &self.moves
    }

    /// The instances in the order of the batches.
    pub(crate) fn placed(&self) -> &[Placed] {
        &self.placed
    }

    /// The meshes without their appearance.
    pub(crate) fn meshes(&self) -> &[MeshPart] {
        &self.meshes
    }

    /// A mesh as it is posed, computed by the CPU; `None` for meshes without a pose.
    pub(crate) fn posed_mesh(&self, mesh: usize) -> Option<Mesh> {
        self.poses.posed(mesh)
    }

    /// Planes of the triangles of a mesh as it is posed, in the order of its
    /// [`umbrage_core::adjacency::Adjacency`].
    pub(crate) fn planes<'a>(&'a self, mesh: u32, edges: &'a MeshEdges) -> &'a [Vec4] {
        self.poses.planes(mesh as usize, &edges.adjacency).unwrap_or(&edges.adjacency.planes)
    }

    /// Edges and planes of all meshes, made when first asked for.
    ///
    /// # Errors
    /// [`Error::Size`] where they do not fit the adapter's limits.
    pub(crate) fn edges(&self, gpu: &Gpu) -> Result<&Edges, Error> {
        if let Some(edges) = self.edges.get() {
            return Ok(edges);
        }
        let Self { meshes, poses, placed, positions, indices, instances, .. } = self;
        let source = edges::Source { meshes, poses, placed, positions, indices, instances };
        let made = Edges::new(gpu, &source)?;
        Ok(self.edges.get_or_init(|| made))
    }

    /// Edges and planes where they have been made.
    pub(crate) fn made_edges(&self) -> Option<&Edges> {
        self.edges.get()
    }

    /// The planes that shadows fall on, found when first asked for.
    pub(crate) fn receiver_planes(&self) -> &ScenePlanes {
        self.receiver_planes.get_or_init(|| ScenePlanes::new(self.origin, &self.meshes, &self.placed, &self.solid))
    }

    /// Boxes around the instances that shadows fall on.
    pub fn receiving_bounds(&self) -> impl Iterator<Item = Bounds> + '_ {
        self.placed.iter().filter(|p| p.receives).map(|p| p.bounds)
    }
}
