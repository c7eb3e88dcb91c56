//! A device that is lost: every call that needs it says so, none panics, and the engine can start
//! again with another one.

use super::{Host, SIZE, difference, floor};
use crate::common::scene;
use umbrage::{
    Casters, Error, Gpu, RadianceTarget, Receivers, Recorder, VisibilityTarget, baseline, light_samples, techniques,
};

fn is_lost<T>(what: &str, result: Result<T, Error>) {
    match result {
        Err(Error::DeviceLost(_)) => (),
        Err(error) => panic!("{what}: {error}"),
        Ok(_) => panic!("{what}: no error"),
    }
}

#[test]
fn whatever_needs_a_lost_device_says_so() {
    let scene = scene("tentacles", 0.3);
    let (device, queue, _complaints) = super::device();
    let gpu = Gpu::new(device.clone(), queue);
    let mut casters = Casters::new(&gpu, &scene).unwrap();
    let target = VisibilityTarget::new(&gpu, SIZE.0, SIZE.1).unwrap();
    let depth = floor(&gpu);
    device.destroy();
    is_lost("check", gpu.check());
    is_lost("casters", Casters::new(&gpu, &scene));
    is_lost("receivers", Receivers::new(&gpu, &depth, None, SIZE));
    is_lost("a target", VisibilityTarget::new(&gpu, SIZE.0, SIZE.1));
    is_lost("a target of radiance", RadianceTarget::new(&gpu, SIZE.0, SIZE.1));
    is_lost("reading", target.read(&gpu));
    is_lost("waiting", gpu.wait());
    is_lost("a recorder that counts", Recorder::counting(&gpu));
    is_lost("a bare minimum", baseline::bare_minimum(&gpu, 64, 1));
    for info in techniques() {
        is_lost(info.id, info.default_settings().make(&gpu));
    }
    let hard = umbrage::parse("shadow-map").unwrap();
    is_lost("light samples", light_samples(&gpu, &hard, 4));
    // These return no error, and what they are used for does.
    let [first, second] = [1, 2].map(|number| casters.instance(number).unwrap());
    casters.move_instance(first, &scene.instances[0].world_from_mesh).unwrap();
    casters.set_pose(second, &[]).unwrap();
    drop(Recorder::new(&gpu));
    drop(gpu.buffer("a buffer", &[1_u32], wgpu::BufferUsages::UNIFORM));
    drop(baseline::floor(&gpu));
}

/// Before what an engine loses its device.
#[derive(Clone, Copy, Debug)]
enum Moment {
    Preparing,
    Recording,
    Submitting,
}

#[test]
fn a_frame_on_a_lost_device_says_so() {
    for info in techniques() {
        for moment in [Moment::Preparing, Moment::Recording, Moment::Submitting] {
            let mut host = Host::new(&scene("tentacles", 0.3), info.id, "");
            host.frame();
            host.pose(0.3);
            let device = host.gpu.device.clone();
            match moment {
                Moment::Preparing => device.destroy(),
                Moment::Recording => host.between = Some(Box::new(move || device.destroy())),
                Moment::Submitting => {
                    let encoder = host.record().unwrap();
                    device.destroy();
                    host.submit(encoder);
                }
            }
            is_lost(&format!("{}, lost before {moment:?}", info.id), host.record());
        }
    }
}

#[test]
fn a_host_can_tell_why() {
    let mut host = Host::new(&scene("tentacles", 0.3), "shadow-map", "");
    host.gpu.clone().lost("the driver was updated");
    let error = host.record().unwrap_err();
    assert_eq!(error, Error::DeviceLost("the driver was updated".into()));
    assert!(error.to_string().contains("make a new one"), "{error}");
}

#[test]
fn an_engine_starts_again_with_a_new_device() {
    let scene = scene("tentacles", 0.3);
    let mut host = Host::new(&scene, "pcss", "");
    let before = host.frame();
    host.gpu.device.destroy();
    is_lost("a frame", host.record());
    let mut again = Host::new(&scene, "pcss", "");
    assert_eq!(difference(&again.frame(), &before), 0.0);
    again.assert_quiet();
}
