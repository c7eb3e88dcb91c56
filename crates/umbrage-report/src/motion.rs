//! Small motion for measurements: what a technique keeps from frame to frame is worth nothing where
//! all moves.

use crate::error::Error;
use serde::Serialize;
use std::{f64::consts::TAU, str::FromStr};
use umbrage_core::glam::{DAffine3, DVec3};
use umbrage_core::{Bounds, Camera, Instance, LightShape, Scene};
use umbrage_renderer::Renderer;

/// What moves from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
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
const PERIOD: u32 = 60;
const LIGHT_SHARE: f64 = 0.05;
const LIGHT_TURN_DEG: f64 = 3.0;
const SINK_SHARE: f64 = 0.05;
const EYE_SHARE: f64 = 0.02;
/// Neighbours move out of step by this share of the way round, so that not all are in the same
/// place at once.
const STEP: f64 = 0.382;

impl Moving {
    const ALL: [Self; 6] = [Self::None, Self::Still, Self::Lights, Self::Casters, Self::Camera, Self::All];

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

    fn moves(self, part: Self) -> bool {
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

/// The motion of one scene: the same in every renderer.
pub(crate) struct Motion<'a> {
    moving: Moving,
    scene: &'a Scene,
    /// Radius of the scene, metres.
    radius: f64,
    /// Casting instances and how far they sink, metres.
    sinking: Vec<(usize, f64)>,
    /// Instances whose joints move.
    bending: Vec<usize>,
}

impl<'a> Motion<'a> {
    pub(crate) fn new(moving: Moving, scene: &'a Scene) -> Self {
        let meshes: Vec<Bounds> = scene.meshes.iter().map(|m| m.bounds()).collect();
        let casters = || scene.instances.iter().enumerate().filter(|(_, i)| i.casts && moving.moves(Moving::Casters));
        let is_animated = |i: &Instance| i.pose.is_some_and(|pose| pose.moment.is_some());
        let bending = casters().filter(|(_, i)| is_animated(i)).map(|(number, _)| number).collect();
        let sinking = casters().map(|(number, instance)| {
            let smallest = meshes[instance.mesh].transformed(&instance.world_from_mesh).size().min_element();
            (number, SINK_SHARE * smallest)
        });
        let sinking = sinking.filter(|(_, depth)| *depth > 0.0).collect();
        Self { moving, scene, radius: scene.bounds().radius(), sinking, bending }
    }

    /// Moves the lights (one a pass) and the casters of `renderer` to where they are in frame
    /// `frame`.
    pub(crate) fn apply(&self, renderer: &mut Renderer, lights: &[usize], frame: u32) -> Result<(), umbrage::Error> {
        if self.moving.moves(Moving::Lights) {
            for (pass, &number) in lights.iter().enumerate() {
                if let Some(light) = renderer.light_mut(pass) {
                    light.shape = moved(&self.scene.lights[number].shape, circle(frame, number), self.radius);
                }
            }
        }
        for &(number, depth) in &self.sinking {
            let down = DVec3::NEG_Y * (depth * 0.5 * (1.0 - circle(frame, number)[0]));
            let world_from_mesh = DAffine3::from_translation(down) * self.scene.instances[number].world_from_mesh;
            if let Some(instance) = renderer.casters().instance(number) {
                renderer.casters_mut().move_instance(instance, &world_from_mesh)?;
            }
        }
        for &number in &self.bending {
            if let Some(instance) = renderer.casters().instance(number) {
                renderer.casters_mut().set_pose(instance, &self.joints(number, frame))?;
            }
        }
        Ok(())
    }

    /// The joints of an instance in frame `frame`: its animation runs once in a period, starting
    /// where the scene has it.
    fn joints(&self, number: usize, frame: u32) -> Vec<DAffine3> {
        let mut instance = self.scene.instances[number].clone();
        if let Some(pose) = &mut instance.pose
            && let Some(moment) = &mut pose.moment
        {
            let animation = self.scene.rigs.get(pose.rig).and_then(|rig| rig.animations.get(moment.animation));
            let share = f64::from(frame % PERIOD) / f64::from(PERIOD);
            moment.time_s += share * animation.map_or(0.0, |a| a.duration_s());
        }
        self.scene.joints(&instance).unwrap_or_default()
    }

    /// The camera of frame `frame`.
    pub(crate) fn camera(&self, frame: u32) -> Camera {
        let mut camera = self.scene.camera.clone();
        if self.moving.moves(Moving::Camera) {
            let [right, up, _] = camera.axes();
            let [x, y] = circle(frame, 0).map(|v| v * EYE_SHARE * camera.eye.distance(camera.target));
            camera.eye += right * x + up * y;
        }
        camera
    }
}

/// The place on the unit circle of what has this number.
fn circle(frame: u32, number: usize) -> [f64; 2] {
    let turns = f64::from(frame % PERIOD) / f64::from(PERIOD) + number as f64 * STEP;
    let (sin, cos) = (turns * TAU).sin_cos();
    [cos, sin]
}

fn moved(shape: &LightShape, [x, z]: [f64; 2], scene_radius: f64) -> LightShape {
    let mut shape = shape.clone();
    let by = DVec3::new(x, 0.0, z) * (LIGHT_SHARE * scene_radius);
    match &mut shape {
        LightShape::Directional { direction, .. } => {
            let (a, b) = direction.any_orthonormal_pair();
            *direction = (*direction + (a * x + b * z) * LIGHT_TURN_DEG.to_radians().tan()).normalize();
        }
        LightShape::Line { from, to } => {
            *from += by;
            *to += by;
        }
        LightShape::Point { position }
        | LightShape::Spot { position, .. }
        | LightShape::Sphere { position, .. }
        | LightShape::Ellipsoid { position, .. }
        | LightShape::Disc { position, .. }
        | LightShape::Rect { position, .. } => *position += by,
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
            assert!(motion.camera(0) != motion.camera(1) && motion.camera(0) == motion.camera(PERIOD));
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
                motion.apply(&mut renderer, &[0], frame).unwrap();
                renderer.frame(&motion.camera(frame)).unwrap();
                renderer.visibility(0).unwrap().data
            });
            assert_eq!(start == way, matches!(moving, Moving::None | Moving::Still), "moving: {}", moving.name());
            assert!(start == end, "moving {} ends elsewhere", moving.name());
        }
    }

    #[test]
    fn what_is_not_asked_to_move_stands() {
        let scene = (scenes::SCENES[0].build)(0.05);
        let motion = Motion::new(Moving::Lights, &scene);
        assert_eq!(motion.camera(5), scene.camera);
        assert!(motion.sinking.is_empty());
    }
}
