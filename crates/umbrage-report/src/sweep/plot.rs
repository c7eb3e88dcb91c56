//! Error against cost as pictures: SVG that stands alone and follows the text colour of a page.

use crate::sweep::{
    answer::{Answer, Point},
    axis::{Axis, short},
    measures::{MEASURES, Measure},
    record::{SweepLight, SweepReport},
};
use std::fmt::Write;

const WIDTH: f64 = 940.0;
const HEIGHT: f64 = 540.0;
const LEFT: f64 = 84.0;
const RIGHT: f64 = 760.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 490.0;

/// Told apart on white and on black, by shape too.
const COLORS: [&str; 8] = ["#3b7dd8", "#e07b00", "#2f9e62", "#d1495b", "#8e5bd0", "#0fa3b1", "#b58900", "#c2519c"];

/// A plot of one light by one measure.
#[derive(Clone, Debug)]
pub(crate) struct Plot {
    /// Number of the scene, and that of the light among those of the scene.
    pub place: (usize, usize),
    pub measure: &'static str,
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
                let file = format!("plots/{s}-{}-light{}-{}.svg", plain(&scene.source), light.light, measure.name);
                let title = format!("{}, light {} ({})", scene.name, light.light, light.kind);
                let svg = Drawing::new(light, measure, answer).svg(&title);
                plots.push(Plot { place: (s, l), measure: measure.name, file, svg });
            }
        }
    }
    plots
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
    out: String,
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
        Self { light, measure, answer, points, techniques, x, y, out: String::new() }
    }

    fn svg(mut self, title: &str) -> String {
        self.grid();
        self.yardsticks();
        self.front();
        for number in 0..self.techniques.len() {
            self.technique(number);
        }
        let Self { measure, out, .. } = self;
        let title = escaped(&format!("{title}: {} against cost", measure.title));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{title}\" \
             font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"currentColor\">{out}</svg>\n"
        )
    }

    fn line(&mut self, from: (f64, f64), to: (f64, f64), style: &str) {
        let ((x1, y1), (x2, y2)) = (from, to);
        self.add(&format!(
            "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" fill=\"none\" stroke=\"currentColor\" {style}/>"
        ));
    }

    fn text(&mut self, (x, y): (f64, f64), style: &str, text: &str) {
        self.add(&format!("<text x=\"{x:.1}\" y=\"{y:.1}\" {style}>{}</text>", escaped(text)));
    }

    fn add(&mut self, element: &str) {
        // Writing to a string does not fail.
        let _ = writeln!(self.out, "{element}");
    }

    fn grid(&mut self) {
        const FAINT: &str = "stroke-opacity=\".14\"";
        let (x, y) = (self.x, self.y);
        for tick in x.ticks() {
            self.line((x.at(tick), TOP), (x.at(tick), BOTTOM), FAINT);
            self.text((x.at(tick), BOTTOM + 18.0), "text-anchor=\"middle\"", &short(tick));
        }
        for tick in y.ticks() {
            self.line((LEFT, y.at(tick)), (RIGHT, y.at(tick)), FAINT);
            self.text((LEFT - 8.0, y.at(tick) + 4.0), "text-anchor=\"end\"", &short(tick));
        }
        if x.cut {
            self.text((LEFT, BOTTOM + 18.0), "text-anchor=\"middle\"", &format!("≤ {}", short(x.low())));
        }
        if y.cut {
            self.text((LEFT - 8.0, BOTTOM + 4.0), "text-anchor=\"end\"", &format!("≤ {}", short(y.low())));
        }
        self.line((LEFT, BOTTOM), (RIGHT, BOTTOM), "");
        self.line((LEFT, TOP), (LEFT, BOTTOM), "");
        let middle = (LEFT + RIGHT) / 2.0;
        self.text((middle, HEIGHT - 8.0), "text-anchor=\"middle\"", "milliseconds over the floor");
        let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 16 {})\"", (TOP + BOTTOM) / 2.0);
        self.text((16.0, (TOP + BOTTOM) / 2.0), &turned, self.measure.title);
    }

    /// Budgets, and the perfect hard shadow.
    fn yardsticks(&mut self) {
        const DASHED: &str = "stroke-opacity=\".5\" stroke-dasharray=\"2 4\"";
        let (x, y) = (self.x, self.y);
        for (i, budget) in self.answer.budgets.iter().enumerate() {
            let Some(ms) = budget.over_floor_ms.filter(|ms| x.contains(*ms)) else { continue };
            self.line((x.at(ms), TOP), (x.at(ms), BOTTOM), DASHED);
            let times = short(budget.bare_minimums);
            let name = if i == 0 { format!("{times} × bare minimum") } else { format!("{times} ×") };
            let anchor = if i == 0 { "end" } else { "middle" };
            self.text(
                (x.at(ms) + if i == 0 { 8.0 } else { 0.0 }, TOP - 8.0),
                &format!("text-anchor=\"{anchor}\""),
                &name,
            );
        }
        if let Some(hard) = (self.measure.hard)(&self.light.reference).filter(|hard| y.contains(*hard)) {
            self.line((LEFT, y.at(hard)), (RIGHT, y.at(hard)), DASHED);
            self.text((RIGHT - 4.0, y.at(hard) - 5.0), "text-anchor=\"end\"", "perfect hard shadow");
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
            self.add(&format!(
                "<path class=\"front\" d=\"{path}H{RIGHT}\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"1.5\" \
                 stroke-opacity=\".75\"/>"
            ));
            self.text((RIGHT + 18.0, BOTTOM), "", "━ Pareto front");
        }
    }

    /// Curves, points and the line of the legend.
    fn technique(&mut self, number: usize) {
        let (name, color) = (self.techniques[number], COLORS[number % COLORS.len()]);
        self.add(&format!("<g data-technique=\"{0}\" fill=\"{color}\" stroke=\"{color}\">", escaped(name)));
        for curve in self.light.curves.iter().filter(|curve| curve.technique == name) {
            let on_it = curve.results.iter().filter_map(|i| self.points.iter().find(|p| p.result == *i));
            let places: Vec<String> =
                on_it.map(|p| format!("{:.1} {:.1}", self.x.at(p.cost), self.y.at(p.error))).collect();
            if places.len() > 1 {
                self.add(&format!(
                    "<path d=\"M{}\" fill=\"none\" stroke-width=\"1.5\" stroke-opacity=\".6\"><title>{}</title></path>",
                    places.join("L"),
                    escaped(&format!("{name}: {}", curve.parameter))
                ));
            }
        }
        for point in self.points.clone() {
            let result = &self.light.results[point.result];
            if result.technique == name {
                let (x, y) = (self.x.at(point.cost), self.y.at(point.error));
                let at_front = self.answer.front.contains(&point.result);
                let (error, cost) = (short(point.error), short(point.cost));
                let label = format!("{}: {} {error}, {cost} ms over the floor", result.name(), self.measure.name);
                self.add(&format!("<g class=\"point\"><title>{}</title>", escaped(&label)));
                self.add(&format!("{}</g>", mark(number, x, y, if at_front { 6.5 } else { 4.5 }, at_front)));
            }
        }
        let step = ((BOTTOM - TOP - 30.0) / self.techniques.len() as f64).min(20.0);
        let y = TOP + 8.0 + step * number as f64;
        self.add(&mark(number, RIGHT + 26.0, y, 5.0, false));
        self.text((RIGHT + 40.0, y + 4.0), "fill=\"currentColor\" stroke=\"none\"", name);
        self.add("</g>");
    }
}

/// The mark of technique `number`; those of the front have a rim.
fn mark(number: usize, x: f64, y: f64, r: f64, rim: bool) -> String {
    let style = if rim { "stroke=\"currentColor\" stroke-width=\"1.5\"" } else { "fill-opacity=\".8\"" };
    let (w, h) = (0.9 * r, 1.1 * r);
    let path = match (number + number / COLORS.len()) % 4 {
        0 => return format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{r}\" {style}/>"),
        1 => format!("M{:.1} {:.1}h{2:.1}v{2:.1}h-{2:.1}z", x - w, y - w, 2.0 * w),
        2 => format!("M{x:.1} {:.1}L{:.1} {:.1}H{:.1}z", y - h, x + h, y + w, x - h),
        _ => format!("M{x:.1} {:.1}l{1:.1} {1:.1}l-{1:.1} {1:.1}l-{1:.1} -{1:.1}z", y - 1.2 * r, 1.2 * r),
    };
    format!("<path d=\"{path}\" {style}/>")
}

/// The last part of a path, in letters and digits.
fn plain(source: &str) -> String {
    let name = source.rsplit(['/', '\\']).next().unwrap_or_default();
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '-' }).collect()
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::record::fixture;

    /// The numbers of an attribute in all elements that start so.
    fn numbers(svg: &str, element: &str, attribute: &str) -> Vec<f64> {
        let of = |line: &str| {
            let start = line.find(&format!(" {attribute}=\""))? + attribute.len() + 3;
            line[start..].split('"').next()?.parse().ok()
        };
        svg.lines().filter(|line| line.starts_with(element)).filter_map(of).collect()
    }

    #[test]
    fn every_measure_of_a_light_has_a_plot_of_its_own() {
        let names: Vec<String> = all(&fixture()).into_iter().map(|plot| plot.file).collect();
        let name = |measure| format!("plots/0-boxes-scene-toml-light0-{measure}.svg");
        assert_eq!(names, [name("mae"), name("vs_hard"), name("p99")]);
    }

    #[test]
    fn points_are_where_their_numbers_say_and_tell_their_settings() {
        let svg = all(&fixture()).remove(0).svg;
        // Results of the one technique whose marks are circles: 2 ms and 0.04, 4 ms and 0.02, 8 ms and 0.01.
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

    /// Names of elements that are open at the end, or closed out of order.
    fn left_open(svg: &str) -> Vec<&str> {
        let mut open: Vec<&str> = Vec::new();
        for tag in svg.split('<').skip(1).filter_map(|rest| rest.split('>').next()) {
            let name = tag.split([' ', '/']).find(|word| !word.is_empty()).unwrap_or_default();
            match (tag.starts_with('/'), tag.ends_with('/')) {
                (true, _) if open.last() == Some(&name) => drop(open.pop()),
                (true, _) | (false, false) => open.push(name),
                (false, true) => {}
            }
        }
        open
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
