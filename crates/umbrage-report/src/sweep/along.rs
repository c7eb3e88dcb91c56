//! Error along a parameter, as pictures: what a sweep of one number looks like where the cost
//! hardly changes.

use crate::sweep::{
    axis::{Axis, short},
    canvas::{BOTTOM, Canvas, LEFT, RIGHT, TOP},
    measures::{MEASURES, Measure},
    plot::{Plot, file},
    record::{SweepCurve, SweepLight, SweepReport, SweepResult},
};

/// A curve through the results that have this error: the value of the parameter, the error, and the
/// result.
type Points<'a> = Vec<(f64, f64, &'a SweepResult)>;

/// Plots of the parameters that were asked for, given with their techniques, for all lights by all
/// measures that they have.
pub(crate) fn all(report: &SweepReport, asked: &[(String, String)]) -> Vec<Plot> {
    let mut parameters: Vec<&str> = asked.iter().map(|(_, parameter)| parameter.as_str()).collect();
    parameters.sort_unstable();
    parameters.dedup();
    let mut plots = Vec::new();
    for (s, scene) in report.scenes.iter().enumerate() {
        for (l, light) in scene.lights.iter().enumerate() {
            for (measure, parameter) in MEASURES.iter().flat_map(|m| parameters.iter().map(move |p| (m, *p))) {
                let is_asked = |curve: &&SweepCurve| {
                    let own = |(technique, of): &(String, String)| *technique == curve.technique && of == parameter;
                    curve.parameter == parameter && asked.iter().any(own)
                };
                let curves = light.curves.iter().filter(is_asked).map(|curve| points(light, curve, measure));
                let curves: Vec<Points<'_>> = curves.filter(|points| points.len() > 1).collect();
                if !curves.is_empty() {
                    let title = format!("{}, light {} ({})", scene.name, light.light, light.kind);
                    let svg = draw(&curves, measure, parameter, (measure.hard)(&light.reference), &title);
                    let file = file(s, scene, light, &format!("{}-along-{parameter}", measure.name));
                    plots.push(Plot { place: (s, l), measure: measure.name, along: Some(parameter.into()), file, svg });
                }
            }
        }
    }
    plots
}

/// None where the parameter is a word.
fn points<'a>(light: &'a SweepLight, curve: &SweepCurve, measure: &Measure) -> Points<'a> {
    let results = curve.values.iter().zip(&curve.results).filter_map(|(value, number)| {
        let result = light.results.get(*number)?;
        Some((*value, *result.errors.get(measure.name)?, result))
    });
    results.collect()
}

fn draw(curves: &[Points<'_>], measure: &Measure, parameter: &str, hard: Option<f64>, title: &str) -> String {
    let all = || curves.iter().flatten();
    let x = Axis::even_or_log(&all().map(|(value, ..)| *value).collect::<Vec<_>>(), LEFT, RIGHT);
    let y = Axis::new(&all().map(|(_, error, _)| *error).chain(hard).collect::<Vec<_>>(), BOTTOM, TOP);
    let mut canvas = Canvas::default();
    canvas.grid((&x, parameter), (&y, measure.title));
    if let Some(hard) = hard.filter(|hard| y.contains(*hard)) {
        canvas.line((LEFT, y.at(hard)), (RIGHT, y.at(hard)), "stroke-opacity=\".5\" stroke-dasharray=\"2 4\"");
        canvas.text((RIGHT - 4.0, y.at(hard) - 5.0), "text-anchor=\"end\"", "perfect hard shadow");
    }
    for (number, points) in curves.iter().enumerate() {
        let Some((.., first)) = points.first() else { continue };
        // What the curve's settings have in common.
        let mut common: Vec<String> = first.set();
        common.retain(|set| !set.starts_with(&format!("{parameter}=")));
        let name = std::iter::once(first.technique.clone()).chain(common).collect::<Vec<_>>().join(" ");
        canvas.begin(number, &first.technique);
        canvas.curve(&points.iter().map(|(value, error, _)| (x.at(*value), y.at(*error))).collect::<Vec<_>>(), &name);
        for (value, error, _) in points {
            let label = format!("{name} {parameter}={}: {} {}", short(*value), measure.name, short(*error));
            canvas.point(number, (x.at(*value), y.at(*error)), false, &label);
        }
        canvas.legend(number, curves.len(), &name);
        canvas.add("</g>");
    }
    canvas.svg(&format!("{title}: {} along {parameter}", measure.title))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sweep::{
        canvas::{left_open, numbers},
        fixture::fixture,
    };

    fn asked() -> Vec<(String, String)> {
        vec![("a<b".into(), "size".into())]
    }

    #[test]
    fn errors_are_drawn_along_the_parameter_that_was_asked_for() {
        let plots = all(&fixture(), &asked());
        let names: Vec<&str> = plots.iter().map(|plot| plot.file.as_str()).collect();
        assert_eq!(names[0], "plots/0-boxes-scene-toml-light0-mae-along-size.svg");
        assert_eq!((plots.len(), plots[0].along.as_deref()), (3, Some("size")));
        // Sizes 256, 512, 1024 with errors 0.04, 0.02, 0.01: equal steps down.
        let (x, y) = (numbers(&plots[0].svg, "<circle", "cx"), numbers(&plots[0].svg, "<circle", "cy"));
        assert_eq!(x.len(), 4, "three points and the legend in\n{}", plots[0].svg);
        assert!((x[2] - x[1] - 2.0 * (x[1] - x[0])).abs() < 0.2 && x[1] > x[0], "{x:?}");
        assert!((y[1] - y[0] - (y[2] - y[1])).abs() < 0.11 && y[1] > y[0], "{y:?}");
        assert!(plots[0].svg.contains("<title>a&lt;b size=512: mae 0.02</title>"), "{}", plots[0].svg);
        for plot in plots {
            assert_eq!(left_open(&plot.svg), [""; 0], "{}", plot.svg);
        }
    }

    #[test]
    fn what_was_not_asked_for_or_is_a_word_has_no_plot() {
        assert!(all(&fixture(), &[]).is_empty());
        assert!(all(&fixture(), &[("b".into(), "size".into())]).is_empty());
        let mut report = fixture();
        report.scenes[0].lights[0].curves[0].values.clear();
        assert!(all(&report, &asked()).is_empty());
    }
}
