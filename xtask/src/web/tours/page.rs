//! The pages as HTML.

use super::{Step, TRUTH, Tour, breaks::Break, permalink, text};
use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd, html};
use serde_json::{Value, json};
use std::fmt::Write;

const HEAD: &str = include_str!("head.html");

/// The page of a technique: the laboratory at one side, the tour at the other.
pub fn of(technique: &Value, readme: &str, tour: &Tour, breaks: &[Break]) -> String {
    let id = text(technique, "id");
    let mut page = HEAD.replace("TITLE", &escaped(id));
    let about = about(readme);
    let _ =
        write!(page, "<main><nav><a href=\"index.html\">all techniques</a></nav><h1>{}</h1>{about}<ol>", escaped(id));
    for step in &tour.steps {
        let (title, text) = (escaped(&step.title), escaped(&step.text));
        let _ = write!(
            page,
            "<li><a target=\"laboratory\" href=\"../index.html#{}\">{title}</a><p>{text}</p>",
            tour.link(id, step)
        );
    }
    page += "</ol>";
    if !breaks.is_empty() {
        page += "<h2>Break it</h2><ul class=\"break\">";
    }
    for Break { setting, text } in breaks {
        let step = Step {
            show: "visibility".into(),
            set: vec![setting.clone()],
            beside: Some(TRUTH.into()),
            ..Step::default()
        };
        let (link, setting, text) = (tour.link(id, &step), escaped(setting), escaped(text));
        let _ = write!(
            page,
            "<li><a target=\"laboratory\" href=\"../index.html#{link}\"><code>{setting}</code></a> {text}"
        );
    }
    if !breaks.is_empty() {
        page += "</ul>";
    }
    let first = tour.steps.first().map(|step| tour.link(id, step)).unwrap_or_default();
    let _ = writeln!(
        page,
        "</main><iframe name=\"laboratory\" title=\"The laboratory\" src=\"../index.html#{first}\"></iframe></html>"
    );
    page
}

/// The page that leads to the others.
pub fn index(techniques: &[&Value]) -> String {
    let mut page = HEAD.replace("TITLE", "Shadow techniques");
    page += "<main><h1>Shadow techniques</h1><p>Each page is a tour of five steps in the laboratory.</p><dl>";
    for technique in techniques {
        let (id, summary) = (escaped(text(technique, "id")), escaped(text(technique, "summary")));
        let _ = write!(page, "<dt><a href=\"{id}.html\">{id}</a><dd>{summary}");
    }
    let all = json!({ "panes": [{ "technique": TRUTH, "picture": "color" }] });
    let _ = writeln!(
        page,
        "</dl><p><a href=\"../index.html#{}\">The laboratory alone</a></p></main></html>",
        permalink(&all)
    );
    page
}

/// The first paragraphs of a README, up to its first picture, table or section; links in it lead
/// to files that are not on the page, so their text alone is left.
fn about(readme: &str) -> String {
    let parser = Parser::new_ext(readme, Options::ENABLE_TABLES);
    let body = parser.skip_while(|event| !matches!(event, Event::End(TagEnd::Heading(_)))).skip(1);
    let is_prose = |event: &Event<'_>| {
        let ends = matches!(event, Event::Start(Tag::Heading { .. } | Tag::Table(_) | Tag::HtmlBlock));
        !ends && !matches!(event, Event::Html(_))
    };
    let mut prose: Vec<Event<'_>> = body.take_while(is_prose).collect();
    // A paragraph that is a picture.
    prose.retain(|event| !matches!(event, Event::Start(Tag::Link { .. }) | Event::End(TagEnd::Link)));
    let picture = prose.iter().position(|event| matches!(event, Event::Start(Tag::Image { .. })));
    if let Some(picture) = picture {
        prose.truncate(picture.saturating_sub(1));
    }
    let mut page = String::new();
    html::push_html(&mut page, prose.into_iter());
    page
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_readme_begins_with_prose() {
        let readme = "# `x`: y\n\nFirst [part](a.md) & `more`.\n\nSecond.\n\n![p](p.png)\n\n## How\n\nLater.\n";
        assert_eq!(about(readme), "<p>First part &amp; <code>more</code>.</p>\n<p>Second.</p>\n");
        assert_eq!(about("# x\n\nOnly.\n\n<!-- generated -->\n| a |\n|---|\n"), "<p>Only.</p>\n");
    }

    #[test]
    fn a_page_has_its_steps_and_ways_to_break() {
        let step = || Step { title: "<b>".into(), text: "t.".into(), show: "color".into(), ..Step::default() };
        let tour = Tour { scene: "contact".into(), change: String::new(), light: 0, steps: vec![step(), step()] };
        let page =
            of(&json!({ "id": "x" }), "# x\n\nAbout.\n", &tour, &[Break { setting: "bias=0".into(), text: "Bad." }]);
        assert_eq!(page.matches("<li>").count(), 3);
        assert!(
            page.contains("&lt;b&gt;")
                && page.contains("<code>bias=0</code></a> Bad.")
                && page.contains("<p>About.</p>")
        );
    }
}
