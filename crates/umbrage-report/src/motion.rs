//! Small motion for measurements: what a technique keeps from frame to frame is worth nothing where
//! all moves.

use crate::error::Error;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::{f64::consts::TAU, str::FromStr};
use umbrage::Casters;
use umbrage_core::glam::{DAffine3, DVec3};
use umbrage_core::{Bounds, Camera, Instance, Light, LightShape, Pose, Scene};
#[cfg(not(target_family = "wasm"))]
use umbrage_renderer::Renderer;

/// What moves from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Moving {
    /// Nothing, and every frame does all of the work: what techniques keep from frame to frame is
    /// dropped.
    #[default]
    None,
    /// Nothing, and what techniques keep is used again.
    Still,
    /// Lights go round a level circle whose radius is 5 % of that of the scene; parallel light
    /// turns by 3 degrees.
    Lights,
    /// Everything that casts and is not flat sinks and rises by 5 % of its smallest side;
    /// animations run.
    Casters,
    /// The eye circles by 2 % of its distance from what it looks at.
    Camera,
    /// All of these.
    All,
}

/// Frames until everything is back in its place.
pub const PERIOD: u32 = 60;
const LIGHT_SHARE: f64 = 0.05;
const LIGHT_TURN_DEG: f64 = 3.0;
const SINK_SHARE: f64 = 0.05;
const EYE_SHARE: f64 = 0.02;
/// Neighbours move out of step by this share of the way round, so that not all are in the same
/// place at once.
const STEP: f64 = 0.382;

impl Moving {
    /// All of them.
    pub const ALL: [Self; 6] = [Self::None, Self::Still, Self::Lights, Self::Casters, Self::Camera, Self::All];

    /// The name users see.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Still => "still",
            Self::Lights => "lights",
            Self::Casters => "casters",
            Self::Camera => "camera",
            Self::All => "all",
        }
    }

    /// `part` moves: lights, casters, or the camera.
    pub fn moves(self, part: Self) -> bool {
        self == part || self == Self::All
    }
}

impl FromStr for Moving {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let found = Self::ALL.into_iter().find(|m| m.name() == text);
        found.ok_or_else(|| Error::one_of(text, &Self::ALL.map(Self::name)))
    }
}

/// The motion of one scene: the same in every renderer, and in the scene itself.
#[derive(Clone, Debug)]
pub struct Motion {
    moving: Moving,
    /// Radius of the scene, its joints at rest, metres.
    radius: f64,
    /// Casting instances and how far they sink, metres.
    sinking: Vec<(usize, f64)>,
    /// Instances that an animation bends.
    animated: Vec<usize>,
    /// Casting ones among them.
    bending: Vec<usize>,
}

impl Motion {
    /// What of `scene` moves, and how far.
    pub fn new(moving: Moving, scene: &Scene) -> Self {
        let meshes: Vec<Bounds> = scene.meshes.iter().map(|m| m.bounds()).collect();
        let bounds = |i: &Instance| meshes[i.mesh].transformed(&i.world_from_mesh);
        let radius = scene.instances.iter().map(bounds).fold(Bounds::EMPTY, Bounds::union).radius();
        let is_animated = |number: &usize| scene.instances[*number].pose.is_some_and(|pose| pose.moment.is_some());
        let animated: Vec<usize> = (0..scene.instances.len()).filter(is_animated).collect();
        let casters = || scene.instances.iter().enumerate().filter(|(_, i)| i.casts && moving.moves(Moving::Casters));
        let sinking = casters().map(|(number, i)| (number, SINK_SHARE * bounds(i).size().min_element()));
        let sinking = sinking.filter(|(_, depth)| *depth > 0.0).collect();
        let bending = casters().map(|(number, _)| number).filter(is_animated).collect();
        Self { moving, radius, sinking, animated, bending }
    }

    /// What moves.
    pub fn moving(&self) -> Moving {
        self.moving
    }

    /// Some instance of the scene is animated, so that it changes as time goes by.
    pub fn is_animated(&self) -> bool {
        !self.animated.is_empty()
    }

    /// Light number `number`, which stands as `light` does, in frame `frame`.
    pub fn light(&self, number: usize, light: &Light, frame: u32) -> Light {
        let mut light = light.clone();
        if self.moving.moves(Moving::Lights) {
            light.shape = moved(&light.shape, circle(frame, number), self.radius);
        }
        light
    }

    /// The camera that stands as `start` does, in frame `frame`.
    pub fn camera(&self, start: &Camera, frame: u32) -> Camera {
        let mut camera = start.clone();
        if self.moving.moves(Moving::Camera) {
            let [right, up, _] = camera.axes();
            let [x, y] = circle(frame, 0).map(|v| v * EYE_SHARE * camera.eye.distance(camera.target));
            camera.eye += right * x + up * y;
        }
        camera
    }

    /// The instances of `scene` that move, by their numbers, in frame `frame`, every animation
    /// moved on by `time_s` seconds before. The animations of casters that move run once in a
    /// period, starting there.
    pub fn instances(&self, scene: &Scene, time_s: f64, frame: u32) -> BTreeMap<usize, Instance> {
        let mut placed = BTreeMap::new();
        let mut change = |number: usize, change: &dyn Fn(&mut Instance)| {
            if let Some(instance) = scene.instances.get(number) {
                change(placed.entry(number).or_insert_with(|| instance.clone()));
            }
        };
        for &number in self.animated.iter().filter(|_| time_s != 0.0) {
            change(number, &|instance| go_on(instance, time_s));
        }
        for &(number, depth) in &self.sinking {
            let down = DVec3::NEG_Y * (depth * 0.5 * (1.0 - circle(frame, number)[0]));
            let sink = DAffine3::from_translation(down);
            change(number, &|instance| instance.world_from_mesh = sink * instance.world_from_mesh);
        }
        let share = f64::from(frame % PERIOD) / f64::from(PERIOD);
        for &number in &self.bending {
            change(number, &|instance| go_on(instance, share * duration_s(scene, instance)));
        }
        placed
    }

    /// Moves the lights (one a pass) and the casters of `renderer`, which shows `scene`, to where
    /// they are in frame `frame`.
    #[cfg(not(target_family = "wasm"))]
    pub(crate) fn apply(
        &self,
        renderer: &mut Renderer,
        scene: &Scene,
        lights: &[usize],
        frame: u32,
    ) -> Result<(), umbrage::Error> {
        for (pass, &number) in lights.iter().enumerate() {
            if let (true, Some(light)) = (self.moving.moves(Moving::Lights), renderer.light_mut(pass)) {
                *light = self.light(number, &scene.lights[number], frame);
            }
        }
        let placed = self.instances(scene, 0.0, frame);
        placed.iter().try_for_each(|(number, instance)| place(renderer.casters_mut(), scene, *number, instance))
    }

    /// Moves `scene` itself to where it is in frame `frame`.
    pub fn apply_to(&self, scene: &mut Scene, frame: u32) {
        for (number, instance) in self.instances(scene, 0.0, frame) {
            scene.instances[number] = instance;
        }
        scene.camera = self.camera(&scene.camera, frame);
        for (number, light) in scene.lights.iter_mut().enumerate() {
            *light = self.light(number, light, frame);
        }
    }
}

/// Moves the instance of this number in `casters`, which are those of `scene`, to where `instance`
/// is, and bends it as that is bent.
///
/// # Errors
/// A place that is not finite.
pub fn place(casters: &mut Casters, scene: &Scene, number: usize, instance: &Instance) -> Result<(), umbrage::Error> {
    let Some(id) = casters.instance(number) else { return Ok(()) };
    casters.move_instance(id, &instance.world_from_mesh)?;
    match scene.joints(instance) {
        Some(joints) => casters.set_pose(id, &joints),
        None => Ok(()),
    }
}

fn go_on(instance: &mut Instance, seconds: f64) {
    if let Some(moment) = instance.pose.as_mut().and_then(|pose| pose.moment.as_mut()) {
        moment.time_s += seconds;
    }
}

/// How long the animation of an instance takes.
fn duration_s(scene: &Scene, instance: &Instance) -> f64 {
    let animation = |pose: Pose| scene.rigs.get(pose.rig)?.animations.get(pose.moment?.animation);
    instance.pose.and_then(animation).map_or(0.0, |a| a.duration_s())
}

/// The place on the unit circle of what has this number.
fn circle(frame: u32, number: usize) -> [f64; 2] {
    let turns = f64::from(frame % PERIOD) / f64::from(PERIOD) + number as f64 * STEP;
    let (sin, cos) = (turns * TAU).sin_cos();
    [cos, sin]
}

fn moved(shape: &LightShape, [x, z]: [f64; 2], scene_radius: f64) -> LightShape {
    let mut shape = shape.clone();
    match &mut shape {
        LightShape::Directional { direction, .. } => {
            let (a, b) = direction.any_orthonormal_pair();
            *direction = (*direction + (a * x + b * z) * LIGHT_TURN_DEG.to_radians().tan()).normalize();
        }
        LightShape::Environment(environment) => environment.rotate_deg += x * LIGHT_TURN_DEG,
        other => other.shift(DVec3::new(x, 0.0, z) * (LIGHT_SHARE * scene_radius)),
    }
    shape
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::scenes;
    use umbrage_renderer::LightPass;

    #[test]
    fn names_are_read_and_mistakes_named() {
        for moving in Moving::ALL {
            assert_eq!(moving.name().parse::<Moving>().unwrap(), moving);
            assert_eq!(serde_json::to_value(moving).unwrap(), moving.name());
        }
        let wrong = "light".parse::<Moving>().unwrap_err().to_string();
        assert!(wrong.contains("did you mean `lights`") && wrong.contains("casters, camera, all"), "{wrong}");
    }

    #[test]
    fn paths_are_closed_small_and_never_stand_still() {
        for entry in scenes::SCENES {
            let scene = (entry.build)(0.05);
            let motion = Motion::new(Moving::All, &scene);
            for light in &scene.lights {
                let place = |frame| moved(&light.shape, circle(frame, 1), motion.radius).center().truncate();
                let off = place(7).distance(light.shape.center().truncate());
                let small = if light.shape.center().w == 0.0 { 0.053 } else { 0.051 * motion.radius };
                assert!(place(0) != place(1) && place(0) == place(PERIOD), "{}", entry.id);
                assert!(off > 0.0 && off < small, "{}: {off}", entry.id);
            }
            let camera = |frame| motion.camera(&scene.camera, frame);
            assert!(camera(0) != camera(1) && camera(0) == camera(PERIOD));
            assert!(!motion.sinking.is_empty(), "nothing moves in {}", entry.id);
        }
    }

    /// Needs a graphics adapter.
    #[test]
    fn pictures_change_on_the_way_and_are_the_same_after_a_round() {
        let gpu = umbrage::Gpu::request(None).unwrap();
        let scene = (scenes::find("tentacles").unwrap().build)(0.1);
        for moving in Moving::ALL {
            let motion = Motion::new(moving, &scene);
            let info = umbrage::find("shadow-map").unwrap();
            let technique = info.settings(&[]).unwrap().make(&gpu).unwrap();
            let mut renderer = Renderer::new(&gpu, &scene, 96, 72, vec![LightPass { light: 0, technique }]).unwrap();
            let [start, way, end] = [0, PERIOD / 2, PERIOD].map(|frame| {
                motion.apply(&mut renderer, &scene, &[0], frame).unwrap();
                renderer.frame(&motion.camera(&scene.camera, frame)).unwrap();
                renderer.visibility(0).unwrap().data
            });
            assert_eq!(start == way, matches!(moving, Moving::None | Moving::Still), "moving: {}", moving.name());
            assert!(start == end, "moving {} ends elsewhere", moving.name());
        }
    }

    /// Needs a graphics adapter.
    #[test]
    fn a_scene_that_is_moved_looks_like_one_that_moves() {
        let gpu = umbrage::Gpu::request(None).unwrap();
        let scene = (scenes::find("tentacles").unwrap().build)(0.1);
        let pass = || {
            let settings = umbrage::find("shadow-map").unwrap().settings(&[]).unwrap();
            vec![LightPass { light: 0, technique: settings.make(&gpu).unwrap() }]
        };
        let motion = Motion::new(Moving::All, &scene);
        let mut moving = Renderer::new(&gpu, &scene, 96, 72, pass()).unwrap();
        for frame in [40, 13] {
            motion.apply(&mut moving, &scene, &[0], frame).unwrap();
            moving.frame(&motion.camera(&scene.camera, frame)).unwrap();
            let mut moved = scene.clone();
            motion.apply_to(&mut moved, frame);
            let mut standing = Renderer::new(&gpu, &moved, 96, 72, pass()).unwrap();
            standing.frame(&moved.camera).unwrap();
            assert!(moving.color().unwrap() == standing.color().unwrap(), "frame {frame}");
        }
        // Time and the frame of an animation add up.
        let mut later = scene.clone();
        later.advance(0.3);
        let placed = motion.instances(&scene, 0.3, 7);
        let of_later = motion.instances(&later, 0.0, 7);
        assert!(!placed.is_empty() && placed == of_later);
    }

    #[test]
    fn what_is_not_asked_to_move_stands() {
        let scene = (scenes::SCENES[0].build)(0.05);
        let motion = Motion::new(Moving::Lights, &scene);
        assert_eq!(motion.camera(&scene.camera, 5), scene.camera);
        assert!(motion.sinking.is_empty());
    }
}
