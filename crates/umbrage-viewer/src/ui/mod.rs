//! What is on the screen around the pictures, and what hands do with it.

mod bar;
mod gizmo;
mod keys;
mod light;
mod loupe;
mod motion;
mod over;
mod panes;
mod presets;
mod read;
mod settings;
mod statistics;
mod status;

use crate::app::Lab;
use crate::see::See;
use eframe::egui;
pub(crate) use loupe::Kept;
use web_time::Instant;

/// How long a message stays, seconds.
const MESSAGE_S: f64 = 12.0;

/// What is chosen and what is open: all that is not part of a state.
pub(crate) struct Face {
    /// The pane that settings are of.
    pub active: usize,
    messages: Vec<(String, Instant)>,
    /// The command, permalink or line that was copied last.
    pub copied: Option<String>,
    /// What is drawn is drawn again in every frame, to be timed.
    pub draws_always: bool,
    /// The truth is traced.
    pub traces: bool,
    /// The scene turns.
    pub turns: bool,
    /// What can move plays.
    pub plays: bool,
    /// How fast, 1 being natural.
    pub speed: f64,
    /// The part of the next frame that has passed.
    pub part_of_frame: f64,
    pub shows_text: bool,
    pub shows_help: bool,
    /// The technique whose page is open.
    pub reads: Option<String>,
    /// The light's handles are on the pictures.
    pub shows_gizmo: bool,
    /// So is the rectangle that it can light.
    pub shows_lit_part: bool,
    pub search: Option<String>,
    /// Pixels of the screen that each picture has.
    cell: Option<[f32; 2]>,
    /// Under the cursor: the pane, and the place in shares of the picture.
    pub cursor: Option<(usize, [f32; 2])>,
    /// Seconds since the laboratory was opened, for what blinks.
    pub clock_s: f64,
    /// A file was asked for.
    #[cfg(not(target_family = "wasm"))]
    pub keep: Option<crate::keep::Kind>,
    /// The loupe, and what is drawn over pictures.
    pub see: See,
}

impl Face {
    pub fn new(_: &egui::Context) -> Self {
        Self {
            active: 0,
            messages: Vec::new(),
            copied: None,
            draws_always: false,
            traces: true,
            turns: false,
            plays: false,
            speed: 1.0,
            part_of_frame: 0.0,
            shows_text: true,
            shows_help: false,
            reads: None,
            shows_gizmo: false,
            shows_lit_part: false,
            search: None,
            cell: None,
            cursor: None,
            clock_s: 0.0,
            #[cfg(not(target_family = "wasm"))]
            keep: None,
            see: See::default(),
        }
    }

    /// Shows a message, once, for a while.
    pub fn say(&mut self, message: String) {
        let now = Instant::now();
        match self.messages.iter_mut().find(|(known, _)| *known == message) {
            Some((_, since)) => *since = now,
            None => self.messages.push((message, now)),
        }
    }

    /// Messages that are still new.
    fn messages(&mut self) -> impl Iterator<Item = &str> {
        self.messages.retain(|(_, since)| since.elapsed().as_secs_f64() < MESSAGE_S);
        self.messages.iter().map(|(message, _)| message.as_str())
    }

    /// The same, to be looked at.
    pub fn all_messages(&self) -> Vec<String> {
        self.messages.iter().map(|(message, _)| message.clone()).collect()
    }

    /// Something moves by itself.
    pub fn is_moving(&self) -> bool {
        self.turns || self.plays
    }

    /// Pixels of each picture with this many pixels of the screen for one; `None` while there is no
    /// room.
    pub fn picture_size(&self, divisor: u32) -> Option<(u32, u32)> {
        let [width, height] = self.cell?;
        let of = |length: f32| (length as u32 / divisor.max(1)).max(1);
        (width >= 1.0 && height >= 1.0).then(|| (of(width), of(height)))
    }
}

/// Shows everything, and takes over what hands do.
pub(crate) fn show(lab: &mut Lab, ui: &mut egui::Ui, passed_s: f64) {
    lab.face.clock_s += passed_s;
    lab.face.active = lab.face.active.min(lab.state.panes.len().saturating_sub(1));
    keys::take(lab, ui.ctx(), passed_s);
    egui::Panel::top("bar").show(ui, |ui| bar::show(lab, ui));
    egui::Panel::bottom("status").show(ui, |ui| status::show(lab, ui));
    egui::Panel::left("settings").default_size(270.0).show(ui, |ui| {
        egui::ScrollArea::vertical().show(ui, |ui| {
            settings::show(lab, ui);
            ui.separator();
            light::show(lab, ui);
            ui.separator();
            motion::show(lab, ui);
        });
    });
    if lab.face.shows_text {
        egui::Panel::right("statistics").default_size(230.0).show(ui, |ui| {
            egui::ScrollArea::vertical().show(ui, |ui| statistics::show(lab, ui));
        });
    }
    egui::CentralPanel::no_frame().show(ui, |ui| panes::show(lab, ui));
    loupe::show(lab, ui.ctx());
    over::window(lab, ui.ctx());
    keys::help(lab, ui.ctx());
    bar::search(lab, ui.ctx());
    status::messages(lab, ui.ctx());
    read::show(lab, ui.ctx());
    motion::advance(lab, passed_s);
    if lab.face.turns {
        let turn = umbrage_core::glam::DVec2::new(passed_s * 0.05, 0.0);
        crate::camera::orbit(&mut lab.state.camera, turn);
    }
}
