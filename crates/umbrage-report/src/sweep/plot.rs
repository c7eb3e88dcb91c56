//! Error against cost as pictures.

use crate::sweep::{
    answer::{Answer, Point},
    axis::{Axis, short},
    canvas::{BOTTOM, Canvas, LEFT, RIGHT, TOP},
    measures::{MEASURES, Measure},
    record::{SweepLight, SweepReport, SweepScene},
};

/// A plot of one light by one measure.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    /// Number of the scene, and that of the light among those of the scene.
    pub place: (usize, usize),
    pub measure: &'static str,
    /// The parameter that errors are shown along; `None` where they are set against cost.
    pub along: Option<String>,
    /// Name of its file, relative to the report.
    pub file: String,
    pub svg: String,
}

/// The plots of all lights by all measures that they have.
pub(crate) fn all(report: &SweepReport) -> Vec<Plot> {
    let mut plots = Vec::new();
    for (s, scene) in report.scenes.iter().enumerate() {
        for (l, light) in scene.lights.iter().enumerate() {
            for (measure, answer) in MEASURES.iter().filter_map(|m| Some((m, light.answer(m)?))) {
                let file = file(s, scene, light, measure.name);
                let title = format!("{}, light {} ({})", scene.name, light.light, light.kind);
                let svg = Drawing::new(light, measure, answer).svg(&title);
                plots.push(Plot { place: (s, l), measure: measure.name, along: None, file, svg });
            }
        }
    }
    plots
}

/// Name of the file of a plot of light `light` of scene number `s`.
pub(crate) fn file(s: usize, scene: &SweepScene, light: &SweepLight, of: &str) -> String {
    format!("plots/{s}-{}-light{}-{of}.svg", plain(&scene.source), light.light)
}

/// A plot being drawn.
struct Drawing<'a> {
    light: &'a SweepLight,
    measure: &'a Measure,
    answer: &'a Answer,
    points: Vec<Point>,
    techniques: Vec<&'a str>,
    x: Axis,
    y: Axis,
    canvas: Canvas,
}

impl<'a> Drawing<'a> {
    fn new(light: &'a SweepLight, measure: &'a Measure, answer: &'a Answer) -> Self {
        let results = light.results.iter().enumerate();
        let points: Vec<Point> = results.filter_map(|(i, result)| result.point(i, measure)).collect();
        let hard = (measure.hard)(&light.reference);
        let bare_ms = light.yardsticks.bare_minimum_over_floor_ms.map(|spread| spread.median);
        let costs = points.iter().map(|p| p.cost).chain(bare_ms);
        let errors = points.iter().map(|p| p.error).chain(hard);
        let x = Axis::new(&costs.collect::<Vec<_>>(), LEFT, RIGHT);
        let y = Axis::new(&errors.collect::<Vec<_>>(), BOTTOM, TOP);
        let techniques = answer.levels.first().map_or(&[][..], |level| &level.best).iter();
        let techniques = techniques.map(|best| best.technique.as_str()).collect();
        Self { light, measure, answer, points, techniques, x, y, canvas: Canvas::default() }
    }

    fn svg(mut self, title: &str) -> String {
        self.canvas.grid((&self.x, "milliseconds over the floor"), (&self.y, self.measure.title));
        self.yardsticks();
        self.front();
        for number in 0..self.techniques.len() {
            self.technique(number);
        }
        self.canvas.svg(&format!("{title}: {} against cost", self.measure.title))
    }

    /// Budgets, and the perfect hard shadow.
    fn yardsticks(&mut self) {
        const DASHED: &str = "stroke-opacity=\".5\" stroke-dasharray=\"2 4\"";
        let (x, y) = (self.x, self.y);
        for (i, budget) in self.answer.budgets.iter().enumerate() {
            let Some(ms) = budget.over_floor_ms.filter(|ms| x.contains(*ms)) else { continue };
            self.canvas.line((x.at(ms), TOP), (x.at(ms), BOTTOM), DASHED);
            let times = short(budget.bare_minimums);
            let name = if i == 0 { format!("{times} × bare minimum") } else { format!("{times} ×") };
            let anchor = if i == 0 { "end" } else { "middle" };
            self.canvas.text(
                (x.at(ms) + if i == 0 { 8.0 } else { 0.0 }, TOP - 8.0),
                &format!("text-anchor=\"{anchor}\""),
                &name,
            );
        }
        if let Some(hard) = (self.measure.hard)(&self.light.reference).filter(|hard| y.contains(*hard)) {
            self.canvas.line((LEFT, y.at(hard)), (RIGHT, y.at(hard)), DASHED);
            self.canvas.text((RIGHT - 4.0, y.at(hard) - 5.0), "text-anchor=\"end\"", "perfect hard shadow");
        }
    }

    /// A staircase: what is to the right of a point and above it costs more for nothing.
    fn front(&mut self) {
        let mut path = String::new();
        for point in self.answer.front.iter().filter_map(|i| self.points.iter().find(|p| p.result == *i)) {
            let (x, y) = (self.x.at(point.cost), self.y.at(point.error));
            path += &if path.is_empty() { format!("M{x:.1} {TOP}V{y:.1}") } else { format!("H{x:.1}V{y:.1}") };
        }
        if !path.is_empty() {
            self.canvas.add(&format!(
                "<path class=\"front\" d=\"{path}H{RIGHT}\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"1.5\" \
                 stroke-opacity=\".75\"/>"
            ));
            self.canvas.text((RIGHT + 18.0, BOTTOM), "", "━ Pareto front");
        }
    }

    /// Curves, points and the line of the legend.
    fn technique(&mut self, number: usize) {
        let name = self.techniques[number];
        self.canvas.begin(number, name);
        for curve in self.light.curves.iter().filter(|curve| curve.technique == name) {
            let on_it = curve.results.iter().filter_map(|i| self.points.iter().find(|p| p.result == *i));
            let places: Vec<_> = on_it.map(|p| (self.x.at(p.cost), self.y.at(p.error))).collect();
            self.canvas.curve(&places, &format!("{name}: {}", curve.parameter));
        }
        for point in &self.points {
            let result = &self.light.results[point.result];
            if result.technique == name {
                let place = (self.x.at(point.cost), self.y.at(point.error));
                let at_front = self.answer.front.contains(&point.result);
                let (error, cost) = (short(point.error), short(point.cost));
                let label = format!("{}: {} {error}, {cost} ms over the floor", result.name(), self.measure.name);
                self.canvas.point(number, place, at_front, &label);
            }
        }
        self.canvas.legend(number, self.techniques.len(), name);
        self.canvas.add("</g>");
    }
}

/// The last part of a path, in letters and digits.
fn plain(source: &str) -> String {
    let name = source.rsplit(['/', '\\']).next().unwrap_or_default();
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::{
        canvas::{left_open, numbers},
        fixture::fixture,
    };

    #[test]
    fn every_measure_of_a_light_has_a_plot_of_its_own() {
        let names: Vec<String> = all(&fixture()).into_iter().map(|plot| plot.file).collect();
        let name = |measure| format!("plots/0-boxes-scene-toml-light0-{measure}.svg");
        assert_eq!(names, [name("mae"), name("vs_hard"), name("p99")]);
    }

    #[test]
    fn points_are_where_their_numbers_say_and_tell_their_settings() {
        let svg = all(&fixture()).remove(0).svg;
        // Results of the one technique whose marks are circles: 2 ms and 0.04, 4 ms and 0.02, 8 ms
        // and 0.01.
        let (x, y) = (numbers(&svg, "<circle", "cx"), numbers(&svg, "<circle", "cy"));
        assert_eq!(x.len(), 4, "three points and the legend in\n{svg}");
        assert!((x[1] - x[0] - (x[2] - x[1])).abs() < 0.11 && x[1] > x[0], "{x:?}");
        assert!((y[1] - y[0] - (y[2] - y[1])).abs() < 0.11 && y[1] > y[0], "down is less error: {y:?}");
        assert!(x[..3].iter().all(|x| (LEFT..=RIGHT).contains(x)) && y[..3].iter().all(|y| (TOP..=BOTTOM).contains(y)));
        assert!(svg.contains("<title>a&lt;b size=512: mae 0.02, 4 ms over the floor</title>"), "{svg}");
        assert!(svg.contains("<title>a&lt;b: size</title>"), "the curve is not named in\n{svg}");
        assert!(svg.contains(">1 × bare minimum</text>") && svg.contains(">4 ×</text>"), "no budgets in\n{svg}");
        assert!(svg.contains(">perfect hard shadow</text>"), "{svg}");
    }

    #[test]
    fn the_front_is_a_staircase_through_its_points() {
        let svg = all(&fixture()).remove(0).svg;
        let (x, y) = (numbers(&svg, "<circle", "cx"), numbers(&svg, "<circle", "cy"));
        let path = svg.split("class=\"front\" d=\"").nth(1).and_then(|s| s.split('"').next()).expect("a front");
        let stairs = format!("M{:.1} {TOP}V{:.1}H{:.1}V{:.1}H{:.1}V{:.1}H{RIGHT}", x[0], y[0], x[1], y[1], x[2], y[2]);
        assert_eq!(path, stairs);
    }

    #[test]
    fn it_is_well_formed_and_no_number_is_broken() {
        assert_eq!(left_open("<a><b c=\"d\"/></e>"), ["a", "e"]);
        for plot in all(&fixture()) {
            assert_eq!(left_open(&plot.svg), [""; 0], "{}", plot.svg);
            assert!(!plot.svg.contains("NaN") && !plot.svg.contains("inf"), "{}", plot.svg);
        }
    }
}
