//! The light of a sky as coefficients, projected once for each sky.

use umbrage_core::harmonics::{Light, Order, Window, project, project_equirect};
use umbrage_core::{Environment, Sky};

/// Pixels across and down that a sky is averaged over: finer than any function of order 10.
const SIZE: (u32, u32) = (256, 128);

/// The sky that was projected last.
pub(super) struct SkyLight {
    order: Order,
    window: Window,
    projected: Option<(Sky, Light)>,
}

impl SkyLight {
    pub fn new(order: Order, window: Window) -> Self {
        Self { order, window, projected: None }
    }

    /// The light of an environment before it is turned, of intensity 1.
    pub fn of(&mut self, environment: &Environment) -> &Light {
        let known = self.projected.take().filter(|(sky, _)| sky.is_copy_of(&environment.sky));
        let projected = known.unwrap_or_else(|| (environment.sky.clone(), self.project(&environment.sky)));
        &self.projected.insert(projected).1
    }

    fn project(&self, sky: &Sky) -> Light {
        let light = match sky {
            Sky::Constant(color) => project(self.order, 0, |_| *color),
            _ => project_equirect(self.order, &sky.picture(SIZE.0, SIZE.1)),
        };
        light.windowed(self.window)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use umbrage_core::Image;
    use umbrage_core::environment::{Gradient, SkyPicture};
    use umbrage_core::glam::Vec3;

    #[test]
    fn a_sky_is_projected_when_it_changes_and_not_when_it_turns() {
        let mut light = SkyLight::new(Order::default(), Window::None);
        let picture = SkyPicture::new(Image::from_fn(8, 4, |x, y| [x as f32, y as f32, 1.0])).unwrap();
        let mut environment = Environment::new(Sky::Picture(picture));
        let first = light.of(&environment).clone();
        let place = |light: &SkyLight| light.projected.as_ref().map(|(_, l)| l.coefficients().as_ptr());
        let before = place(&light);
        environment.rotate_deg = 40.0;
        assert_eq!(light.of(&environment.clone()), &first);
        assert_eq!(place(&light), before, "it was projected again");
        environment.sky = Sky::Gradient(Gradient { zenith: Vec3::ONE, horizon: Vec3::ONE, nadir: Vec3::ZERO });
        assert_ne!(light.of(&environment), &first);
    }

    #[test]
    fn windows_leave_the_mean() {
        let sky = Sky::Gradient(Gradient { zenith: Vec3::ONE, horizon: Vec3::splat(0.4), nadir: Vec3::ZERO });
        let of = |window| SkyLight::new(Order::default(), window).of(&Environment::new(sky.clone())).clone();
        let (plain, hanning) = (of(Window::None), of(Window::Hanning));
        assert_eq!(plain.coefficients()[0], hanning.coefficients()[0]);
        assert!(hanning.coefficients()[1].x.abs() < plain.coefficients()[1].x.abs());
    }
}
