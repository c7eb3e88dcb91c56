//! Odd but valid files give the surface that plain files give, or what is not read is named.
//!
//! All of them hold cards that face +Z. A card is compared where it is there and where it has
//! holes, by looking along Z at a grid of points.

mod cards;

use cards::{Gltf, Input, covered, picture};
use umbrage_io::open;

/// A unit square in OBJ, with its lower left corner at (x, y) and `w` wide.
fn square(x: f32, y: f32, w: f32) -> String {
    format!("v {x} {y} 0\nv {0} {y} 0\nv {0} {1} 0\nv {x} {1} 0\nf -4 -3 -2 -1\n", x + w, y + w)
}

/// Squares of a grid of `size` cells over the unit square, where `is_there` of column and row from
/// the lower left.
fn cells(size: u32, is_there: impl Fn(u32, u32) -> bool) -> String {
    let width = 1.0 / size as f32;
    let all = (0..size * size).map(|i| (i % size, i / size));
    all.filter(|(x, y)| is_there(*x, *y)).map(|(x, y)| square(x as f32 * width, y as f32 * width, width)).collect()
}

/// True for the pixels of an L on 4 × 4, with a margin; counted from the top.
fn is_ink(x: u32, y: u32) -> bool {
    (x == 1 && (y == 1 || y == 2)) || (x == 2 && y == 2)
}

/// The same from below.
fn is_ink_up(x: u32, y: u32) -> bool {
    is_ink(x, 3 - y)
}

/// A card with the L as its mask, sampled by nearest pixels, and `texture_info` with it.
fn card(uvs: &str, sampler: &str, texture_info: &str, rest: &str) -> Gltf {
    Gltf::card().attribute("TEXCOORD_0", uvs).masked(&picture(4, is_ink), sampler, texture_info).rest(rest)
}

/// Texture coordinates of the card's corners, from (0, 0) at the upper left, times `scale`.
fn uvs(scale: f32) -> String {
    format!("[[0,{scale}],[{scale},{scale}],[{scale},0],[0,0]]")
}

const NEAREST: &str = r#""magFilter":9728"#;

/// Name, file, and the plain OBJ that it has to look like.
fn same() -> Vec<(&'static str, Input, String)> {
    let whole = square(0.0, 0.0, 1.0);
    let letter = cells(4, is_ink_up);
    let clamp = format!(r#"{NEAREST},"wrapS":33071,"wrapT":33071"#);
    let mirror = format!(r#"{NEAREST},"wrapS":33648,"wrapT":33648"#);
    let odd = |n: u32| if n / 4 % 2 == 1 { 3 - n % 4 } else { n % 4 };
    let transform = |what: &str| format!(r#","extensions":{{"KHR_texture_transform":{{{what}}}}}"#);
    let required = r#","extensionsRequired":["KHR_texture_transform"],"extensionsUsed":["KHR_texture_transform"]"#;
    let two_sets = |set: &str| {
        let coordinates = card("[[0,0],[0,0],[0,0],[0,0]]", NEAREST, set, "");
        coordinates.attribute("TEXCOORD_1", &uvs(1.0))
    };
    let faded = |rest: &str| Gltf::card().material(rest);
    let half = |color: &str| Gltf::card().attribute("COLOR_0", color).material(r#""alphaMode":"MASK""#);
    vec![
        ("repeat", card(&uvs(2.0), NEAREST, "", "").into(), cells(8, |x, y| is_ink(x % 4, (7 - y) % 4))),
        ("clamp", card(&uvs(3.0), &clamp, "", "").into(), cells(12, |x, y| y >= 8 && x < 4 && is_ink(x, 11 - y))),
        ("mirror", card(&uvs(3.0), &mirror, "", "").into(), cells(12, |x, y| is_ink(odd(x), odd(11 - y)))),
        (
            "transform",
            card(&uvs(1.0), NEAREST, &transform(r#""offset":[0.25,0.25],"scale":[0.5,0.5]"#), required).into(),
            cells(2, |x, y| is_ink(x + 1, 2 - y)),
        ),
        // What is looked up turns to the left where v points down: u from v, v from 1 − u.
        (
            "rotation",
            card(&uvs(1.0), NEAREST, &transform(r#""offset":[0,1],"rotation":1.5707963"#), required).into(),
            cells(4, |x, y| is_ink(3 - y, 3 - x)),
        ),
        ("set 1", two_sets(r#","texCoord":1"#).into(), letter.clone()),
        ("set 1 by transform", two_sets(&transform(r#""texCoord":1"#)).into(), letter.clone()),
        ("linear", Gltf::card().attribute("TEXCOORD_0", &uvs(1.0)).masked(&picture(2, |x, _| x == 1), "", "").into(),
            "v 0.5 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 1 0\nf 1 2 3 4\n".to_owned()),
        (
            "old diffuse",
            card(&uvs(1.0), NEAREST, "", "").specular_glossiness().into(),
            letter.clone(),
        ),
        (
            "factor over the cut-off",
            faded(r#""alphaMode":"MASK","alphaCutoff":0.25,"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.4]}"#).into(),
            whole.clone(),
        ),
        ("opacity of vertices", half("[[1,1,1,1],[1,1,1,0],[1,1,1,0],[1,1,1,1]]").into(),
            "v 0 0 0\nv 0.5 0 0\nv 0.5 1 0\nv 0 1 0\nf 1 2 3 4\n".to_owned()),
        ("colours without opacity", half("[[1,1,1],[0,0,0],[0,0,0],[1,1,1]]").into(), whole.clone()),
        (
            "opacity without a mask",
            Gltf::card().attribute("COLOR_0", "[[1,1,1,0],[1,1,1,0],[1,1,1,0],[1,1,1,0]]").into(),
            whole.clone(),
        ),
        ("a hidden node", Gltf::card().nodes(
            r#"{"mesh":0},{"children":[2],"extensions":{"KHR_node_visibility":{"visible":false}}},{"mesh":0,"translation":[0.2,0.3,1]}"#,
        ).into(), whole.clone()),
        (
            "mirrored and nested",
            Gltf::card().nodes(
                r#"{"children":[1],"translation":[1,0,0]},{"mesh":0,"matrix":[-1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1]}"#,
            ).into(),
            whole.clone(),
        ),
        ("a mark before the JSON", Gltf::card().bytes(|b| [b"\xef\xbb\xbf", b].concat()), whole.clone()),
        (
            "a .glb with a part of another kind",
            Gltf::card().glb(),
            whole.clone(),
        ),
        ("sparse without a view", Gltf::card().sparse().into(), whole.clone()),
        ("lamp of no scale", Gltf::card().nodes(
            r#"{"mesh":0},{"scale":[0,0,0],"translation":[0,0,3],"extensions":{"KHR_lights_punctual":{"light":0}}}"#,
        ).rest(r#","extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}}"#).into(), whole.clone()),
        ("animated by a pointer", Gltf::card().rest(
            r#","animations":[{"samplers":[{"input":0,"output":0}],"channels":[{"sampler":0,"target":{"path":"pointer"}}]}]"#,
        ).into(), whole.clone()),
        ("mark", Input::obj(format!("\u{feff}{whole}")), whole.clone()),
        ("ends of lines of old", Input::obj(whole.replace('\n', "\r")), whole.clone()),
        ("two bytes a letter", Input::bytes("a.obj", whole.encode_utf16().flat_map(u16::to_be_bytes).collect()),
            whole.clone()),
        ("continued", Input::obj(whole.replace("f ", "# C:\\\nf \\\n").replace(" -2", " \\\n-2")), whole.clone()),
        (
            "more numbers than three",
            Input::obj("v 0 0 0 1\nv 1 0 0 0.5 1 1\nv\t1  1 0\nvn 0 0 1\nvt 0\nv +0. 1.e0 0e5\nf 1/1/1 2//1 3/1 4 # ok\n".into()),
            whole.clone(),
        ),
        (
            "concave",
            Input::obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 0.25 0\nv 0 1 0\nf 5 1 2 3 4\n".into()),
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 0.25 0\nv 0 1 0\nf 4 5 1\nf 4 1 2\nf 4 2 3\n".into(),
        ),
        (
            "a mask of its own, named in Latin-1",
            Input::bytes(
                "a.obj",
                b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl \xe4\nf 1/1 2/2 3/3 4/4\n".to_vec(),
            )
            .and("a.mtl", b"newmtl \xe4\nmap_d a.png\nnewmtl \xf6\nKd 1 1 1\n".to_vec())
            .and("a.png", picture(2, |x, _| x == 1)),
            "v 0.5 0 0\nv 1 0 0\nv 1 1 0\nv 0.5 1 0\nf 1 2 3 4\n".into(),
        ),
        (
            "a mask that is scaled, moved and clamped",
            Input::obj(
                "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3 4/4\n"
                    .into(),
            )
            .and("a.mtl", b"newmtl m\nmap_d -s 2 1 1 -o -0.75 0 -clamp on a.png\n".to_vec())
            .and("a.png", picture(2, |x, _| x == 1)),
            "v 0.625 0 0\nv 1 0 0\nv 1 1 0\nv 0.625 1 0\nf 1 2 3 4\n".into(),
        ),
    ]
}

#[test]
fn odd_files_look_like_plain_ones() {
    for (name, odd, plain) in same() {
        let (got, want) = (odd.open(name), Input::obj(plain).open("the plain file"));
        let (got, want) = (covered(&got.scene), covered(&want.scene));
        assert!(want.contains('#'), "{name}: nothing is there");
        assert_eq!(got, want, "{name}:\n{got}\nis not\n{want}");
    }
}

#[test]
fn nothing_is_left_of_what_is_below_its_cut_off() {
    for material in [
        r#""alphaMode":"MASK","pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.4]}"#,
        r#""alphaMode":"MASK","alphaCutoff":1.5"#,
    ] {
        let scene = Input::from(Gltf::card().material(material)).open(material).scene;
        assert!(!covered(&scene).contains('#'), "{material}");
    }
}

/// Files whose error or note has to hold these words.
fn named() -> Vec<(Input, bool, &'static [&'static str])> {
    let required = |name: &str| -> Input {
        let list = format!(r#","extensionsRequired":["{name}"],"extensionsUsed":["{name}"]"#);
        Gltf::card().rest(&list).into()
    };
    let used = |name: &str| -> Input { Gltf::card().rest(&format!(r#","extensionsUsed":["{name}"]"#)).into() };
    let texture = |rest: &str, mode: &str| -> Input {
        let material = format!(r#"{mode}"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}"#);
        Gltf::card()
            .attribute("TEXCOORD_0", &uvs(1.0))
            .material(&material)
            .rest(&format!(r#","textures":[{rest}]"#))
            .into()
    };
    let webp = r#"{"extensions":{"EXT_texture_webp":{"source":0}}}"#;
    let mask = r#""alphaMode":"MASK","#;
    let glass = r#""name":"pane","extensions":{"KHR_materials_transmission":{"transmissionFactor":0.9}}"#;
    let animation = |node: u32| -> Input {
        Gltf::card().rest(&format!(
            r#","animations":[{{"samplers":[{{"input":0,"output":0}}],"channels":[{{"sampler":0,"target":{{"node":{node},"path":"scale"}}}}]}}]"#
        )).into()
    };
    vec![
        (required("KHR_draco_mesh_compression"), true, &["`KHR_draco_mesh_compression`", "without Draco"]),
        (required("EXT_mesh_gpu_instancing"), true, &["`EXT_mesh_gpu_instancing`", "a node for every instance"]),
        (required("KHR_materials_transmission"), true, &["`KHR_materials_transmission`"]),
        (required("KHR_texture_basisu"), true, &["`KHR_texture_basisu`", "PNG or JPEG"]),
        (used("KHR_animation_pointer"), false, &["`KHR_animation_pointer` is not read"]),
        (texture(webp, mask), true, &["texture 0", "`EXT_texture_webp`", "PNG or JPEG"]),
        (texture(webp, ""), false, &["texture 0", "`EXT_texture_webp`", "colour is left out"]),
        (texture("{}", mask), false, &["texture 0 names no picture"]),
        (Gltf::card().material(glass).into(), false, &["`pane` is transparent"]),
        (Gltf::card().draco().into(), true, &["mesh 0, primitive 0", "`KHR_draco_mesh_compression`", "without Draco"]),
        (Gltf::card().meshopt().into(), true, &["accessor 0", "`EXT_meshopt_compression`", "without meshopt"]),
        (animation(7), true, &["animation 0", "node 7 is out of range: there are 1"]),
        (
            Gltf::card()
                .rest(r#","cameras":[{"type":"perspective","orthographic":{"xmag":1,"ymag":1,"znear":0,"zfar":1}}]"#)
                .into(),
            true,
            &["camera 0", "lens"],
        ),
        (
            Gltf::card().attribute("COLOR_0", "[[1,1,1],[1,1,1],[1,1,1],[1,1,1]]").into(),
            false,
            &["colours of vertices"],
        ),
        (Gltf::card().nodes(r#"{"mesh":0,"scale":"x"}"#).into(), true, &["nodes[0].scale", "not valid glTF"]),
        (
            Gltf::card().nodes(r#"{"scale":[1e14,1,1],"children":[1]},{"scale":[1e14,1,1],"mesh":0}"#).into(),
            true,
            &["mesh `card", "1e28 m", "scales"],
        ),
        (
            Input::obj("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n".into()),
            false,
            &["a.obj:5: a polygon crosses itself"],
        ),
        (Input::obj(format!("{}l 1 2\ncurv 0 1 1 2\n", square(0.0, 0.0, 1.0))), false, &["`l` is not read", "`curv`"]),
        (
            Input::obj(format!("mtllib no.mtl\n{}", square(0.0, 0.0, 1.0))),
            false,
            &["a.obj:1: material library `no.mtl` is missing"],
        ),
    ]
}

#[test]
fn what_is_not_read_is_named() {
    for (input, is_error, parts) in named() {
        let text = match (open(&input.write().1), is_error) {
            (Err(e), true) => e.to_string(),
            (Ok(opened), false) => opened.notes.join("\n"),
            (Err(e), false) => panic!("{parts:?}: {e}"),
            (Ok(opened), true) => panic!("{parts:?}: opened, with {:?}", opened.notes),
        };
        for part in parts {
            assert!(text.contains(part), "`{part}` is not in: {text}");
        }
        assert!(!is_error || text.contains("; "), "no remedy: {text}");
    }
}
