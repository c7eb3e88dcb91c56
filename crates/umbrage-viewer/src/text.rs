//! READMEs as blocks of text: the part of Markdown that they use.

/// A part of a page.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Block {
    /// With its level, from 1.
    Heading(u8, Vec<Span>),
    Paragraph(Vec<Span>),
    /// With what stands before it: a dot, or its number.
    Item(String, Vec<Span>),
    Code(String),
    /// Rows of cells; the first is the heading.
    Table(Vec<Vec<Vec<Span>>>),
}

/// Text of one kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Span {
    Text(String),
    Strong(String),
    Code(String),
    /// The words of a link. Where it leads to lies beside the README, not beside this program.
    Link(String),
}

/// The blocks of a page.
pub(crate) fn blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut lines = page.lines().peekable();
    let mut open: Option<(Option<String>, String)> = None;
    let close = |open: &mut Option<(Option<String>, String)>, blocks: &mut Vec<Block>| {
        if let Some((mark, text)) = open.take() {
            let spans = spans(&text);
            blocks.push(mark.map_or(Block::Paragraph(spans.clone()), |mark| Block::Item(mark, spans)));
        }
    };
    while let Some(line) = lines.next() {
        let trimmed = line.trim();
        if trimmed.is_empty() || trimmed.starts_with("<!--") {
            close(&mut open, &mut blocks);
        } else if trimmed.starts_with("```") {
            close(&mut open, &mut blocks);
            let code: Vec<&str> = lines.by_ref().take_while(|line| !line.trim().starts_with("```")).collect();
            blocks.push(Block::Code(code.join("\n")));
        } else if let Some((level, text)) = heading(trimmed) {
            close(&mut open, &mut blocks);
            blocks.push(Block::Heading(level, spans(text)));
        } else if trimmed.starts_with('|') {
            close(&mut open, &mut blocks);
            let mut rows = vec![row(trimmed)];
            while let Some(line) = lines.next_if(|line| line.trim().starts_with('|')) {
                if !line.chars().all(|c| "|-: ".contains(c)) {
                    rows.push(row(line.trim()));
                }
            }
            blocks.push(Block::Table(rows));
        } else if let Some((mark, text)) = item(trimmed) {
            close(&mut open, &mut blocks);
            open = Some((Some(mark), text.into()));
        } else {
            let (_, text) = open.get_or_insert_default();
            if !text.is_empty() {
                text.push(' ');
            }
            text.push_str(trimmed);
        }
    }
    close(&mut open, &mut blocks);
    blocks
}

fn heading(line: &str) -> Option<(u8, &str)> {
    let text = line.trim_start_matches('#');
    let level = line.len() - text.len();
    ((1..=6).contains(&level) && text.starts_with(' ')).then(|| (level as u8, text.trim()))
}

fn item(line: &str) -> Option<(String, &str)> {
    if let Some(text) = line.strip_prefix("- ").or_else(|| line.strip_prefix("* ")) {
        return Some(("•".into(), text));
    }
    let (number, text) = line.split_once(". ")?;
    let is_number = !number.is_empty() && number.len() < 3 && number.bytes().all(|b| b.is_ascii_digit());
    is_number.then(|| (format!("{number}."), text))
}

/// The cells of a line of a table.
fn row(line: &str) -> Vec<Vec<Span>> {
    let inner = line.trim_start_matches('|');
    let inner = inner.strip_suffix('|').unwrap_or(inner);
    // A bar in code is written with a backslash.
    let cells = inner.replace("\\|", "\u{1}");
    cells.split('|').map(|cell| spans(cell.replace('\u{1}', "|").trim())).collect()
}

/// Cuts a paragraph where its kind of text changes. Marks without an end are text.
pub(crate) fn spans(text: &str) -> Vec<Span> {
    let mut spans = Vec::new();
    let mut plain = String::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        match marked(rest) {
            Some((span, after)) => {
                if !plain.is_empty() {
                    spans.push(Span::Text(std::mem::take(&mut plain)));
                }
                spans.push(span);
                rest = after;
            }
            None => {
                plain.push(first);
                rest = &rest[first.len_utf8()..];
            }
        }
    }
    if !plain.is_empty() {
        spans.push(Span::Text(plain));
    }
    spans
}

/// What `text` begins with, and what is left.
fn marked(text: &str) -> Option<(Span, &str)> {
    let between = |open: &str, close: &str| {
        let (inner, after) = text.strip_prefix(open)?.split_once(close)?;
        (!inner.is_empty()).then_some((inner, after))
    };
    if let Some((inner, after)) = between("`", "`") {
        return Some((Span::Code(inner.into()), after));
    }
    if let Some((inner, after)) = between("**", "**") {
        return Some((Span::Strong(bare(inner)), after));
    }
    let (inner, after) = between("![", "](").or_else(|| between("[", "]("))?;
    let (_, after) = after.split_once(')').filter(|_| !inner.contains(']'))?;
    let words = bare(inner);
    let is_picture = text.starts_with('!');
    Some((Span::Link(if is_picture { format!("[picture: {words}]") } else { words }), after))
}

/// Without marks.
fn bare(text: &str) -> String {
    text.replace(['`', '*'], "")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Span {
        Span::Text(text.into())
    }

    #[test]
    fn a_page_falls_into_its_blocks() {
        let page = "# `a`: title\n\nOne line\nand another.\n<!-- made -->\n| x | y |\n|---|:-:|\n| `a\\|b` | 2 |\n\n- one\n  more\n\
                    2. two\n```rust\nlet x;\n\nlet y;\n```\nend";
        let code = Span::Code("a|b".into());
        assert_eq!(
            blocks(page),
            [
                Block::Heading(1, vec![Span::Code("a".into()), text(": title")]),
                Block::Paragraph(vec![text("One line and another.")]),
                Block::Table(vec![vec![vec![text("x")], vec![text("y")]], vec![vec![code], vec![text("2")]]]),
                Block::Item("•".into(), vec![text("one more")]),
                Block::Item("2.".into(), vec![text("two")]),
                Block::Code("let x;\n\nlet y;".into()),
                Block::Paragraph(vec![text("end")]),
            ]
        );
    }

    #[test]
    fn marks_become_kinds_of_text_and_stray_ones_stay() {
        let link = |words: &str| Span::Link(words.into());
        assert_eq!(
            spans("a **b** [`c`](d.md) 2 * 3 ` [e] ![f](g.png)"),
            [text("a "), Span::Strong("b".into()), text(" "), link("c"), text(" 2 * 3 ` [e] "), link("[picture: f]"),]
        );
        assert_eq!(spans("**"), [text("**")]);
        assert!(spans("").is_empty());
    }

    #[test]
    fn every_page_has_text_and_no_marks_are_left() {
        for info in umbrage::Registry::default().techniques() {
            let blocks = blocks(info.readme);
            assert!(matches!(blocks.first(), Some(Block::Heading(1, _))), "{}", info.id);
            let tables = blocks.iter().filter_map(|b| if let Block::Table(rows) = b { Some(rows) } else { None });
            for rows in tables {
                let columns: Vec<usize> = rows.iter().map(Vec::len).collect();
                assert!(columns.windows(2).all(|pair| pair[0] == pair[1]), "{}: {columns:?} columns", info.id);
            }
            for block in &blocks {
                let (Block::Paragraph(spans) | Block::Item(_, spans)) = block else { continue };
                let is_left =
                    |span: &Span| matches!(span, Span::Text(text) if text.contains("](") || text.contains("**"));
                assert!(!spans.iter().any(is_left), "{}: {spans:?}", info.id);
            }
        }
    }
}
