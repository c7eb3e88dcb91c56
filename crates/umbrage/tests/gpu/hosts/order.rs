//! Frames that are dropped, that fail, and that come in another order than they were recorded in.

use super::{Host, difference};
use crate::common::scene;
use umbrage::core::Image;
use umbrage::core::glam::{DAffine3, DVec3};
use umbrage::{Error, Recorder};

/// Techniques that keep what they drew, each in its own way.
const KEEPING: [(&str, &str); 9] = [
    ("shadow-map", "size=256,focus=light"),
    ("evsm", "size=256,focus=light"),
    ("pcss", "size=256,focus=light"),
    ("silhouette-map", "size=256,focus=light"),
    ("smoothies", "size=256,focus=light"),
    ("pcf-blur", "size=256,focus=light"),
    ("light-mask", ""),
    ("volume", ""),
    ("wedges", ""),
];

/// A frame that an engine wants and never gets.
#[derive(Clone, Copy, Debug)]
enum Fault {
    Dropped,
    /// Submitted with something in it that is not valid.
    Failed,
}

impl Fault {
    fn befall(self, host: &mut Host) {
        let mut encoder = host.record().unwrap();
        if let Self::Failed = self {
            let buffer = host.gpu.buffer("not to be cleared", &[0_u32; 4], wgpu::BufferUsages::UNIFORM);
            encoder.clear_buffer(&buffer, 0, None);
            host.submit(encoder);
            let complaints = std::mem::take(&mut *host.complaints.lock().unwrap());
            assert!(!complaints.is_empty(), "the frame should have failed");
        }
    }
}

fn heals(id: &str, set: &str, fault: Fault, change: impl Fn(&mut Host)) {
    let mut host = Host::new(&scene("tentacles", 0.3), id, set);
    let before = host.frame();
    assert_eq!(difference(&host.frame(), &before), 0.0, "{id}: nothing has changed");
    change(&mut host);
    fault.befall(&mut host);
    let after = host.frame();
    let right = without_fault(&host, id, set, change);
    assert!(difference(&before, &right) > 0.5, "{id}: the change is not to be seen");
    let off = difference(&after, &right);
    println!("{id} {fault:?}: off by {off}");
    assert_eq!(off, 0.0, "{id}: the frame after one that was {fault:?}");
    host.assert_quiet();
}

/// What another engine sees, of which no frame is lost.
fn without_fault(host: &Host, id: &str, set: &str, change: impl Fn(&mut Host)) -> Image<f32> {
    let (gpu, complaints) = (host.gpu.clone(), host.complaints.clone());
    let mut host = Host::on(gpu, complaints, &scene("tentacles", 0.3), id, set).unwrap();
    host.frame();
    change(&mut host);
    host.frame()
}

#[test]
fn a_pose_that_was_recorded_into_a_dropped_encoder_is_not_lost() {
    for (id, set) in KEEPING {
        heals(id, set, Fault::Dropped, |host| host.pose(0.7));
    }
}

#[test]
fn a_pose_that_was_recorded_into_a_frame_that_failed_is_not_lost() {
    for (id, set) in KEEPING {
        heals(id, set, Fault::Failed, |host| host.pose(0.7));
    }
}

/// Puts the casters elsewhere.
fn shift(host: &mut Host) {
    for (number, instance) in host.scene.instances.iter_mut().enumerate().skip(1) {
        instance.world_from_mesh = DAffine3::from_translation(DVec3::new(0.9, 0.0, 0.6)) * instance.world_from_mesh;
        let id = host.casters.instance(number).unwrap();
        host.casters.move_instance(id, &instance.world_from_mesh).unwrap();
    }
}

#[test]
fn maps_heal_after_a_dropped_encoder() {
    for (id, set) in KEEPING {
        heals(id, set, Fault::Dropped, shift);
    }
}

#[test]
fn maps_heal_after_a_submit_that_failed() {
    for (id, set) in KEEPING {
        heals(id, set, Fault::Failed, shift);
    }
}

#[test]
fn the_first_frame_may_fail() {
    for (id, set) in KEEPING {
        for fault in [Fault::Dropped, Fault::Failed] {
            let mut host = Host::new(&scene("tentacles", 0.3), id, set);
            fault.befall(&mut host);
            let seen = host.frame();
            let off = difference(&seen, &without_fault(&host, id, set, |_| ()));
            assert_eq!(off, 0.0, "{id}: the frame after one that was {fault:?}");
        }
    }
}

#[test]
fn frames_that_are_submitted_in_reverse_are_an_error_and_leave_nothing_wrong() {
    for (id, set) in KEEPING {
        let mut host = Host::new(&scene("tentacles", 0.3), id, set);
        host.frame();
        host.pose(0.4);
        let first = host.record().unwrap();
        host.pose(0.4);
        let second = host.record().unwrap();
        host.submit(second);
        host.submit(first);
        host.gpu.wait().unwrap();
        assert_eq!(host.record().err(), Some(Error::Order { frame: 2, by: 3 }), "{id}");
        let off = difference(
            &host.frame(),
            &without_fault(&host, id, set, |host| {
                host.pose(0.4);
                host.pose(0.4);
            }),
        );
        assert_eq!(off, 0.0, "{id}");
        host.assert_quiet();
    }
}

#[test]
fn frames_of_one_submit_in_order_are_right() {
    let mut host = Host::new(&scene("tentacles", 0.3), "shadow-map", "size=256,focus=light");
    host.frame();
    host.pose(0.4);
    let first = host.record().unwrap();
    host.pose(0.4);
    let second = host.record().unwrap();
    host.gpu.queue.submit([first.finish(), second.finish()]);
    let seen = host.target.read(&host.gpu).unwrap();
    let right = without_fault(&host, "shadow-map", "size=256,focus=light", |host| {
        host.pose(0.4);
        host.pose(0.4);
    });
    assert_eq!(difference(&seen, &right), 0.0);
    assert_eq!(difference(&seen, &host.frame()), 0.0);
    host.assert_quiet();
}

#[test]
fn a_frame_that_is_dropped_without_finish_can_be_submitted() {
    let host = Host::new(&scene("tentacles", 0.3), "none", "");
    let mut recorder = Recorder::new(&host.gpu);
    let usage = wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::COPY_SRC;
    let buffer = host.gpu.buffer("uploaded", &[0_u32; 4], usage);
    for number in 0..3_u32 {
        let mut encoder = host.gpu.device.create_command_encoder(&Default::default());
        recorder.begin(&mut encoder).upload(&buffer, bytemuck::bytes_of(&[number; 4]));
        host.submit(encoder);
    }
    host.gpu.wait().unwrap();
    host.assert_quiet();
}

#[test]
fn times_come_back_after_dropped_encoders() {
    let gpu = crate::common::gpu();
    assert!(gpu.has(wgpu::Features::TIMESTAMP_QUERY), "this test needs timestamps");
    let mut recorder = Recorder::new(&gpu);
    let mut frame = |submit: bool| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = recorder.begin(&mut encoder);
        drop(passes.compute("a pass"));
        passes.finish();
        if submit {
            gpu.queue.submit([encoder.finish()]);
            gpu.wait().unwrap();
        }
    };
    (0..9).for_each(|_| frame(false));
    frame(true);
    assert_eq!(recorder.times().len(), 1);
}
