//! What a layer of a map shows already, and what is left to do.
//!
//! As long as a view stays the same, bit by bit, a map is good until a caster moves that it shows
//! or that comes into view. Then the casters at rest are drawn into a map of their own,
//! the *store*, once: a frame takes a copy of it and draws the movers over it. Where the view
//! changes in every frame nothing is kept and nothing lost.

use super::movers::Movers;
use crate::casters::{Casters, Places};
use umbrage_core::{Bounds, light_view::LightView};

/// What a frame has to do to a layer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Work {
    /// It is as it has to be.
    #[default]
    Keep,
    /// Draw all casters.
    Whole,
    /// Take a copy of the store and draw the movers over it.
    Over {
        /// The casters at rest have to be drawn into the store first.
        rest: bool,
    },
}

/// What the layer and its store hold.
pub(super) struct LayerCache {
    map: Option<Shown>,
    store: Option<Shown>,
    /// What flat casters of this frame are left out by.
    receivers: Bounds,
}

/// Casters in a map.
struct Shown {
    view: LightView,
    /// The box around all receivers by which flat casters were left out that can shadow nothing.
    receivers: Bounds,
    casters: Places,
    /// [`Movers::rests`].
    rests: u64,
}

/// What layers are judged by, of this frame.
pub(super) struct Frame<'a> {
    pub casters: &'a Casters,
    pub movers: &'a Movers,
    /// False where maps can't be copied.
    pub can_store: bool,
}

impl Default for LayerCache {
    fn default() -> Self {
        Self { map: None, store: None, receivers: Bounds::EMPTY }
    }
}

impl LayerCache {
    /// Nothing is known of the layer any more.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// What has to be done for this view. A layer that had none in the last frame must have been
    /// forgotten.
    pub fn work(&mut self, frame: &Frame<'_>, view: &LightView) -> Work {
        let Frame { casters, movers, can_store } = frame;
        // Never less than before, or one receiver that moves to and fro would have everything drawn
        // anew.
        let known = self.map.as_ref().filter(|map| map.view == *view).map_or(Bounds::EMPTY, |map| map.receivers);
        let receivers = known.union(casters.receivers_bounds());
        self.receivers = receivers;
        let frustum = view.frustum();
        let touched = |shown: &Shown, place: u32| {
            let bounds = casters.casting().bounds(place);
            shown.casters.has(place) || bounds.is_some_and(|b| frustum.may_see(&b))
        };
        self.store.take_if(|store| {
            !store.is_of(view, &receivers)
                || store.rests != movers.rests
                || movers.started.iter().any(|place| store.casters.has(*place))
        });
        let Some(map) = self.map.as_ref().filter(|map| map.is_of(view, &receivers)) else { return Work::Whole };
        if !movers.moved.iter().any(|place| touched(map, *place)) {
            return Work::Keep;
        }
        // Where casters start to move there will be others in the next frame: a store is not made
        // yet.
        let settled = || !movers.started.iter().any(|place| touched(map, *place));
        match self.store {
            _ if !can_store => Work::Whole,
            Some(_) => Work::Over { rest: false },
            None if settled() => Work::Over { rest: true },
            None => Work::Whole,
        }
    }

    /// The box around all receivers that goes for this frame's work.
    pub fn receivers(&self) -> Bounds {
        self.receivers
    }

    /// The store is drawn anew with these casters.
    pub fn stored(&mut self, frame: &Frame<'_>, view: &LightView, places: &[u32]) {
        let memory = self.store.take().map(|store| store.casters);
        self.store = Some(Shown::of(frame, view, self.receivers(), places, memory));
    }

    /// The map is drawn anew with these casters, over the store where that is wanted.
    pub fn shown(&mut self, frame: &Frame<'_>, view: &LightView, places: &[u32], over_store: bool) {
        let memory = self.map.take().map(|map| map.casters);
        let mut shown = Shown::of(frame, view, self.receivers(), places, memory);
        if let Some(store) = self.store.as_ref().filter(|_| over_store) {
            shown.casters.add(&store.casters);
        }
        self.map = Some(shown);
    }
}

impl Shown {
    /// `memory`: places that are not needed any more.
    fn of(frame: &Frame<'_>, view: &LightView, receivers: Bounds, places: &[u32], memory: Option<Places>) -> Self {
        let mut casters = memory.unwrap_or_default();
        casters.clear(frame.casters.placed().len());
        places.iter().for_each(|place| {
            casters.insert(*place);
        });
        Self { view: view.clone(), receivers, casters, rests: frame.movers.rests }
    }

    fn is_of(&self, view: &LightView, receivers: &Bounds) -> bool {
        self.view == *view && self.receivers.union(*receivers) == self.receivers
    }
}
