//! Changes to glTF by the tree of its JSON.

use crate::binary;
use crate::dice::Dice;
use serde_json::{Map, Value, json};

/// Values and words that mean something somewhere in glTF.
const WORDS: [&str; 24] = [
    "VEC2",
    "VEC3",
    "VEC4",
    "MAT4",
    "SCALAR",
    "MASK",
    "BLEND",
    "STEP",
    "CUBICSPLINE",
    "translation",
    "weights",
    "pointer",
    "perspective",
    "orthographic",
    "spot",
    "directional",
    "data:;base64,AAAA",
    "a.png",
    "/dev/null",
    "",
    "2.0",
    "KHR_texture_transform",
    "\u{1b}[31m",
    "KHR_draco_mesh_compression",
];
const NUMBERS: [f64; 18] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    2.0,
    3.0,
    255.0,
    65535.0,
    5121.0,
    5123.0,
    5125.0,
    5126.0,
    4294967295.0,
    4294967296.0,
    1e15,
    1e38,
    1e-38,
    1e300,
];

/// Changes a `.gltf`.
pub fn change(dice: &mut Dice, bytes: &[u8]) -> Vec<u8> {
    match serde_json::from_slice::<Value>(bytes) {
        Ok(mut tree) if !dice.is_one_in(20) => {
            change_tree(dice, &mut tree);
            tree.to_string().into_bytes()
        }
        _ => binary::change(dice, bytes),
    }
}

/// Changes the JSON or the numbers of a `.glb`, and packs it again; seldom the packing.
pub fn change_glb(dice: &mut Dice, bytes: &[u8]) -> Vec<u8> {
    let length = bytes.get(12..16).and_then(|l| l.try_into().ok()).map_or(0, u32::from_le_bytes) as usize;
    let parts = bytes.get(20..20 + length).zip(bytes.get(28 + length..));
    match parts {
        Some((json, blob)) if !dice.is_one_in(10) => match dice.is_one_in(2) {
            true => crate::corpus::glb(&change(dice, json), blob),
            false => crate::corpus::glb(json, &binary::change(dice, blob)),
        },
        _ => binary::change(dice, bytes),
    }
}

/// Goes down the tree to somewhere and changes what is there.
fn change_tree(dice: &mut Dice, tree: &mut Value) {
    let is_here = dice.is_one_in(6);
    match tree {
        Value::Array(values) if !is_here && !values.is_empty() => {
            let at = dice.below(values.len());
            change_tree(dice, &mut values[at]);
        }
        Value::Object(values) if !is_here && !values.is_empty() => {
            let at = dice.below(values.len());
            if let Some((_, value)) = values.iter_mut().nth(at) {
                change_tree(dice, value);
            }
        }
        Value::Array(values) => change_list(dice, values),
        Value::Object(values) => change_map(dice, values),
        leaf => *leaf = changed(dice, leaf),
    }
}

fn change_list(dice: &mut Dice, values: &mut Vec<Value>) {
    let at = dice.below(values.len());
    match dice.below(5) {
        0 if !values.is_empty() => drop(values.remove(at)),
        1 if !values.is_empty() => values.push(values[at].clone()),
        2 if !values.is_empty() => {
            // What has been repeated before would fill the memory.
            let most = crate::LARGEST / values[at].to_string().len().max(1);
            let times = dice.choose(&[10, 100, 2000]).unwrap_or(10).min(most);
            values.extend(vec![values[at].clone(); times]);
        }
        3 => values.clear(),
        _ => values.push(any(dice)),
    }
}

fn change_map(dice: &mut Dice, values: &mut Map<String, Value>) {
    let names: Vec<String> = values.keys().cloned().collect();
    let name = dice.choose(&names).unwrap_or_default();
    match dice.below(4) {
        0 => drop(values.remove(&name)),
        1 => {
            let other = dice.choose(&["node", "mesh", "skin", "bufferView", "byteOffset", "byteStride", "sparse"]);
            let value = any(dice);
            values.insert(other.unwrap_or("extras").to_owned(), value);
        }
        2 => {
            let value = any(dice);
            values.insert(name, value);
        }
        _ => {
            if let Some(value) = values.remove(&name) {
                values.insert(name.to_lowercase(), value);
            }
        }
    }
}

/// A value like this one, or of another kind.
fn changed(dice: &mut Dice, leaf: &Value) -> Value {
    match leaf {
        Value::Number(number) if !dice.is_one_in(3) => match (number.as_i64(), number.as_f64()) {
            (Some(mut whole), _) => {
                match dice.is_one_in(2) {
                    true => whole = whole.wrapping_add([-1, 1, 2][dice.below(3)]),
                    false => dice.change(&mut whole),
                }
                json!(whole)
            }
            (_, Some(mut number)) => {
                dice.change(&mut number);
                json!(number)
            }
            _ => any(dice),
        },
        Value::String(text) if dice.is_one_in(2) => {
            let mut text = text.clone();
            dice.change(&mut text);
            json!(text)
        }
        Value::Bool(is) => json!(!is),
        _ => any(dice),
    }
}

fn any(dice: &mut Dice) -> Value {
    match dice.below(8) {
        0 => Value::Null,
        1 => json!([]),
        2 => json!({}),
        3 => json!(dice.choose(&WORDS)),
        4 => json!(dice.below(8)),
        5 => json!([dice.choose(&NUMBERS), 0, 1]),
        6 => json!("x".repeat(5000)),
        _ => json!(dice.choose(&NUMBERS)),
    }
}
