//! What fails in one technique ends only its own cell. Needs a graphics adapter. The
//! techniques that fail are those of a host, added to the registry.

use umbrage::{
    Configure, Error, Family, Gpu, InOrder, Inside, Passes, Registry, SettingsOf, Stats, Technique, TechniqueInfo,
    View, VisibilityTarget, core::LightKinds, settings,
};
use umbrage_report::{Bench, Choice, Compare, Moving, Silent, Source, Sweep, record::Status};

/// Where a technique fails.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fault {
    Make,
    Prepare,
    Record,
    Driver,
}

/// Declares a technique of a host that fails at one place.
macro_rules! broken {
    ($settings:ident, $info:ident, $id:literal, $fault:expr) => {
        settings! {
            /// There is nothing to set.
            pub struct $settings {}
        }

        impl Configure for $settings {
            const INFO: &'static TechniqueInfo = &$info;

            fn build(&self, _: &Gpu) -> Result<Box<dyn Technique>, Error> {
                match $fault {
                    Fault::Make => Err(Error::Scene("not made".into())),
                    fault => Ok(Box::new(Broken { fault, buffer: None })),
                }
            }
        }

        static $info: TechniqueInfo = TechniqueInfo {
            id: $id,
            title: "A technique that fails",
            summary: "It fails.",
            source: "none",
            family: Family::Control,
            filter: None,
            lights: LightKinds::ALL,
            casters: umbrage::Needs::Depth,
            features: wgpu::Features::empty(),
            limits: |_| (),
            hard: false,
            settings: SettingsOf::new::<$settings>(),
            views: &[],
            shaders: &[],
            readme: "",
        };
    };
}

broken!(NotMade, NOT_MADE, "not-made", Fault::Make);
broken!(NotPrepared, NOT_PREPARED, "not-prepared", Fault::Prepare);
broken!(NotRecorded, NOT_RECORDED, "not-recorded", Fault::Record);
broken!(NotValid, NOT_VALID, "not-valid", Fault::Driver);

struct Broken {
    fault: Fault,
    buffer: Option<wgpu::Buffer>,
}

impl Technique for Broken {
    fn prepare_view(&mut self, gpu: &Gpu, _: &View<'_>, _: InOrder) -> Result<(), Error> {
        if self.fault == Fault::Prepare {
            return Err(Error::Scene("not prepared".into()));
        }
        self.buffer = Some(gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("without the right use"),
            size: 16,
            usage: wgpu::BufferUsages::UNIFORM,
            mapped_at_creation: false,
        }));
        Ok(())
    }

    fn record_visibility(
        &mut self,
        passes: &mut Passes<'_>,
        _: &View<'_>,
        visibility: &VisibilityTarget,
        _: InOrder,
    ) -> Result<(), Error> {
        if self.fault == Fault::Record {
            return Err(Error::Scene("not recorded".into()));
        }
        // Only buffers that copies may go to can be cleared.
        self.buffer.iter().for_each(|buffer| passes.encoder().clear_buffer(buffer, 0, None));
        passes.render("clear", &[visibility.overwrite()], None);
        Ok(())
    }

    fn inside(&self) -> &dyn Inside {
        self
    }

    fn inside_mut(&mut self) -> &mut dyn Inside {
        self
    }
}

impl Inside for Broken {
    fn stats(&self) -> Stats {
        Stats::default()
    }
}

fn registry() -> Registry {
    Registry::default().with(&NOT_MADE).with(&NOT_PREPARED).with(&NOT_RECORDED).with(&NOT_VALID)
}

/// One good technique between those that fail.
const IDS: [&str; 6] = ["none", "not-made", "not-prepared", "not-recorded", "not-valid", "shadow-map"];

/// What each cell has to say: parts of its reason, nothing where it is good.
const REASONS: [&str; 6] = ["", "not made", "not prepared", "not recorded", "alid", ""];

fn choices() -> Vec<Choice> {
    Choice::list(&registry(), &IDS.map(String::from), &[]).unwrap()
}

fn scenes() -> Vec<(Source, Vec<usize>)> {
    vec![(Source::open("contact").unwrap(), vec![0])]
}

fn gpu() -> Gpu {
    Gpu::request(None).unwrap_or_else(|e| panic!("this test needs a graphics adapter: {e}"))
}

fn assert_cells<'a>(cells: impl Iterator<Item = (&'a str, Status, Option<&'a str>)>) {
    let cells: Vec<_> = cells.collect();
    assert_eq!(cells.iter().map(|(id, ..)| *id).collect::<Vec<_>>(), IDS);
    for ((id, status, reason), wanted) in cells.into_iter().zip(REASONS) {
        assert_eq!(status, if wanted.is_empty() { Status::Ok } else { Status::Failed }, "{id}: {reason:?}");
        assert!(reason.unwrap_or_default().contains(wanted), "{id}: {reason:?}");
    }
}

#[test]
fn compare_goes_on_and_the_other_cells_are_right() {
    let compare = |choices| Compare {
        scenes: scenes(),
        choices,
        size: (64, 48),
        samples: 4,
        reference: None,
        truth_cache: None,
        bake_cache: None,
        frames: 1,
        still: 0,
        command: Vec::new(),
    };
    let gpu = gpu();
    let run = |choices| compare(choices).run(&gpu, &Silent).unwrap().report.scenes.remove(0).lights.remove(0).results;
    let results = run(choices());
    assert_cells(results.iter().map(|r| (r.technique.as_str(), r.status, r.reason.as_deref())));
    let alone = run(choices().split_off(IDS.len() - 1));
    let mae = |result: &umbrage_report::record::ResultRecord| result.scores.as_ref().unwrap().mae;
    assert_eq!(mae(&results[IDS.len() - 1]), mae(&alone[0]));
    assert!(mae(&results[0]) > mae(&alone[0]));
    // Where nothing at all can be made, the run says so at once.
    let nothing = Choice::list(&registry(), &["not-made".into()], &[]).unwrap();
    assert!(compare(nothing).run(&gpu, &Silent).unwrap_err().to_string().contains("not made"));
}

/// Of small pictures.
fn bench(scenes: Vec<(Source, Vec<usize>)>, choices: Vec<Choice>, bytes: bool) -> Bench {
    Bench {
        scenes,
        choices,
        size: (64, 48),
        frames: 2,
        moving: Moving::None,
        path: None,
        samples: 1,
        together: false,
        overlay: false,
        churn: 0,
        bake_cache: None,
        bytes,
        command: Vec::new(),
    }
}

#[test]
fn bytes_are_those_of_any_light() {
    let gpu = gpu();
    let choices = Choice::list(&registry(), &["shadow-map:size=64".into()], &[]).unwrap();
    let scenes = vec![(Source::open("primitives").unwrap(), vec![1])];
    let mut report = match bench(scenes, choices, true).run(&gpu, &Silent) {
        Ok(report) => report,
        // The standard asks for no more than whether there are any fragments.
        Err(error) => return assert!(error.to_string().contains("counts no fragments"), "{error}"),
    };
    let results = report.scenes.remove(0).lights.remove(0).results;
    let cost = results.into_iter().find(|r| r.technique == "shadow-map").unwrap().cost.unwrap();
    let traffic = cost.traffic.unwrap();
    let look_up = traffic.iter().find(|pass| pass.pass == "visibility").unwrap();
    // A half float is written; depth and normal of the receiver and a texel are read.
    assert_eq!((look_up.fragments, look_up.bytes), (64 * 48, Some(64 * 48 * (2 + 8 + 4))), "{traffic:?}");
    assert!(traffic.iter().all(|pass| pass.bytes.is_some()), "{traffic:?}");
}

#[test]
fn bench_goes_on() {
    let mut report = bench(scenes(), choices(), false).run(&gpu(), &Silent).unwrap();
    let results = report.scenes.remove(0).lights.remove(0).results;
    let techniques = &results[results.len() - IDS.len()..];
    assert_cells(techniques.iter().map(|r| (r.technique.as_str(), r.status, r.reason.as_deref())));
    assert!(techniques.iter().all(|r| r.cost.is_some() == (r.status == Status::Ok)));
}

#[test]
fn sweep_goes_on_and_tries_a_technique_from_outside() {
    let sweep = Sweep {
        scenes: scenes(),
        registry: registry(),
        choices: choices(),
        vary: vec![umbrage_report::Vary::parse("shadow-map:size=64").unwrap()],
        size: (64, 48),
        samples: 4,
        reference: None,
        truth_cache: None,
        bake_cache: None,
        frames: 2,
        command: Vec::new(),
    };
    let mut report = sweep.run(&gpu(), &Silent).unwrap().report;
    let results = report.scenes.remove(0).lights.remove(0).results;
    assert_cells(results.iter().map(|r| (r.technique.as_str(), r.status, r.reason.as_deref())));
    assert!(results[IDS.len() - 1].over_floor_ms.is_some());
}
