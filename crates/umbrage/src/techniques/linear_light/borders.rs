//! Where the borders of shadows come from, and how skins are drawn from there.

use super::channel::{Channel, into_layout};
use super::edges::edge_skins;
use super::options::{Edges, LinearLight};
use super::pictures::Skinned;
use super::point::{Made, Point};
use super::skins::Skins;
use super::steps::Steps;
use crate::depth_maps::{EdgePass, EdgeTarget};
use crate::{Error, Gpu, passes::Passes, view::View};
use umbrage_core::glam::DVec3;
use umbrage_core::{LightShape, light_view::LightView};

/// Pipelines that all points share where borders are steps in maps. An [`EdgePass`] has its own.
pub(super) struct Borders {
    /// Of what skins are drawn into.
    pub into: wgpu::BindGroupLayout,
    threshold: f64,
    /// For `edges = map`.
    pub steps: Option<(Steps, Skins)>,
}

/// A channel that is to be drawn: from the steps or edges of another point.
pub(super) struct Job<'a> {
    pub target: &'a Point,
    pub channel: &'a Channel,
    /// Edges that the other point sees.
    pub edges: Option<&'a EdgePass>,
    /// The other point; `None` where it has no maps, and nothing is in its shadow.
    pub other: Option<&'a Made>,
    pub to_other: DVec3,
}

impl Borders {
    pub fn new(gpu: &Gpu, settings: &LinearLight) -> Self {
        let into = into_layout(gpu);
        let steps = (settings.edges == Edges::Map).then(|| (Steps::new(gpu), Skins::new(gpu, settings, &into)));
        Self { into, threshold: settings.threshold, steps }
    }

    /// Chooses casters whose edges may be silhouettes: for each neighbour of each point.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        view: &View<'_>,
        shapes: &[LightShape],
        points: &mut [Point],
    ) -> Result<(), Error> {
        if self.steps.is_some() {
            return Ok(());
        }
        for i in 0..points.len() {
            let mut edges = std::mem::take(&mut points[i].edges);
            let others = neighbours(i, points.len());
            edges.resize_with(others.clone().count(), || edge_skins(gpu, &self.into, self.threshold));
            for (edges, j) in edges.iter_mut().zip(others) {
                let seen_by: &[LightView] = &points[j].maps.frame().views;
                edges.prepare(gpu, view.casters, shapes[j].center(), seen_by, points[i].maps.frame())?;
            }
            points[i].edges = edges;
        }
        Ok(())
    }

    /// Finds steps in the maps of points that are new.
    pub fn find<'a>(&self, passes: &mut Passes<'_>, new: impl Iterator<Item = &'a Point>) {
        let Some((steps, _)) = &self.steps else { return };
        let each: Vec<_> = new.filter_map(|point| Some((point, &point.made()?.steps.as_ref()?.0))).collect();
        for (point, list) in &each {
            Steps::clear(passes, list, point.layers(), self.threshold);
        }
        if !each.is_empty() {
            let mut pass = passes.compute("steps");
            each.iter().for_each(|(point, list)| steps.find(&mut pass, list, point.layers().count() as u32));
        }
    }

    /// Finds the edges of a channel, before it or its picture is drawn.
    pub fn find_edges(passes: &mut Passes<'_>, view: &View<'_>, job: &Job<'_>) {
        if let Some(edges) = job.edges.filter(|_| job.other.is_some()) {
            edges.find(passes, view.casters, job.target.maps.frame());
        }
    }

    /// Draws a channel; returns the number of draws.
    pub fn record(&self, passes: &mut Passes<'_>, job: &Job<'_>) -> u32 {
        let mut draws = 0;
        for (i, layer) in job.target.layers().enumerate() {
            let Some(into) = job.channel.upload(passes, layer, job.to_other) else { continue };
            draws += self.draw(passes, job, (i, &into.bind_group), into.attachment(), false);
        }
        draws
    }

    /// Draws the picture of a layer's skins.
    pub fn record_picture(&self, passes: &mut Passes<'_>, job: &Job<'_>, skinned: &Skinned) {
        let Some(i) = job.target.layers().position(|layer| Some(layer) == skinned.layer()) else { return };
        let Some(into) = skinned.layer().and_then(|layer| job.channel.upload(passes, layer, job.to_other)) else {
            return;
        };
        self.draw(passes, job, (i, &into.bind_group), skinned.attachment(), true);
    }

    fn draw(
        &self,
        passes: &mut Passes<'_>,
        job: &Job<'_>,
        (i, into): (usize, &wgpu::BindGroup),
        color: Option<wgpu::RenderPassColorAttachment<'_>>,
        is_picture: bool,
    ) -> u32 {
        let colors = &[color];
        if let Some(edges) = job.edges.filter(|_| job.other.is_some()) {
            let target = EdgeTarget { label: "skins", colors, depth: None };
            return edges.record(passes, (i, usize::from(is_picture)), Some(into), target);
        }
        let mut pass = passes.render("skins", colors, None);
        let steps = job.other.and_then(|other| other.steps.as_ref());
        let (Some((_, skins)), Some((list, source))) = (&self.steps, steps) else { return 0 };
        skins.draw(&mut pass, (source, list), into, is_picture);
        1
    }

    pub fn bytes(&self) -> u64 {
        self.steps.as_ref().map_or(0, |(_, skins)| skins.bytes())
    }
}

/// The numbers of the next point of `count` and of the one before.
pub(super) fn neighbours(i: usize, count: usize) -> impl Iterator<Item = usize> + Clone {
    [Some(i + 1).filter(|next| *next < count), i.checked_sub(1)].into_iter().flatten()
}
