//! One layer of a map: what it has to draw in a frame.

use super::cache::{Frame, LayerCache, Work};
use super::view::MapView;
use crate::casters::{Casters, DrawList, InstanceNumbers, Light};
use crate::depth_maps::frame::MapFrame;
use crate::depth_maps::texels::near;
use umbrage_core::{Bounds, light_view::LightView};

/// A layer, what is kept of it and what this frame draws.
#[derive(Default)]
pub(super) struct Layer {
    cache: LayerCache,
    pub work: Work,
    /// Casters at rest, for the store.
    pub rest: DrawList,
    /// What goes into the map itself.
    pub list: DrawList,
    /// Casters that the view doesn't see, when that was last looked at.
    pub culled: u32,
    pub uniform: MapView,
    /// Counts the times that the layer was drawn.
    pub version: u64,
}

/// Numbers of instances of all layers, and memory to find them in.
#[derive(Default)]
pub(super) struct Lists {
    pub numbers: InstanceNumbers,
    /// Places of casters in a view.
    found: Vec<u32>,
    movers: Vec<u32>,
    /// Casters that the light is in, or so near that the near plane may cut their fronts off;
    /// sorted.
    pierced: Vec<u32>,
    /// Back faces are drawn of every caster.
    pub backs: bool,
}

impl Lists {
    pub fn new(backs: bool) -> Self {
        Self { backs, ..Self::default() }
    }

    /// Finds what to list solid casters by, see [`InstanceNumbers::list`].
    fn pierce(&mut self, casters: &Casters, view: &LightView) {
        self.pierced.clear();
        if view.is_perspective() {
            let eye = view.eye();
            let around = Bounds { min: eye, max: eye }.grown(8.0 * near(view));
            casters.casting().query(&around, &mut self.pierced);
            self.pierced.sort_unstable();
        }
    }
}

impl Layer {
    /// Nothing of it is kept.
    pub fn forget(&mut self) {
        self.cache.forget();
    }

    /// Chooses what to draw; casters that shadow nothing are left out where there is a `light`.
    /// Without a `frame` all is drawn, and nothing known of it afterwards.
    pub fn prepare(
        &mut self,
        casters: &Casters,
        frame: Option<&Frame<'_>>,
        (maps, view): (&MapFrame, &LightView),
        mut light: Option<Light>,
        lists: &mut Lists,
    ) {
        self.rest.clear();
        self.list.clear();
        self.work = frame.map_or(Work::Whole, |frame| self.cache.work(frame, view));
        if let (Some(light), Some(_)) = (&mut light, frame) {
            light.receivers = self.cache.receivers();
        }
        if let Work::Keep = self.work {
            return;
        }
        self.version += 1;
        lists.pierce(casters, view);
        if let (Work::Over { rest }, Some(frame)) = (self.work, frame)
            && self.prepare_over(frame, (maps, view), light.as_ref(), rest, lists)
        {
            return;
        }
        self.work = Work::Whole;
        let Lists { numbers, found, pierced, backs, .. } = lists;
        let pierced = Some(&**pierced).filter(|_| !*backs && view.paraboloid.is_none());
        found.clear();
        casters.casting().query(&view.frustum(), found);
        maps.keep_held(casters, found);
        numbers.list(casters, found, light.as_ref(), pierced, &mut self.list);
        self.culled = (casters.casting().len() - found.len()) as u32;
        if let Some(frame) = frame {
            self.cache.shown(frame, view, found, false);
        }
    }

    /// The movers alone and, with `rest`, the others for the store; false where there are not
    /// enough of these for a store to be worth a copy.
    fn prepare_over(
        &mut self,
        frame: &Frame<'_>,
        (maps, view): (&MapFrame, &LightView),
        light: Option<&Light>,
        rest: bool,
        lists: &mut Lists,
    ) -> bool {
        let Lists { numbers, found, movers, pierced, backs } = lists;
        let pierced = Some(&**pierced).filter(|_| !*backs && view.paraboloid.is_none());
        let (casters, frustum) = (frame.casters, view.frustum());
        let is_seen = |place: &&u32| casters.casting().bounds(**place).is_some_and(|b| frustum.may_see(&b));
        movers.clear();
        movers.extend(frame.movers.moving.iter().filter(is_seen));
        maps.keep_held(casters, movers);
        if rest {
            found.clear();
            casters.casting().query(&frustum, found);
            found.retain(|place| !frame.movers.has(*place));
            maps.keep_held(casters, found);
            if found.len() < movers.len() {
                return false;
            }
            numbers.list(casters, found, light, pierced, &mut self.rest);
            self.cache.stored(frame, view, found);
        }
        numbers.list(casters, movers, light, pierced, &mut self.list);
        self.cache.shown(frame, view, movers, true);
        true
    }
}
