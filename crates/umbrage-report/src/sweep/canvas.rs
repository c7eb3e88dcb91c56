//! Paper for plots: SVG that stands alone and follows the text colour of a page.

use crate::sweep::axis::{Axis, short};
use std::fmt::Write;

const WIDTH: f64 = 940.0;
const HEIGHT: f64 = 540.0;
pub(crate) const LEFT: f64 = 84.0;
pub(crate) const RIGHT: f64 = 760.0;
pub(crate) const TOP: f64 = 34.0;
pub(crate) const BOTTOM: f64 = 490.0;

/// Told apart on white and on black, by shape too.
const COLORS: [&str; 8] = ["#3b7dd8", "#e07b00", "#2f9e62", "#d1495b", "#8e5bd0", "#0fa3b1", "#b58900", "#c2519c"];

/// A plot being drawn; to the right of [`RIGHT`] is room for a legend.
#[derive(Default)]
pub(crate) struct Canvas {
    out: String,
}

impl Canvas {
    pub(crate) fn line(&mut self, from: (f64, f64), to: (f64, f64), style: &str) {
        let ((x1, y1), (x2, y2)) = (from, to);
        self.add(&format!(
            "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" fill=\"none\" stroke=\"currentColor\" {style}/>"
        ));
    }

    pub(crate) fn text(&mut self, (x, y): (f64, f64), style: &str, text: &str) {
        self.add(&format!("<text x=\"{x:.1}\" y=\"{y:.1}\" {style}>{}</text>", escaped(text)));
    }

    pub(crate) fn add(&mut self, element: &str) {
        // Writing to a string does not fail.
        let _ = writeln!(self.out, "{element}");
    }

    /// Both axes with their titles.
    pub(crate) fn grid(&mut self, (x, along): (&Axis, &str), (y, up): (&Axis, &str)) {
        const FAINT: &str = "stroke-opacity=\".14\"";
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
        self.text((middle, HEIGHT - 8.0), "text-anchor=\"middle\"", along);
        let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 16 {})\"", (TOP + BOTTOM) / 2.0);
        self.text((16.0, (TOP + BOTTOM) / 2.0), &turned, up);
    }

    /// Line `number` of `count` in the legend, within a group of the colour of [`Canvas::begin`].
    pub(crate) fn legend(&mut self, number: usize, count: usize, name: &str) {
        let step = ((BOTTOM - TOP - 30.0) / count as f64).min(20.0);
        let y = TOP + 8.0 + step * number as f64;
        self.add(&mark(number, (RIGHT + 26.0, y), 5.0, false));
        self.text((RIGHT + 40.0, y + 4.0), "fill=\"currentColor\" stroke=\"none\"", name);
    }

    /// Begins a group of the colour of this number; `</g>` ends it.
    pub(crate) fn begin(&mut self, number: usize, technique: &str) {
        let color = COLORS[number % COLORS.len()];
        let technique = escaped(technique);
        self.add(&format!("<g data-technique=\"{technique}\" fill=\"{color}\" stroke=\"{color}\">"));
    }

    /// A curve through places, explained where a pointer rests.
    pub(crate) fn curve(&mut self, places: &[(f64, f64)], title: &str) {
        let places: Vec<String> = places.iter().map(|(x, y)| format!("{x:.1} {y:.1}")).collect();
        if places.len() > 1 {
            self.add(&format!(
                "<path d=\"M{}\" fill=\"none\" stroke-width=\"1.5\" stroke-opacity=\".6\"><title>{}</title></path>",
                places.join("L"),
                escaped(title)
            ));
        }
    }

    /// A mark of the shape of this number, explained where a pointer rests.
    pub(crate) fn point(&mut self, number: usize, place: (f64, f64), rim: bool, title: &str) {
        self.add(&format!("<g class=\"point\"><title>{}</title>", escaped(title)));
        self.add(&format!("{}</g>", mark(number, place, if rim { 6.5 } else { 4.5 }, rim)));
    }

    /// The whole picture.
    pub(crate) fn svg(self, title: &str) -> String {
        let (title, out) = (escaped(title), self.out);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"{title}\" \
             font-family=\"system-ui, sans-serif\" font-size=\"12\" fill=\"currentColor\">{out}</svg>\n"
        )
    }
}

/// The mark of this number; those of the front have a rim.
fn mark(number: usize, (x, y): (f64, f64), r: f64, rim: bool) -> String {
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

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// Names of elements that are open at the end, or closed out of order.
#[cfg(test)]
pub(crate) fn left_open(svg: &str) -> Vec<&str> {
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

/// The numbers of an attribute in all elements that start so.
#[cfg(test)]
pub(crate) fn numbers(svg: &str, element: &str, attribute: &str) -> Vec<f64> {
    let of = |line: &str| {
        let start = line.find(&format!(" {attribute}=\""))? + attribute.len() + 3;
        line[start..].split('"').next()?.parse().ok()
    };
    svg.lines().filter(|line| line.starts_with(element)).filter_map(of).collect()
}
