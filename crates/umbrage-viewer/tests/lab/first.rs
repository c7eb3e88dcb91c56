//! The first picture.

use crate::common::{open, until};
use umbrage_viewer::Options;

#[test]
fn the_laboratory_opens_with_a_picture_and_its_truth() {
    let mut lab = open([1200.0, 760.0], Options { scene: Some("contact:0.2".into()), ..Options::default() });
    until(&mut lab, "the truth", |lab| lab.truth_samples() > 0);
    until(&mut lab, "a score", |lab| lab.mae(0).is_some());
    if let Ok(file) = std::env::var("UMBRAGE_LAB_PICTURE") {
        lab.render().unwrap().save(file).unwrap();
    }
    assert!(lab.state().mae(0).unwrap() < 0.1);
}
