//! Casters that change at random, and the scene that they have become.

use umbrage::core::glam::{DAffine3, DVec3, Vec2, Vec3, Vec4};
use umbrage::core::rig::Moment;
use umbrage::core::{Instance, Material, Mesh, Sampling, Scene, Texture, primitive};
use umbrage::{Casters, InstanceId, MaterialId, MeshId, Placement, TextureId};

/// The scene as it is to be, with a handle for everything in it.
pub struct World {
    pub scene: Scene,
    instances: Vec<InstanceId>,
    hidden: Vec<bool>,
    meshes: Vec<MeshId>,
    materials: Vec<MaterialId>,
    textures: Vec<TextureId>,
    /// Of a linear congruential generator.
    state: u64,
    /// The mesh with joints.
    bent: usize,
}

fn picture(shade: u8) -> Texture {
    let rgba = (0..64_u32).map(|i| [shade, 90, 60, if (i ^ (i / 8)) & 2 == 0 { 255 } else { 0 }]).collect();
    Texture { name: "net".into(), width: 8, height: 8, rgba, sampling: Sampling::default() }
}

fn material(texture: Option<usize>, masked: bool, shade: f32) -> Material {
    Material {
        base_color: Vec4::new(shade, 0.5, 0.4, 1.0),
        texture,
        alpha_cutoff: masked.then_some(0.5),
        ..Material::default()
    }
}

/// A floor, boxes, a round thing, a net and tentacles.
pub fn start(mut scene: Scene) -> Scene {
    let bent = scene.meshes.iter().position(|m| !m.weights.is_empty()).expect("a mesh with joints");
    scene.textures.push(picture(200));
    scene.materials.extend([material(Some(0), true, 0.9), material(Some(0), false, 0.2), material(None, false, 0.6)]);
    scene.meshes.extend([primitive::sphere(7, 5), primitive::torus(0.5, 0.2, 7, 5), primitive::cone(6, 1)]);
    let count = scene.meshes.len();
    for i in 0..9_usize {
        let mesh = if i % count == bent { 0 } else { i % count };
        let at = DVec3::new((i as f64 * 1.7).sin() * 2.0, 0.4 + 0.2 * i as f64, (i as f64 * 2.9).cos() * 2.0);
        let size = if mesh == 0 { 0.8 } else { 0.5 };
        let place = DAffine3::from_translation(at) * DAffine3::from_scale(DVec3::splat(size));
        scene.place(mesh, i % scene.materials.len(), place);
    }
    scene
}

impl World {
    pub fn new(scene: Scene, casters: &Casters, seed: u64) -> Self {
        Self {
            instances: (0..scene.instances.len()).map(|i| casters.instance(i).unwrap()).collect(),
            hidden: vec![false; scene.instances.len()],
            meshes: (0..scene.meshes.len()).map(|i| casters.mesh(i).unwrap()).collect(),
            materials: (0..scene.materials.len()).map(|i| casters.material(i).unwrap()).collect(),
            textures: (0..scene.textures.len()).map(|i| casters.texture(i).unwrap()).collect(),
            bent: scene.meshes.iter().position(|m| !m.weights.is_empty()).unwrap(),
            scene,
            state: seed,
        }
    }

    /// What a scene of the same things would be, made anew.
    pub fn result(&self) -> Scene {
        let shown = self.scene.instances.iter().zip(&self.hidden).filter(|(_, hidden)| !**hidden);
        let instances = shown.map(|(instance, _)| instance.clone()).collect();
        Scene { instances, ..self.scene.clone() }
    }

    fn below(&mut self, end: usize) -> usize {
        self.state = self.state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.state >> 33) as usize) % end.max(1)
    }

    fn share(&mut self) -> f64 {
        self.below(1000) as f64 / 1000.0
    }

    fn place(&mut self) -> DAffine3 {
        let at = DVec3::new(4.0 * self.share() - 2.0, 2.5 * self.share(), 4.0 * self.share() - 2.0);
        let turn = DAffine3::from_rotation_y(6.0 * self.share()) * DAffine3::from_rotation_x(self.share());
        let mirror = if self.below(5) == 0 { -1.0 } else { 1.0 };
        let size = DVec3::new(mirror, 1.0, 1.0) * (0.2 + 0.6 * self.share());
        DAffine3::from_translation(at) * turn * DAffine3::from_scale(size)
    }

    /// One change of any kind.
    pub fn change(&mut self, casters: &mut Casters) {
        let any = self.below(self.scene.instances.len());
        match self.below(14) {
            0 | 1 => self.insert(casters),
            2 if !self.instances.is_empty() => self.remove(casters, any),
            3 if !self.instances.is_empty() => {
                let place = self.place();
                casters.move_instance(self.instances[any], &place).unwrap();
                self.scene.instances[any].world_from_mesh = place;
            }
            4 if !self.instances.is_empty() => {
                let flags = [self.below(3) > 0, self.below(3) > 0];
                casters.set_flags(self.instances[any], flags[0], flags[1]).unwrap();
                [self.scene.instances[any].casts, self.scene.instances[any].receives] = flags;
            }
            5 if !self.instances.is_empty() => {
                let material = self.below(self.materials.len());
                casters.set_material(self.instances[any], self.materials[material]).unwrap();
                self.scene.instances[any].material = material;
            }
            6 if !self.instances.is_empty() => {
                self.hidden[any] = !self.hidden[any];
                casters.show(self.instances[any], !self.hidden[any]).unwrap();
            }
            7 => self.replace_mesh(casters),
            8 => self.deform(casters),
            9 => self.replace_material(casters),
            10 => {
                let new = picture(self.below(256) as u8);
                casters.replace_texture(self.textures[0], &new).unwrap();
                self.scene.textures[0] = new;
            }
            11 => self.bend(casters),
            12 => self.add(casters),
            _ => self.remove_things(casters),
        }
    }

    fn insert(&mut self, casters: &mut Casters) {
        let mesh = self.below(self.meshes.len());
        let (material, world_from_mesh) = (self.below(self.materials.len()), self.place());
        let pose = self.scene.instances.iter().find_map(|i| i.pose).filter(|_| mesh == self.bent);
        let [casts, receives] = [self.below(4) > 0, self.below(4) > 0];
        let instance = Instance { mesh, material, model: 7, world_from_mesh, pose, casts, receives };
        let new = Placement {
            casts,
            receives,
            joints: self.scene.joints(&instance),
            model: 7,
            ..Placement::new(self.meshes[mesh], self.materials[material], world_from_mesh)
        };
        self.instances.push(casters.insert(&new).unwrap());
        self.hidden.push(false);
        self.scene.instances.push(instance);
    }

    pub fn remove(&mut self, casters: &mut Casters, i: usize) {
        let gone = self.instances.remove(i);
        casters.remove(gone).unwrap();
        assert!(casters.remove(gone).is_err() && !casters.has(gone), "a handle of what is gone");
        self.hidden.remove(i);
        self.scene.instances.remove(i);
    }

    fn some_mesh(&mut self) -> Mesh {
        match self.below(4) {
            0 => primitive::sphere(5 + self.below(4) as u32, 5),
            1 => primitive::cylinder(4 + self.below(5) as u32, 1),
            2 => primitive::plane(),
            _ => primitive::torus(0.6, 0.15, 5 + self.below(4) as u32, 5),
        }
    }

    fn replace_mesh(&mut self, casters: &mut Casters) {
        let (i, new) = (self.below(self.meshes.len()), self.some_mesh());
        if i == self.bent {
            return;
        }
        casters.replace_mesh(self.meshes[i], &new).unwrap();
        self.scene.meshes[i] = new;
    }

    fn deform(&mut self, casters: &mut Casters) {
        let i = self.below(self.meshes.len());
        if i == self.bent {
            return;
        }
        let (mut mesh, by) = (self.scene.meshes[i].clone(), self.share() as f32);
        for p in &mut mesh.positions {
            *p += Vec3::new(0.1 * (7.0 * p.y + by).sin(), 0.05 * by, 0.1 * (5.0 * p.x).cos() * by);
        }
        mesh.uvs.iter_mut().for_each(|uv| *uv += Vec2::splat(0.1 * by));
        casters.deform_mesh(self.meshes[i], &mesh).unwrap();
        self.scene.meshes[i] = mesh;
    }

    fn replace_material(&mut self, casters: &mut Casters) {
        let i = self.below(self.materials.len());
        let texture = Some(self.below(self.textures.len())).filter(|_| self.share() < 0.6);
        let new = material(texture, self.below(3) == 0, self.share() as f32);
        casters.replace_material(self.materials[i], &new, texture.map(|t| self.textures[t])).unwrap();
        self.scene.materials[i] = new;
    }

    fn bend(&mut self, casters: &mut Casters) {
        let time_s = 4.0 * self.share();
        let posed = self.scene.instances.iter().position(|i| i.pose.is_some());
        let Some(i) = posed else { return };
        if let Some(pose) = &mut self.scene.instances[i].pose {
            pose.moment = Some(Moment { animation: 0, time_s });
        }
        let joints = self.scene.joints(&self.scene.instances[i]).unwrap();
        casters.set_pose(self.instances[i], &joints).unwrap();
    }

    /// A mesh, a material and a texture of their own.
    fn add(&mut self, casters: &mut Casters) {
        let (mesh, texture) = (self.some_mesh(), picture(self.below(256) as u8));
        self.meshes.push(casters.add_mesh(&mesh).unwrap());
        self.textures.push(casters.add_texture(&texture).unwrap());
        let new = material(Some(self.textures.len() - 1), self.below(2) == 0, 0.3);
        self.materials.push(casters.add_material(&new, self.textures.last().copied()).unwrap());
        self.scene.meshes.push(mesh);
        self.scene.textures.push(texture);
        self.scene.materials.push(new);
        self.insert(casters);
    }

    /// A mesh that no instance has, where there is one; and what is in use stays.
    fn remove_things(&mut self, casters: &mut Casters) {
        let used = |i: usize| self.scene.instances.iter().any(|instance| instance.mesh == i);
        let Some(i) = (0..self.meshes.len()).find(|i| *i != self.bent && !used(*i)) else {
            let in_use = self.scene.instances.first().map(|instance| self.meshes[instance.mesh]);
            assert!(in_use.is_none_or(|mesh| casters.remove_mesh(mesh).is_err()), "a mesh in use");
            return;
        };
        casters.remove_mesh(self.meshes.remove(i)).unwrap();
        self.scene.meshes.remove(i);
        self.bent -= usize::from(self.bent > i);
        self.scene.instances.iter_mut().for_each(|instance| instance.mesh -= usize::from(instance.mesh > i));
    }

    pub fn count(&self) -> usize {
        self.instances.len()
    }
}
