//! Light of a sphere of directions as coefficients.

use super::basis::evaluate;
use super::order::{Order, index};
use super::rotation::Rotation;
use super::window::Window;
use glam::{DQuat, DVec3, Vec3};

/// Coefficients of light from all directions: one linear RGB colour for each function.
#[derive(Clone, Debug, PartialEq)]
pub struct Light {
    order: Order,
    coefficients: Vec<DVec3>,
}

impl Light {
    /// No light.
    pub fn black(order: Order) -> Self {
        Self { order, coefficients: vec![DVec3::ZERO; order.functions()] }
    }

    /// Of coefficients in the order of their numbers; `None` where no order has so many.
    pub fn new(coefficients: Vec<DVec3>) -> Option<Self> {
        Some(Self { order: Order::of_functions(coefficients.len())?, coefficients })
    }

    /// The order.
    pub fn order(&self) -> Order {
        self.order
    }

    /// One colour for each function, in the order of their numbers.
    pub fn coefficients(&self) -> &[DVec3] {
        &self.coefficients
    }

    /// The light from a unit `direction`: what the functions make of it, which rings below zero
    /// near hard lights.
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        let mut basis = [0.0; 100];
        evaluate(self.order, direction, &mut basis);
        self.coefficients.iter().zip(basis).map(|(c, y)| *c * y).sum()
    }

    /// The light turned: what came from d comes from `rotation` · d.
    #[must_use]
    pub fn rotated(&self, rotation: DQuat) -> Self {
        let mut turned = self.clone();
        Rotation::new(self.order, rotation).apply(&mut turned.coefficients);
        turned
    }

    /// High bands made weaker.
    #[must_use]
    pub fn windowed(&self, window: Window) -> Self {
        let mut light = self.clone();
        for l in 0..self.order.bands() {
            let factor = window.factor(self.order, l);
            let band = index(l, -(l as isize))..=index(l, l as isize);
            light.coefficients[band].iter_mut().for_each(|c| *c *= factor);
        }
        light
    }

    /// The first functions of a lower order, or zeros for those of a higher one.
    #[must_use]
    pub fn with_order(&self, order: Order) -> Self {
        let mut coefficients = self.coefficients.clone();
        coefficients.resize(order.functions(), DVec3::ZERO);
        Self { order, coefficients }
    }

    /// Adds light from the one direction `direction` (unit length), of irradiance `irradiance` on a
    /// surface that faces it: a sun without size.
    pub fn add_direction(&mut self, direction: DVec3, irradiance: DVec3) {
        let mut basis = [0.0; 100];
        evaluate(self.order, direction, &mut basis);
        self.coefficients.iter_mut().zip(basis).for_each(|(c, y)| *c += irradiance * y);
    }
}

/// Coefficients of `radiance`, a function of unit directions, by a sum over directions that is
/// exact where it is a polynomial of degree `degree` at most; other functions need a degree as high
/// as their finest detail, π / degree radians.
pub fn project(order: Order, degree: u32, mut radiance: impl FnMut(DVec3) -> Vec3) -> Light {
    let mut light = Light::black(order);
    for (direction, weight) in super::quadrature::quadrature(degree + order.bands() as u32 - 1) {
        light.add_direction(direction, weight * radiance(direction).as_dvec3());
    }
    light
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn order(n: u32) -> Order {
        Order::new(n).unwrap()
    }

    /// Smooth, and of no low degree.
    fn sky(s: DVec3) -> Vec3 {
        let lobe = |axis: DVec3| (3.0 * (s.dot(axis.normalize()) - 1.0)).exp();
        DVec3::new(lobe(DVec3::ONE), 0.2 + lobe(DVec3::new(-1.0, 0.3, 0.1)), lobe(DVec3::NEG_Z)).as_vec3()
    }

    #[test]
    fn turning_what_was_projected_is_projecting_what_was_turned() {
        let turn = DQuat::from_xyzw(0.1, 0.7, -0.5, 0.2).normalize();
        for n in 1..=10 {
            let turned = project(order(n), 40, sky).rotated(turn);
            let anew = project(order(n), 40, |s| sky(turn.inverse() * s));
            let both = turned.coefficients.iter().zip(&anew.coefficients);
            let worst = both.map(|(a, b)| (*a - *b).abs().max_element()).fold(0.0, f64::max);
            assert!(worst < 1e-5, "order {n}: {worst}");
        }
    }

    #[test]
    fn a_constant_is_the_first_function_alone() {
        let light = project(order(4), 0, |_| Vec3::new(1.0, 2.0, 0.5));
        assert!((light.coefficients[0] - DVec3::new(1.0, 2.0, 0.5) * (4.0 * PI).sqrt()).length() < 1e-12);
        assert!(light.coefficients[1..].iter().all(|c| c.length() < 1e-12));
        assert!((light.radiance(DVec3::X) - DVec3::new(1.0, 2.0, 0.5)).length() < 1e-12);
    }

    #[test]
    fn orders_are_cut_and_filled() {
        let light = project(order(5), 40, sky);
        let low = light.with_order(order(2));
        assert_eq!(low.coefficients, light.coefficients[..4]);
        assert_eq!(low.with_order(order(3)).coefficients[4..], [DVec3::ZERO; 5]);
        assert_eq!(Light::new(vec![DVec3::ONE; 5]), None);
    }

    #[test]
    fn windows_make_a_hard_light_ring_less() {
        let mut sun = Light::black(order(6));
        sun.add_direction(DVec3::Y, DVec3::ONE);
        let lowest = |light: &Light| {
            let around = (0..180).map(|i| f64::from(i).to_radians().sin_cos());
            around.map(|(sin, cos)| light.radiance(DVec3::new(sin, cos, 0.0)).x).fold(f64::INFINITY, f64::min)
        };
        let (plain, lanczos) = (lowest(&sun), lowest(&sun.windowed(Window::Lanczos)));
        let hanning = lowest(&sun.windowed(Window::Hanning));
        assert!(plain < lanczos && lanczos < hanning, "{plain} {lanczos} {hanning}");
    }
}
