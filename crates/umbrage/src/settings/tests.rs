use super::*;

crate::choices! {
    /// Which way a thing faces.
    enum Facing { Front = "front", Back = "back" }
}

crate::settings! {
    /// What things share.
    struct Shared {
        /// How large it is.
        size: u32 = 4, in 1..=16, unit "texels", live true,
        /// Whether it is kept.
        cache: bool = true,
    }
}

crate::settings! {
    /// Of a thing.
    struct Thing {
        #[flatten] shared: Shared,
        /// Where it looks,
        /// in two lines.
        facing: Facing = Facing::Back,
        /// A name of two words.
        soft_m: f64 = 1.0, in 0.0..=2.0,
    }
}

fn with(name: &str, value: &str) -> Result<Thing, Error> {
    let mut thing = Thing::default();
    read(&Registry::default(), "thing", &mut thing, &[(name.into(), value.into())]).map(|()| thing)
}

#[test]
fn defaults_hold_until_set() {
    let thing = with("facing", "front").unwrap();
    assert_eq!(thing, Thing { shared: Shared { size: 4, cache: true }, facing: Facing::Front, soft_m: 1.0 });
    assert_eq!(with("size", "8").unwrap().shared.size, 8);
    assert_eq!(with("soft-m", "0.5").unwrap().soft_m, 0.5);
}

#[test]
fn one_declaration_says_all() {
    let params = Thing::params();
    let names: Vec<_> = params.iter().map(|p| p.name).collect();
    assert_eq!(names, ["size", "facing", "soft-m", "cache"], "the size leads, what is shared comes last");
    assert_eq!((params[0].unit, params[0].live, params[3].live), ("texels", true, false));
    assert_eq!(params[1].help, "Where it looks, in two lines.");
    assert_eq!(params[1].kind.range(), "back, front", "the default comes first");
    assert_eq!(params[2].kind.range(), "0 to 2");
}

#[test]
fn wrong_names_and_values_are_named() {
    let text = |r: Result<Thing, Error>| r.unwrap_err().to_string();
    assert!(text(with("siez", "1")).contains("did you mean `size`"));
    assert!(text(with("size", "17")).contains("1 to 16"));
    assert!(text(with("soft-m", "NaN")).contains("0 to 2"));
    assert!(text(with("facing", "side")).contains("back, front"));
}

#[test]
fn a_struct_out_of_range_is_refused_by_the_name_of_its_field() {
    let refused = |thing: &Thing| check("thing", Thing::params(), thing).err().map(|e| e.to_string());
    assert_eq!(refused(&Thing::default()), None);
    let wide = Thing { soft_m: f64::NAN, ..Thing::default() };
    assert!(refused(&wide).is_some_and(|text| text.contains("`soft-m`")));
    let large = Thing { shared: Shared { size: 17, cache: true }, ..Thing::default() };
    assert!(refused(&large).is_some_and(|text| text.contains("`size`")));
}
