//! All casters: meshes, instances and what they look like, in shared buffers, and the trees over
//! what is placed.

use super::batches::Batches;
use super::changed::Changed;
use super::edges::{Edges, MeshEdges};
use super::form::Form;
use super::geometry::{Geometry, MeshPart, Sizes};
use super::host::{Host, refuse};
use super::ids::{Id, Slots};
use super::journal::Journal;
use super::lent::Following;
use super::material::Appearance;
use super::moves::Moves;
use super::placed::{Instance, Placed};
use super::places::Places;
use super::planes::ScenePlanes;
use super::poses::Poses;
use super::region::Region;
use super::store::Store;
use crate::fullscreen::{STORAGE, bind, layout};
use crate::{error::Error, gpu::Gpu};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use umbrage_core::glam::{DVec3, Vec4};
use umbrage_core::{Bounds, Mesh, Scene, scene_tree::SceneTree};

/// Meshes and instances on the GPU: all that casts shadows, and all that shadows fall on (with
/// `casts` off where it casts none), since maps are fitted to that.
///
/// They change by handles: [`Casters::insert`], [`Casters::remove`], [`Casters::add_mesh`] and so
/// on. Changes wait on the CPU until [`Casters::record`] puts them into the host's encoder, once a
/// frame before anything is drawn or prepared. Frames in flight keep what they were recorded with.
///
/// Casters that have changed cast the same shadows, to the bit, as new ones of the same things in
/// the order in which they were added.
pub struct Casters {
    pub(super) gpu: Gpu,
    /// Another one where nothing that was kept of these casters holds any more.
    pub(super) version: u64,
    pub(super) region: Region,
    pub(crate) bind_group: wgpu::BindGroup,
    /// What it binds.
    pub(super) bound: [wgpu::Buffer; 2],
    /// Instances, meshes, materials and textures that came from a scene.
    pub(super) in_scene: [usize; 4],
    pub(super) journal: Journal,
    pub(super) geometry: Geometry,
    pub(super) appearance: Appearance,
    pub(super) instances: Store,
    pub(super) slots: Slots,
    pub(super) batches: Batches,
    /// How buffers lie that have been drawn from; the library's own way apart.
    pub(super) forms: Vec<Form>,
    pub(super) placed: Vec<Placed>,
    /// Instances that came so far.
    pub(super) came: u64,
    /// Places are in the order in which instances came.
    pub(super) in_order: bool,
    pub(super) live: usize,
    /// Places whose instance has to be sent to the GPU.
    pub(super) changed: Changed,
    /// Boxes of the instances that cast shadows, by their place in `placed`.
    pub(super) casting: SceneTree,
    /// Boxes of those that shadows fall on.
    pub(super) receiving: SceneTree,
    /// Where receivers are that are no instances.
    pub(super) receiving_in: Vec<Bounds>,
    /// Boxes of those that do neither.
    pub(super) bystanders: SceneTree,
    /// What the host draws itself.
    pub(super) host: Option<Host>,
    pub(super) moves: Moves,
    /// Places of those that are convex bodies wound outwards.
    pub(super) solid: Places,
    pub(super) poses: Poses,
    /// Lent meshes whose vertices the host moves.
    pub(super) following: Following,
    /// How many cast shadows whose edges nobody knows.
    pub(super) blind: u32,
    /// Edges of meshes whose vertices the host moves were too many for the device.
    pub(super) edges_do_not_fit: bool,
    pub(super) edges: OnceLock<Edges>,
    pub(super) receiver_planes: OnceLock<ScenePlanes>,
}

/// Casters are told apart by these numbers, whoever made them.
static NEXT: AtomicU64 = AtomicU64::new(1);

pub(super) fn next_version() -> u64 {
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl Casters {
    /// Without anything, but with room for a scene.
    pub(super) fn with_room(gpu: &Gpu, scene: &Scene) -> Result<Self, Error> {
        let version = next_version();
        // Handles need no more than to be told apart from those of a few others.
        let of = version as u32;
        let posed = scene.instances.iter().filter(|i| i.pose.is_some()).map(|i| &scene.meshes[i.mesh]);
        let sizes = Sizes {
            vertices: scene.meshes.iter().chain(posed).map(|m| m.positions.len() as u64).sum(),
            indices: scene.meshes.iter().map(|m| m.indices.len() as u64).sum(),
            weights: 0,
        };
        let geometry = Geometry::new(gpu, of, sizes)?;
        let appearance = Appearance::new(gpu, of, scene.materials.len() as u64)?;
        let instances = Store::new(gpu, "instances", size_of::<Instance>() as u64, scene.instances.len() as u64)?;
        let region = Region::of(&Bounds::EMPTY);
        Ok(Self {
            gpu: gpu.clone(),
            version,
            region,
            bind_group: group(gpu, &instances, &appearance),
            bound: [instances.buffer(), appearance.store.buffer()].map(wgpu::Buffer::clone),
            in_scene: [0; 4],
            journal: Journal::default(),
            geometry,
            appearance,
            instances,
            slots: Slots::new("instance", of),
            batches: Batches::default(),
            forms: vec![Form::OWN],
            placed: Vec::new(),
            came: 0,
            in_order: true,
            live: 0,
            changed: Changed::default(),
            casting: region.tree(),
            receiving: region.tree(),
            receiving_in: Vec::new(),
            bystanders: region.tree(),
            host: None,
            moves: Moves::default(),
            solid: Places::default(),
            poses: Poses::default(),
            following: Following::default(),
            blind: 0,
            edges_do_not_fit: false,
            edges: OnceLock::new(),
            receiver_planes: OnceLock::new(),
        })
    }

    /// Layout of the bind group that `casters/casters.wgsl` declares as group 1.
    pub(crate) fn layout(gpu: &Gpu) -> wgpu::BindGroupLayout {
        layout(gpu, "casters", wgpu::ShaderStages::VERTEX_FRAGMENT, &[STORAGE, STORAGE])
    }

    /// What GPU world space is relative to: about the middle of the scene, when that was last
    /// recorded.
    pub fn origin(&self) -> DVec3 {
        self.region.origin
    }

    /// Number of instances, hidden ones among them.
    pub fn len(&self) -> usize {
        self.live
    }

    /// True without instances.
    pub fn is_empty(&self) -> bool {
        self.live == 0
    }

    /// GPU memory held, textures apart. Edges count from when a technique first asks for them.
    pub fn bytes(&self) -> u64 {
        let own = self.geometry.bytes() + self.appearance.store.bytes() + self.instances.bytes();
        own + self.poses.bytes() + self.following.bytes() + self.edges.get().map_or(0, Edges::bytes)
    }

    /// Tells these casters from others, and from what they were before all of them was sent anew.
    pub(crate) fn version(&self) -> u64 {
        self.version
    }

    /// The instances that cast shadows, for queries; its numbers are those of [`Casters::placed`].
    pub(crate) fn casting(&self) -> &SceneTree {
        &self.casting
    }

    /// The instances that shadows fall on, with the same numbers.
    pub(crate) fn receiving(&self) -> &SceneTree {
        &self.receiving
    }

    /// Which casters moved, came or went when.
    pub(crate) fn moves(&self) -> &Moves {
        &self.moves
    }

    /// The instances by place, with places where nothing is among them.
    pub(crate) fn placed(&self) -> &[Placed] {
        &self.placed
    }

    /// Places of instances that cast shadows, in the order in which they came.
    pub(crate) fn casting_places(&self) -> Vec<u32> {
        let casting = (0..).zip(&self.placed).filter(|(_, p)| p.casts);
        let mut places: Vec<u32> = casting.map(|(place, _)| place).collect();
        self.sort(&mut places);
        places
    }

    /// Puts places in the order in which their instances came, which does not depend on what was
    /// there before and has gone.
    pub(crate) fn sort(&self, places: &mut [u32]) {
        if self.in_order {
            places.sort_unstable();
        } else {
            places.sort_unstable_by_key(|place| self.placed[*place as usize].order);
        }
    }

    /// The meshes without their appearance; empty ones where nothing is.
    pub(crate) fn meshes(&self) -> &[MeshPart] {
        &self.geometry.meshes
    }

    /// The positions of all meshes.
    pub(crate) fn positions(&self) -> &wgpu::Buffer {
        self.geometry.positions.buffer()
    }

    /// A mesh as it is posed, computed by the CPU; `None` for meshes without a pose.
    pub(crate) fn posed_mesh(&self, mesh: usize) -> Option<Mesh> {
        self.poses.posed(mesh as u32, self.geometry.meshes.get(mesh)?)
    }

    /// Planes of the triangles of a mesh as it is posed, in the order of its
    /// [`umbrage_core::adjacency::Adjacency`].
    pub(crate) fn planes<'a>(&'a self, mesh: u32, edges: &'a MeshEdges) -> &'a [Vec4] {
        let part = &self.geometry.meshes[mesh as usize];
        self.poses.planes(mesh, part, &edges.adjacency).unwrap_or(&edges.adjacency.planes)
    }

    /// Edges and planes of all meshes, made when first asked for.
    ///
    /// # Errors
    /// [`Error::Size`] where they do not fit the adapter's limits.
    pub(crate) fn edges(&self, gpu: &Gpu) -> Result<&Edges, Error> {
        if self.host.is_some() {
            refuse("their edges are not known")?;
        }
        self.check_known()?;
        self.make_all_edges(gpu)
    }

    /// The edges of what is known.
    pub(super) fn make_all_edges(&self, gpu: &Gpu) -> Result<&Edges, Error> {
        if let Some(edges) = self.edges.get() {
            return Ok(edges);
        }
        let made = Edges::new(gpu, (&self.geometry.meshes, &self.poses), self.bound_by_edges())?;
        Ok(self.edges.get_or_init(|| made))
    }

    /// How the buffers lie that casters are drawn from.
    pub(crate) fn forms(&self) -> &[Form] {
        &self.forms
    }

    /// What edges are bound with.
    pub(super) fn bound_by_edges(&self) -> [&wgpu::Buffer; 3] {
        [self.geometry.positions.buffer(), self.geometry.indices.buffer(), self.instances.buffer()]
    }

    /// Edges and planes where they have been made.
    pub(crate) fn made_edges(&self) -> Option<&Edges> {
        self.edges.get()
    }

    /// Most shadows that one point can be in, whichever casters are drawn.
    pub(crate) fn layers(&self, edges: &Edges) -> u32 {
        let casting = (0..).zip(&self.geometry.meshes).filter(|(_, part)| part.casting > 0);
        let layers = casting.map(|(number, part)| edges.of_mesh(number).layers().saturating_mul(part.casting));
        layers.fold(0, u32::saturating_add)
    }

    /// The planes that shadows fall on, found when first asked for.
    pub(crate) fn receiver_planes(&self) -> &ScenePlanes {
        let Self { region, geometry, placed, solid, .. } = self;
        self.receiver_planes.get_or_init(|| ScenePlanes::new(region, &geometry.meshes, placed, solid))
    }

    /// Handle of what has a place.
    pub(super) fn id_at(&self, place: u32) -> Option<Id> {
        self.slots.at(place)
    }
}

/// What shaders have of casters as group 1.
pub(super) fn group(gpu: &Gpu, instances: &Store, appearance: &Appearance) -> wgpu::BindGroup {
    let buffers = [instances.buffer().as_entire_binding(), appearance.store.buffer().as_entire_binding()];
    bind(gpu, "casters", &Casters::layout(gpu), &buffers)
}
